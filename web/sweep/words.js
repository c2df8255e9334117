import { counted, h, shown } from '../shared/dom.js';
import { copyButton } from './copy.js';

const percent = (share) => (share === null ? '–' : `${shown(100 * share, 6)} %`);

function table(caption, heads, rows) {
  return h('div', { class: 'scroll', tabindex: 0, role: 'region', 'aria-label': caption },
    h('table', {},
      h('caption', {}, caption),
      h('thead', {}, h('tr', {}, heads.map((text) => h('th', { scope: 'col' }, text)))),
      h('tbody', {}, rows.map(([first, ...cells]) => h('tr', {}, h('th', { scope: 'row' }, first), cells.map((cell) => h('td', {}, cell ?? '–')))))));
}

function verdict(held, text) {
  return h('strong', { class: `verdict ${held ? 'held' : 'missed'}` }, `${held ? '✓' : '✗'} ${text}`);
}

function entryWords(entry) {
  if (entry.drawn) return entry.text;
  return `${counted(entry.values)} values: ${entry.text || 'listed'}`;
}

/** What the sweep was, how its runs ended, and what was expected of them. */
export function summary(data) {
  const drawn = data.spread ? `${counted(data.draws)} ${data.draws === data.runs ? 'runs' : 'at each combination'}, ${{ latin: 'a Latin hypercube', sobol: 'Sobol’s points', random: 'at random' }[data.spread]}, seed ${data.seed}` : null;
  const rows = [
    ['Experiment', data.experiment],
    ['Set in all runs', data.set.join(', ')],
    ['Runs', data.done === data.runs ? counted(data.runs) : `${counted(data.done)} of ${counted(data.runs)}`],
    ['Drawn', drawn],
  ].filter(([, value]) => value);
  return [
    data.notes.length ? h('ul', { class: 'notes' }, data.notes.map((note) => h('li', {}, note))) : null,
    h('dl', {}, rows.flatMap(([name, value]) => [h('dt', {}, name), h('dd', {}, value)])),
    data.called ? h('p', { class: 'again' }, copyButton(data.called, 'Copy the sweep’s command')) : null,
    table('What was varied', ['Entry', 'How'], data.entries.map((entry) => [entry.key, entryWords(entry)])),
    table('How the runs ended', ['End', 'Runs', 'Share', 'The first of them', ''], data.ends.map((end) => [
      end.end === 'held' ? verdict(true, 'held') : verdict(false, end.end), counted(end.runs), percent(end.runs / data.done),
      `run ${end.first}${end.error ? ` (${end.error})` : ''}`, end.end === 'held' ? '' : copyButton(end.command, 'Copy its command')])),
    data.expect.length ? table('What was expected', ['Of the runs', 'Found', 'Verdict', 'Farthest from it'], data.expect.map((bound) => [
      String(bound.text), percent(bound.found ?? null), verdict(bound.held === true, bound.held === true ? 'held' : 'missed'),
      bound.worst ? h('span', {}, `run ${bound.worst.run}: ${[bound.worst.missed].flat().join('; ')} `, copyButton(String(bound.worst.command), 'Copy its command')) : null])) : null,
  ];
}

/** What has no figure, since it doesn't vary or was never measured. */
export function constants(data) {
  const measured = data.variables.filter((one) => one.kind === 'measured');
  const never = measured.filter((one) => one.measured === 0).map((one) => one.name);
  const same = data.variables.filter((one) => one.measured > 0 && !one.varies && one.kind !== 'held').map((one) => `${one.name} is ${one.withUnit(one.least)}${one.measured < data.done ? ` where it was measured (${counted(one.measured)} runs)` : ' in all runs'}`);
  return [same.length ? h('p', {}, `${same.join('; ')}.`) : null, never.length ? h('p', {}, `Never measured: ${never.join(', ')}.`) : null];
}
