import { h } from '../shared/dom.js';
import { copyButton } from './copy.js';
import { runCommand } from './map.js';

/** The worst runs by a metric that is chosen, each with what goes through it again. */
export function worst(data) {
  const { variables } = data;
  if (data.worst.length === 0) return h('p', {}, 'Nothing that was measured differs between the runs.');
  const select = h('select', { id: 'worst-metric' }, data.worst.map(({ metric }) => h('option', { value: metric }, `${variables[metric].worstWord} ${variables[metric].name}`)));
  const body = h('div', { id: 'worst-shown' });
  const entries = variables.filter((one) => one.isEntry);
  const show = () => {
    const one = data.worst.find(({ metric }) => metric === Number(select.value));
    const metric = variables[one.metric];
    body.replaceChildren(
      h('div', { class: 'scroll', tabindex: 0, role: 'region', 'aria-label': `The worst runs by ${metric.name}` },
        h('table', {},
          h('thead', {}, h('tr', {}, ['Run', metric.name, 'End', ...entries.map(({ name }) => name), 'Again'].map((text) => h('th', { scope: 'col' }, text)))),
          h('tbody', {}, one.cases.map((run) => h('tr', {},
            h('th', { scope: 'row' }, String(run.run)),
            h('td', { class: 'number' }, metric.withUnit(run.value, 7)),
            h('td', {}, run.end),
            run.entries.map((value, i) => h('td', { class: 'number' }, typeof value === 'number' ? entries[i].withUnit(value) : value)),
            h('td', { class: 'again' }, copyButton(run.command, 'Copy its command'))))))),
      commands(data, one.cases[0]),
    );
  };
  select.addEventListener('change', show);
  if (data.worst.some(({ metric }) => metric === data.strongest.metric)) select.value = data.strongest.metric;
  show();
  return h('div', {}, h('div', { class: 'controls' }, h('label', { for: 'worst-metric' }, 'By the ', select)), body);
}

/** The worst one's commands in full. */
function commands(data, run) {
  return h('div', {},
    h('p', {}, `Run ${run.run} again, to the bit, from the folder where the sweep was started:`),
    h('pre', { tabindex: 0 }, run.command),
    data.called ? h('p', {}, 'or with a file of its experiment, to be looked at and changed:') : null,
    data.called ? h('pre', { tabindex: 0 }, runCommand(data, run.run).replace(' && ', '\n')) : null);
}
