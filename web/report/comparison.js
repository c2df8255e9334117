import { h, shown } from '../shared/dom.js';

/** A document's leaves by their paths: 'plant.torque_limit[0]'. */
function leaves(value, path = '') {
  if (value === null || typeof value !== 'object') return [[path, String(value ?? '')]];
  const within = Array.isArray(value)
    ? value.map((item, i) => [`${path}[${i}]`, item])
    : Object.entries(value).map(([key, item]) => [path ? `${path}.${key}` : key, item]);
  return within.flatMap(([name, item]) => leaves(item, name));
}

/** What a run was made with, by name. */
function made(run) {
  const { inputs, result } = run;
  return new Map([
    ...(inputs ? leaves(inputs.experiment).filter(([name]) => !name.startsWith('faults[')) : []), // in words below
    ...(inputs ? leaves(inputs.scene, 'scene') : []),
    ...Object.entries(inputs?.plant_parameters ?? {}).map(([name, value]) => [`the plant's ${name}`, shown(value)]),
    ...(run.faults ?? []).map(({ text }, i) => [`fault ${i + 1}`, text]),
    ...leaves(result?.integrator ?? {}, 'integrator').filter(([name]) => !name.startsWith('integrator.chosen')),
    ...['route', 'evaluation', 'seed'].filter((key) => result?.[key] !== undefined).map((key) => [key, String(result[key])]),
    ['rate', `${shown(run.rate)} Hz`],
    ['mixloop', result?.versions?.mixloop ?? ''],
    ['processor', result?.machine?.processor ?? ''],
  ]);
}

/** Where a comparison begins: what differs between the runs, a row each. */
export function differences(runs) {
  if (runs.length < 2) return null;
  const all = runs.map(made);
  const names = [...new Set(all.flatMap((one) => [...one.keys()]))];
  const rows = names
    .map((name) => [name, all.map((one) => one.get(name) ?? '')])
    .filter(([, values]) => values.some((value) => value !== values[0]));
  const unknown = runs.filter((run) => !run.inputs).map((run) => run.label);
  const caveat = unknown.length ? h('p', {}, `Nothing is known of what was run: ${unknown.join(', ')}.`) : null;
  if (rows.length === 0) return h('div', { id: 'differences' }, h('p', {}, 'The runs were made with the same inputs, by the same program, on the same machine.'), caveat);
  return h(
    'div',
    { id: 'differences', class: 'scroll', tabindex: 0, role: 'region', 'aria-label': 'What differs between the runs' },
    h(
      'table',
      {},
      h('caption', {}, 'What differs between the runs'),
      h('thead', {}, h('tr', {}, h('td'), runs.map((run) => h('th', { scope: 'col' }, run.label)))),
      h('tbody', {}, rows.map(([name, values]) => h('tr', {}, h('th', { scope: 'row' }, name), values.map((value) => h('td', {}, value || '–'))))),
    ),
    caveat,
  );
}
