import { h, shown } from '../shared/dom.js';

const mm = (value) => (value == null ? '–' : `${shown(value * 1e3, 9)} mm`);
const never = 'never measured';
const us = (value) => (value == null ? '–' : `${shown(value * 1e6, 4)} µs`);

/** A table with a row a measure and a column a run; rows of which nothing is known are left out. */
function table(caption, runs, rows) {
  const known = rows
    .map(([name, of]) => [name, runs.map((run) => of(run) ?? null)])
    .filter(([, cells]) => cells.some((cell) => cell !== null));
  return h(
    'div',
    { class: 'scroll', tabindex: 0, role: 'region', 'aria-label': caption },
    h(
      'table',
      {},
      h('caption', {}, caption),
      h('thead', {}, h('tr', {}, h('td'), runs.map((run) => h('th', { scope: 'col' }, run.label)))),
      h('tbody', {}, known.map(([name, cells]) =>
        h('tr', {}, h('th', { scope: 'row' }, name), cells.map((cell) => h('td', {}, cell ?? '–'))))),
    ),
  );
}

function verdictOf(run) {
  const word = run.result?.verdict;
  if (!word) return h('span', { class: 'verdict' }, 'a log: not judged');
  const held = word === 'held';
  return h('strong', { class: `verdict ${held ? 'held' : 'missed'}` }, `${held ? '✓' : '✗'} ${word}`);
}

const torqueUnit = (run, motor) => (run.names.motors[motor]?.linear ? 'N' : 'N m');

/** Of each motor, in its unit: named once where the next has the same. */
function torques(run) {
  const list = run.result?.max_torque;
  if (!list) return null;
  if (list.every((x) => x === null)) return never;
  const unit = (i) => (i + 1 < list.length && torqueUnit(run, i) === torqueUnit(run, i + 1) ? '' : ` ${torqueUnit(run, i)}`);
  return list.map((x, i) => `${shown(x)}${unit(i)}`).join(', ');
}

/** Without a path there are no position errors. */
const followsPath = (run) => run.inputs?.experiment?.duration === undefined;

/** Of each independent coordinate, of a motion without a path. */
function finalPosition(run) {
  const { final_psi: psi, position_units: units } = run.result ?? {};
  if (!psi) return null;
  return psi.every((x) => x === null) ? never : psi.map((x, i) => `${shown(x, 9)} ${units?.[i] ?? ''}`).join(', ');
}

/** A bound's name and its values in the unit that people read. */
function boundWords({ name, motor, unit }) {
  const ofMotor = name.startsWith('max_torque');
  if (ofMotor || name === 'final_psi') return { name: `${name}[${motor}]`, show: (x) => `${shown(x, ofMotor ? undefined : 9)} ${unit}` };
  return name === 'energy_drift' ? { name, show: (x) => shown(x) } : { name, show: mm };
}

/** What each run came to. */
export function summaryTable(runs) {
  const result = (key, as = (x) => x) => (run) =>
    run.result?.[key] === undefined ? null : run.result[key] === null ? never : as(run.result[key]);
  const measured = (run, key, logged) => (run.result?.[key] === undefined ? run.error[logged] : run.result[key]);
  const error = (key, logged) => (run) => {
    if (!followsPath(run)) return null;
    const value = measured(run, key, logged);
    return value === null ? (run.result ? never : null) : mm(value);
  };
  return table('What was measured', runs, [
    ['Verdict', verdictOf],
    ['Largest position error', error('max_position_error', 'max')],
    ['… at', (run) => (measured(run, 'time_of_max_position_error', 'time_of_max') === null ? null : `${shown(measured(run, 'time_of_max_position_error', 'time_of_max'))} s`)],
    ['Final position error', error('final_position_error', 'final')],
    ['Root mean square error', error('rms_position_error', 'rms')],
    ['Final position', (run) => finalPosition(run)],
    ['Energy drift', result('energy_drift', (x) => `${shown(x)} of the largest energy`)],
    ['Largest torques', (run) => torques(run)],
    ['Diverged at', result('diverged_at', (t) => `${shown(t)} s`)],
    ['Safe state from', result('safe_at', (t) => `${shown(t)} s`)],
    ['… because', result('safe_cause', String)],
    ['Interrupted at', result('interrupted_at', (t) => `${shown(t)} s`)],
    ['Ended by', (run) => (run.result?.error ? `${run.result.error.message} (${run.result.error.code})` : null)],
    ['What was missed', (run) => (run.result?.missed?.length ? run.result.missed.join('; ') : null)],
    ['Faults in the plant', (run) => (run.faults?.length ? h('ul', { class: 'faults' }, run.faults.map(({ text, at }) => h('li', {}, text, at > run.end ? ' (after its end)' : null))) : null)],
    ['Ticks', (run) => `${Math.max(0, run.ticks - 1)} at ${shown(run.rate)} Hz`],
    ['Route', (run) => run.result?.route ?? 'log'],
    ['Missed deadlines', result('missed_deadlines', String)],
    ['States sent again', result('resent', String)],
    ['Round trip, median', result('round_trip_p50', us)],
    ['Round trip, 99th percentile', result('round_trip_p99', us)],
    ['Round trip, longest', result('round_trip_max', us)],
    ['Wall time', result('wall_time', (t) => `${shown(t, 4)} s`)],
  ]);
}

/** Verdicts bound by bound. */
export function boundsTable(runs) {
  const rows = runs.flatMap((run) => {
    const { result } = run;
    if (!result) return [];
    const bounds = (result.bounds ?? []).map((bound) => {
      const { least, most, value, held } = bound;
      const { name, show } = boundWords({ ...bound, unit: bound.unit ?? torqueUnit(run, bound.motor) });
      const both = least > 0 || bound.name === 'final_psi';
      return [run.label, name, `${both ? `${show(least)} to ` : 'at most '}${show(most)}`, value === null ? never : show(value), held];
    });
    if (result.expects_divergence)
      bounds.push([run.label, 'diverges', 'yes', result.diverged_at === undefined ? 'no' : 'yes', result.diverged_at !== undefined]);
    return bounds;
  });
  if (rows.length === 0) return h('p', {}, 'The experiment expects nothing, so nothing is judged.');
  return h(
    'div',
    { class: 'scroll', tabindex: 0, role: 'region', 'aria-label': 'Verdicts against expect' },
    h(
      'table',
      {},
      h('caption', {}, 'Verdicts against what the experiment expects'),
      h('thead', {}, h('tr', {}, ['Run', 'Bound', 'Expected', 'Measured', 'Verdict'].map((name) => h('th', { scope: 'col' }, name)))),
      h('tbody', {}, rows.map(([label, name, expected, measured, held]) =>
        h('tr', {}, h('th', { scope: 'row' }, label), h('td', {}, name), h('td', {}, expected), h('td', {}, measured),
          h('td', {}, h('strong', { class: `verdict ${held ? 'held' : 'missed'}` }, held ? '✓ held' : '✗ missed'))))),
    ),
  );
}

const near = (a, b) => Math.abs(a - b) < 1e-6;

export const isThePapersRobot = (run) => run.inputs?.scene?.name === 'mixed-loop robot';

/** Whether a run is the paper's experiment: its robot, line, duration and load. */
export function isThePapers(run) {
  if (!isThePapersRobot(run) || run.ticks < 2) return false;
  const ends = [[0.3, 0, 0.8], [-0.3, 0.4, 0.3]];
  const onLine = ['x', 'y', 'z'].every((axis, i) => {
    if (!run.has(`position_${axis}_desired`)) return false;
    const points = run.points(`position_${axis}_desired`);
    return near(points[0], ends[0][i]) && near(points.at(-1), ends[1][i]);
  });
  return onLine && near(run.end, 1) && near(run.inputs.plant_parameters?.payload, 5);
}

/** What the paper states, beside what this run gives. */
export function paperTable(run) {
  const { inputs, result } = run;
  const gains = (key) => [inputs.experiment?.controller?.[key]].flat().join(', ');
  const continuous = inputs.experiment?.plant?.control === 'continuous';
  const error = result?.max_position_error ?? run.error.max;
  const at = result?.time_of_max_position_error ?? run.error.time_of_max;
  const rows = [
    ['“gave a maximum error of 12 mm in the end effector position tracking”', `${mm(error)} at ${shown(at)} s`],
    ['“The path was tracked within 1.0 second using 0.001 second integration time step”',
      `${shown(run.end)} s at ${shown(run.rate)} Hz, torque ${continuous ? 'evaluated continuously' : 'held over each tick'}`],
    ['“The end effector was carrying a mass of 5 kg at its tip”', `${shown(inputs.plant_parameters.payload)} kg`],
    ['Kp = 100.0, 25.0, 25.0 N m', gains('kp') || '–'],
    ['Kv = 1.0, 0.5, 0.5 N m s', gains('kv') || '–'],
    ['“the initial and terminal points … are (0.3, 0.0, 0.8) m and (−0.3, 0.4, 0.3) m”', 'the same line, by the cycloidal program (34)'],
  ];
  return h('section', { id: 'paper', 'aria-labelledby': 'paper-title' },
    h('h2', { id: 'paper-title' }, 'Beside the paper'),
    h('div', { class: 'scroll', tabindex: 0, role: 'region', 'aria-label': 'Beside the paper' },
      h('table', {},
        h('caption', {}, `The paper's statements (M. H. F. Dado, section 4 and Appendix B) and ${run.label}`),
        h('thead', {}, h('tr', {}, h('th', { scope: 'col' }, 'The paper'), h('th', { scope: 'col' }, 'Here'))),
        h('tbody', {}, rows.map((row) => h('tr', {}, row.map((cell) => h('td', {}, cell))))))),
    h('p', {},
      'The 12 mm are not reached: with the paper’s published parameters, independent derivations (a hand-derived ' +
      'Lagrangian, a numeric Newton-Euler, the paper’s own matrices) agree on 13.18 mm with the control law evaluated ' +
      'continuously and 13.21 mm with the torque held over each tick, as a bus does. Of some seventy other ' +
      'readings of the paper none that is plausible gives 12, and nothing here is tuned to it.'));
}

/** How the log's messages came through, and the plant's own timing. */
export function commandsTable(runs) {
  const logged = runs.filter((run) => run.log);
  if (logged.length === 0)
    return h('p', {}, 'No log was kept, so nothing is known of when commands came: mixloop run --out keeps one.');
  const log = (key) => (run) => String(run.log[key]);
  const timing = (index, as) => (run) => (run.log.timing.length ? as(run.log.timing.at(-1)[index]) : null);
  return table('Commands in the log', logged, [
    ['Clock', (run) => (run.log.real_time ? 'real time' : 'lockstep: plant time waits for every command')],
    ['Ticks without a STATE', log('states_missing')],
    ['Ticks without a COMMAND', log('commands_missing')],
    ['Ticks without a REFERENCE', log('references_missing')],
    ['Messages that can’t be read', log('dropped')],
    ['Safe state', (run) => (run.log.safe_state ? 'reached' : 'not reached')],
    ['Commands missed (TIMING)', timing(7, String)],
    ['States sent again (TIMING)', timing(8, String)],
    ['Plant late (TIMING)', timing(9, String)],
    ['Round trip, median (TIMING)', timing(1, us)],
    ['Round trip, 99th percentile (TIMING)', timing(2, us)],
    ['Round trip, longest (TIMING)', timing(3, us)],
    ['Wake-up, 99th percentile (TIMING)', timing(5, us)],
  ]);
}

/** A document as indented text, much as it was written. */
function asText(value, indent = '') {
  if (value === null) return '';
  if (typeof value !== 'object') return String(value);
  const flat = (x) => x === null || typeof x !== 'object';
  if (Array.isArray(value)) {
    if (value.every(flat)) return `[${value.map((x) => asText(x)).join(', ')}]`;
    return value.map((item) => `\n${indent}- ${asText(item, `${indent}  `).trimStart()}`).join('');
  }
  return Object.entries(value).map(([key, item]) => `\n${indent}${key}: ${asText(item, `${indent}  `)}`).join('');
}

function seedsIn(value, path = '') {
  if (value === null || typeof value !== 'object') return [];
  return Object.entries(value).flatMap(([key, item]) => {
    const here = path ? `${path}.${key}` : key;
    return /seed/i.test(key) && (item === null || typeof item !== 'object') ? [`${here} = ${item}`] : seedsIn(item, here);
  });
}

/** What a run was started from, and by what. */
export function inputs(run) {
  const { result } = run;
  const rows = [
    ['Source', run.source],
    ['Scene', result?.scene ?? run.inputs?.scene?.name],
    ['Scene, SHA-256', result?.scene_sha256],
    ['Trajectory, SHA-256', result?.trajectory_sha256],
    ['Session', result?.session],
    ['Parameters of the plant', run.inputs ? Object.entries(run.inputs.plant_parameters).map(([k, v]) => `${k} = ${shown(v)}`).join(', ') : null],
    ['Integrator', result?.integrator ? Object.entries(result.integrator).filter(([, v]) => typeof v !== 'object').map(([k, v]) => `${k} ${v}`).join(', ') : null],
    ['Evaluation', result?.evaluation],
    ['Seeds', seedsIn({ ...run.inputs, result }).join(', ') || 'none: nothing random in this run'],
    ...Object.entries(result?.versions ?? {}).map(([key, value]) => [key === 'processor' ? 'Processor' : `Version of ${key.replace('_', ' ')}`, value]),
    ...Object.entries(result?.machine ?? {}).filter(([key]) => key !== 'processor').map(([key, value]) => [`Machine: ${key}`, value]),
    ['Warnings', result?.warnings?.length ? result.warnings.map(String).join(' ') : null],
    ['Detail of the plots', run.width === 1 ? 'every tick' : `least and greatest of every ${run.width} ticks`],
  ].filter(([, value]) => value !== undefined && value !== null && value !== '');
  return h('article', {},
    h('h3', {}, run.label),
    run.notes.length ? h('ul', { class: 'notes' }, run.notes.map((note) => h('li', {}, note))) : null,
    h('dl', {}, rows.flatMap(([name, value]) => [h('dt', {}, name), h('dd', {}, String(value))])),
    run.inputs ? h('details', { open: '' }, h('summary', {}, 'The experiment, overrides applied'), h('pre', { tabindex: 0 }, asText(run.inputs.experiment).trim())) : null,
    run.inputs ? h('details', {}, h('summary', {}, 'The scene, overrides applied'), h('pre', { tabindex: 0 }, asText(run.inputs.scene).trim())) : null);
}
