import 'uplot/dist/uPlot.min.css';
import '../shared/page.css';
import '../shared/document.css';
import './sweep.css';
import { counted, h } from '../shared/dom.js';
import { onThemeChange, themeButton } from '../shared/theme.js';
import { unpackBits } from '../shared/unpack.js';
import { Histogram } from './distributions.js';
import { influence } from './influence.js';
import { DensityMap } from './map.js';
import { Variable } from './variables.js';
import * as words from './words.js';
import { worst } from './worst.js';

const content = document.getElementById('content');

function section(id, title, ...children) {
  const one = h('section', { id, 'aria-labelledby': `${id}-title` }, h('h2', { id: `${id}-title` }, title), children);
  content.append(one);
  document.getElementById('contents').firstChild.append(h('li', {}, h('a', { href: `#${id}` }, title)));
  return one;
}

/** The metric that is shown first, the first that is told of, and the two entries that have maps and move it most. */
function strongest(data) {
  const one = data.influences.find(({ entries }) => entries.length > 0) ?? data.influences[0];
  const told = [...(one?.entries ?? [])].sort((a, b) => (b.share ?? -1) - (a.share ?? -1)).map(({ entry }) => entry);
  const [entry, second] = [...new Set([...told, ...data.placed])].filter((i) => data.placed.includes(i));
  return { metric: one?.metric, entry, second };
}

/** Figures go to paper in light colours. */
function printing(figures) {
  let chosen;
  const redraw = (width) => {
    for (const figure of figures) {
      figure.recolour();
      figure.size(width ?? figure.box.clientWidth);
    }
  };
  window.addEventListener('beforeprint', () => {
    chosen = document.documentElement.dataset.theme;
    document.documentElement.dataset.theme = 'light';
    redraw(640);
  });
  window.addEventListener('afterprint', () => {
    if (chosen) document.documentElement.dataset.theme = chosen;
    else delete document.documentElement.dataset.theme;
    redraw();
  });
}

function distributions(data) {
  const histograms = data.variables.filter((one) => one.kind !== 'held' && one.varies).map((one) => new Histogram(one, data.done));
  const measured = histograms.filter(({ variable }) => !variable.isEntry);
  const entries = histograms.filter(({ variable }) => variable.isEntry);
  const log = h('input', { type: 'checkbox', id: 'log-counts' });
  log.addEventListener('change', () => histograms.forEach((one) => one.count(log.checked)));
  section('distributions', 'Distributions',
    h('div', { class: 'controls' }, h('label', {}, log, ' Runs by their logarithm')),
    measured.length ? h('div', { class: 'figures' }, measured.map(({ element }) => element)) : null,
    entries.length ? h('h3', { class: 'among' }, 'Entries') : null,
    h('div', { class: 'figures' }, entries.map(({ element }) => element)),
    words.constants(data));
  return histograms;
}

async function start(data) {
  data.variables = data.variables.map((one, i) => new Variable(one, i));
  data.strongest = strongest(data);
  data.fileOf = (run) => `${data.sweep}.run-${run}.yaml`;
  const bits = await unpackBits(data.maps.packed, data.maps.numbers);
  document.title = `${data.sweep} – mixloop report`;
  document.getElementById('subtitle').textContent = `${data.sweep}: a sweep of ${counted(data.runs)} runs · mixloop ${data.mixloop}`;
  document.getElementById('contents').append(h('ul'));
  themeButton(document.getElementById('theme'));

  section('summary', 'Summary', words.summary(data));
  section('influence', 'What moves the results', influence(data));
  const map = data.maps.list.length > 0 ? new DensityMap(data, bits) : null;
  section('maps', 'Maps', map ? map.element : h('p', {}, 'There is nothing to place: fewer than two things differ between the runs.'),
    data.placed.length < data.entries.length && map ? h('p', {}, `Of ${data.entries.length} entries the ${data.placed.length} that vary and move the results most have maps.`) : null);
  section('worst', 'Worst runs', worst(data));
  const figures = [...distributions(data)];
  for (const histogram of figures) histogram.start();
  if (map) {
    map.start();
    figures.push(map);
  }
  onThemeChange(() => figures.forEach((figure) => figure.recolour()));
  printing(figures);
  // For the tests, and for whoever wants the numbers.
  window.mixloop = { data, map, figures };
  document.documentElement.dataset.ready = 'yes';
}

const data = JSON.parse(document.getElementById('mixloop-data').textContent);
if (data) start(data);
else content.append(h('p', {}, 'This is the empty page: mixloop report SWEEP_DIR puts a sweep into it.'));
