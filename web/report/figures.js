/** Which figures there are, from what the runs have. A figure of several runs has a colour a run. */

import { errorLimits, motorLimits } from './limits.js';
import { isThePapersRobot } from './words.js';

const axes = ['x', 'y', 'z'];

/** The lines of `curves` ([{ curve, name, scale, dash, colour }]) for every run that has them. */
function linesOf(runs, curves) {
  return runs.flatMap((run) =>
    curves
      .filter(({ curve }) => run.has(curve))
      .map((line) => ({
        ...line,
        run,
        name: runs.length > 1 ? `${run.label}: ${line.name}` : line.name,
        colour: runs.length > 1 ? run.index : line.colour,
      })),
  );
}

/** Figures of the groups ([{ title, curves }]); with one run the groups share one figure. */
function figures(runs, base, groups) {
  const merged = runs.length > 1 ? groups : [{ title: '', curves: groups.flatMap((group) => group.curves) }];
  return merged
    .map(({ title, curves }) => ({
      ...base,
      title: title ? `${base.title}, ${title}` : base.title,
      lines: linesOf(runs, curves),
    }))
    .filter((figure) => figure.lines.length > 0);
}

/** Of the paper's robot the figures have its numbers. */
function titleOf(runs, number, what) {
  return runs.some(isThePapersRobot) ? `The paper's Figure ${number}: ${what}` : what[0].toUpperCase() + what.slice(1);
}

function ofHand(runs, number, what, symbol, label) {
  return figures(
    runs,
    { title: titleOf(runs, number, `${what} of the end effector E`), label },
    axes.map((axis, i) => ({
      title: axis,
      curves: [
        { curve: `${what === 'displacement' ? 'position' : what}_${axis}_actual`, name: `${symbol}${axis} actual`, colour: i },
        { curve: `${what === 'displacement' ? 'position' : what}_${axis}_desired`, name: `${symbol}${axis} desired`, colour: i, dash: 1 },
      ],
    })),
  );
}

/** One figure a unit: turning and sliding coordinates don't share an axis. */
function ofCoordinates(runs, names, title, units, curves, limited) {
  return [false, true].flatMap((linear) => {
    const groups = names
      .map((name, i) => ({ ...name, i }))
      .filter((name) => name.linear === linear)
      .map(({ name, i }) => ({ title: name, curves: curves(name, i + 1, i) }));
    if (groups.length === 0) return [];
    const own = names.map(({ name }, i) => ({ name, i })).filter(({ i }) => names[i].linear === linear);
    const limits = (named) => (limited ? motorLimits(runs, limited, named) : []);
    // A figure of several runs is of one motor.
    return figures(runs, { title, label: units[linear ? 1 : 0] }, groups).map((figure, k) => ({ ...figure, limits: limits(runs.length > 1 ? own.slice(k, k + 1) : own) }));
  });
}

/** What the plant says of its timing over time. */
function timing(each) {
  const quantiles = (what) => [
    { curve: `${what}_max`, name: 'longest', scale: 1e6, colour: 1, dash: 2 },
    { curve: `${what}_p99`, name: '99th percentile', scale: 1e6, colour: 2, dash: 1 },
    { curve: `${what}_p50`, name: 'median', scale: 1e6, colour: 0 },
  ];
  const since = { over: 'timing_time', logarithmic: true, note: 'TIMING: of all ticks since the run began.' };
  return [
    ...each('Round trip, STATE to COMMAND', 'Time (µs)', quantiles('round_trip'), since),
    ...each('Wake-up of the plant, after the tick was due', 'Time (µs)', quantiles('wake_up'), since),
    ...each(
      'What came late',
      'Count (ticks)',
      [
        { curve: 'missed', name: 'commands missed', colour: 1 },
        { curve: 'overruns', name: 'plant late', colour: 2, dash: 1 },
        { curve: 'resent', name: 'states sent again', colour: 0, dash: 2 },
      ],
      { over: 'timing_time', note: 'TIMING: since the run began. In lockstep a late command is no miss: the state is sent again.' },
    ),
  ];
}

/** The path seen along each axis, desired and actual. */
function projections(runs) {
  const seen = [['x', 'y'], ['x', 'z'], ['y', 'z']];
  const kinds = [['actual', 0], ['desired', 1]];
  return seen
    .map(([across, up]) => ({
      title: `Path of the end effector, ${up} over ${across}`,
      axes: [across, up],
      lines: runs.flatMap((run) =>
        kinds.map(([kind, dash]) => ({
          run,
          dash,
          curves: [across, up].map((axis) => `position_${axis}_${kind}`),
          name: runs.length > 1 ? `${run.label}: ${kind}` : kind,
          colour: runs.length > 1 ? run.index : 1 - dash,
        })),
      ).filter(({ run, curves }) => curves.every((curve) => run.has(curve))),
    }))
    .filter(({ lines }) => lines.length > 0);
}

/** The sections: [{ id, title, figures: [{ title, label, lines, over? }] }]. */
export function sections(runs) {
  const { motors, free = [], coordinates } = runs.reduce((a, b) => (b.names.coordinates.length > a.names.coordinates.length ? b : a)).names;
  const one = (title, label, curves, extra = {}) => figures(runs, { title, label, ...extra }, [{ title: '', curves }]);
  const each = (title, label, curves, extra = {}) =>
    figures(runs, { title, label, ...extra }, curves.map((curve) => ({ title: curve.name, curves: [curve] })));
  return [
    {
      id: 'paper-figures',
      title: runs.some(isThePapersRobot) ? "The paper's figures" : 'Motion and torques',
      figures: [
        ...ofHand(runs, 2, 'displacement', '', 'Displacement (m)'),
        ...ofHand(runs, 3, 'velocity', 'v', 'Velocity (m/s)'),
        ...ofHand(runs, 4, 'acceleration', 'a', 'Acceleration (m/s²)'),
        ...ofCoordinates(runs, motors, titleOf(runs, 5, 'driving torques'), ['Torque (N m)', 'Force (N)'], (name, k, i) => [
          { curve: `tau_${k}`, name: `τ of ${name}`, colour: i },
        ], 'tau'),
      ],
    },
    {
      id: 'error',
      title: 'Tracking error',
      figures: [
        ...one('Position error over time', 'Error (mm)', [{ curve: 'error', name: '|error|', scale: 1e3, colour: 1 }], { limits: errorLimits(runs) }),
        ...each(
          'Position error in space',
          'Actual − desired (mm)',
          axes.map((axis, i) => ({ curve: `error_${axis}`, name: axis, scale: 1e3, colour: i })),
        ),
        ...each(
          'Position error along the path and across it',
          'Error (mm)',
          [
            { curve: 'error_along', name: 'along', scale: 1e3, colour: 0 },
            { curve: 'error_across', name: 'across', scale: 1e3, colour: 1 },
          ],
          { over: 'path_length', note: 'Along: positive where the end effector is ahead. Across: the distance from the path.' },
        ),
        ...projections(runs),
      ],
    },
    {
      id: 'coordinates',
      title: 'Coordinates',
      figures: [
        ...ofCoordinates(runs, motors, 'Motor coordinates', ['Angle (rad)', 'Displacement (m)'], (name, k, i) => [
          { curve: `psi_${k}`, name: `${name} actual`, colour: i },
          { curve: `psi_desired_${k}`, name: `${name} desired`, colour: i, dash: 1 },
        ], 'psi'),
        ...ofCoordinates(runs, motors, 'Motor rates', ['Rate (rad/s)', 'Rate (m/s)'], (name, k, i) => [
          { curve: `psid_${k}`, name: `${name}′`, colour: i },
        ], 'psid'),
        ...ofCoordinates(runs, free, 'Free coordinates', ['Angle (rad)', 'Displacement (m)'], (name, k, i) => [
          { curve: `psi_${motors.length + k}`, name, colour: i },
        ]),
        ...ofCoordinates(runs, free, 'Rates of the free coordinates', ['Rate (rad/s)', 'Rate (m/s)'], (name, k, i) => [
          { curve: `psid_${motors.length + k}`, name: `${name}′`, colour: i },
        ]),
        ...ofCoordinates(runs, coordinates, 'Dependent coordinates', ['Angle (rad)', 'Displacement (m)'], (name, k, i) => [
          { curve: `q_${k}`, name, colour: i, dash: i > 2 ? 1 : 0 },
        ]),
        ...ofCoordinates(
          runs.filter((run) => differs(run)),
          motors,
          'Torque applied, after limits and delay',
          ['Torque (N m)', 'Force (N)'],
          (name, k, i) => [
            { curve: `tau_applied_${k}`, name: `${name} applied`, colour: i },
            { curve: `tau_${k}`, name: `${name} commanded`, colour: i, dash: 1 },
          ],
          'tau',
        ),
      ],
    },
    {
      id: 'energy',
      title: 'Energy and power',
      figures: [
        ...each('Energy', 'Energy (J)', [
          { curve: 'kinetic_energy', name: 'kinetic', colour: 0 },
          { curve: 'potential_energy', name: 'potential', colour: 1 },
          { curve: 'work', name: 'work of the motors', colour: 2, dash: 1 },
        ]),
        ...one(
          'Energy balance',
          'Work − change of energy (J)',
          [{ curve: 'work_lost', name: 'work − change of energy', colour: 3 }],
          { note: 'What friction, external loads and the integrator take or give.' },
        ),
        ...each('Power balance', 'Power (W)', [
          { curve: 'power', name: 'of the motors', colour: 0 },
          { curve: 'energy_rate', name: 'change of energy', colour: 1, dash: 1 },
          { curve: 'power_lost', name: 'difference', colour: 2 },
        ]),
        ...ofCoordinates(runs, motors, 'Power of each motor', ['Power (W)', 'Power (W)'], (name, k, i) => [
          { curve: `motor_power_${k}`, name, colour: i },
        ]),
      ],
    },
    {
      id: 'commands',
      title: 'Commands',
      figures: [
        ...one(
          'Age of commands',
          'STATE to COMMAND (µs)',
          [{ curve: 'command_age', name: 'age', scale: 1e6, colour: 0 }],
          {
            note:
              'As the logger received the two messages, or in real time as the plant itself did; a gap is a tick whose ' +
              'command did not come.',
          },
        ),
        ...timing(each),
      ],
    },
  ];
}

/** Whether the plant applied anything else than what was commanded. */
function differs(run) {
  for (let k = 1; run.has(`tau_applied_${k}`); ++k) {
    const applied = run.points(`tau_applied_${k}`);
    const commanded = run.points(`tau_${k}`);
    for (let i = 0; i < applied.length; ++i) if (applied[i] !== commanded[i] && !Number.isNaN(applied[i])) return true;
  }
  return false;
}
