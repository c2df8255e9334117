import 'uplot/dist/uPlot.min.css';
import '../shared/page.css';
import '../shared/document.css';
import './report.css';
import { h, shown } from '../shared/dom.js';
import { readRuns } from '../shared/runs.js';
import { onThemeChange, themeButton } from '../shared/theme.js';
import { differences } from './comparison.js';
import { sections } from './figures.js';
import { Extent, Plot } from './plot.js';
import { Projection } from './projection.js';
import * as words from './words.js';

const content = document.getElementById('content');

function section(id, title, ...children) {
  return h('section', { id, 'aria-labelledby': `${id}-title` }, h('h2', { id: `${id}-title` }, title), children);
}

function toolbar(extent) {
  const act = {
    left: () => extent.pan(-0.2),
    right: () => extent.pan(0.2),
    in: () => extent.zoom(0.5),
    out: () => extent.zoom(2),
    all: () => extent.all(),
  };
  for (const button of document.querySelectorAll('[data-do]')) button.addEventListener('click', act[button.dataset.do]);
  const say = () => {
    document.getElementById('window').textContent = `${shown(extent.min, 5)} to ${shown(extent.max, 5)} s`;
  };
  extent.listeners.push(say);
  say();
}

function extents(runs) {
  const reaches = runs.filter((run) => run.has('path_length')).map((run) => run.pyramid('path_length').levels.at(-1).reduce((a, b) => (b > a ? b : a), 0));
  return {
    time: new Extent('Time', 's', Math.min(...runs.map((run) => run.start)), Math.max(...runs.map((run) => run.end))),
    path_length: new Extent('Distance along the path', 'm', 0, Math.max(0, ...reaches)),
  };
}

/** Plots go to paper in light colours and at the paper's width. */
function printing(plots) {
  let chosen;
  window.addEventListener('beforeprint', () => {
    chosen = document.documentElement.dataset.theme;
    document.documentElement.dataset.theme = 'light';
    for (const details of document.querySelectorAll('main details')) details.open = true;
    for (const plot of plots) {
      plot.refresh();
      plot.size(640, plot.height - 40);
    }
  });
  window.addEventListener('afterprint', () => {
    if (chosen) document.documentElement.dataset.theme = chosen;
    else delete document.documentElement.dataset.theme;
    for (const plot of plots) plot.size(plot.box.clientWidth, plot.height);
  });
}

async function start(data) {
  const runs = await readRuns(data);
  const title = runs.map((run) => run.label).join(', ');
  document.title = `${title} – mixloop report`;
  document.getElementById('subtitle').textContent = `${title} · mixloop ${data.mixloop}`;
  themeButton(document.getElementById('theme'));

  const { time, path_length } = extents(runs);
  const plots = [];
  content.append(section('summary', 'Summary', differences(runs), words.summaryTable(runs), words.boundsTable(runs)));
  const papers = runs.find(words.isThePapers);
  if (papers) content.append(words.paperTable(papers));
  for (const { id, title: name, figures } of sections(runs)) {
    const own = figures.map((figure) =>
      figure.axes ? new Projection(figure, time) : new Plot(figure, figure.over === 'path_length' ? path_length : time),
    );
    plots.push(...own);
    content.append(
      section(id, name, id === 'commands' ? words.commandsTable(runs) : null, h('div', { class: 'figures' }, own.map((plot) => plot.element))),
    );
  }
  content.append(section('inputs', 'Inputs, versions, machine', runs.map(words.inputs)));
  document.getElementById('contents').append(
    h('ul', {}, [...content.querySelectorAll('section')].map((one) =>
      h('li', {}, h('a', { href: `#${one.id}` }, one.querySelector('h2').textContent)))),
  );
  for (const plot of plots) plot.start();
  toolbar(time);
  onThemeChange(() => plots.forEach((plot) => plot.recolour()));
  printing(plots);
  // For the tests, and for whoever wants the numbers.
  window.mixloop = { runs, plots, time };
  document.documentElement.dataset.ready = 'yes';
}

const data = JSON.parse(document.getElementById('mixloop-data').textContent);
if (data) start(data);
else content.append(h('p', {}, 'This is the empty page: mixloop report RESULT_DIR puts results into it.'));
