import uPlot from 'uplot';
import { axis } from '../shared/axis.js';
import { counted, h } from '../shared/dom.js';
import { cssColour } from '../shared/theme.js';
import { gradient, scaleOf, viridis } from './colours.js';
import { copyButton } from './copy.js';
import { Cells } from './variables.js';

const kNoRun = 0xffffffff;

/** A map's cells, from the page's numbers: per cell how many runs; of each metric the mean, the worst and its run. */
function cellsOf(map, bits, metrics, rows, transposed) {
  const floats = new Float32Array(bits.buffer);
  const at = (block) => map.first + block * map.cells;
  return Array.from({ length: map.cells }, (_, i) => {
    const number = bits[at(0) + i];
    const [x, y] = [Math.floor(number / rows), number % rows];
    return {
      x: transposed ? y : x,
      y: transposed ? x : y,
      runs: bits[at(1) + i],
      metric: (m) => ({ mean: floats[at(2 + 3 * m) + i], worst: floats[at(3 + 3 * m) + i], run: bits[at(4 + 3 * m) + i] }),
    };
  });
}

function choice(id, name, options) {
  const select = h('select', { id }, options.map(({ value, text }) => h('option', { value }, text)));
  return { select, element: h('label', { for: id }, `${name} `, select) };
}

/** Runs in the cells of two variables that are chosen, coloured by what is chosen. */
export class DensityMap {
  /** @param {{ variables, metrics, placed, maps, called, sweep }} data */
  constructor(data, bits) {
    Object.assign(this, { data, bits, height: 460 });
    const named = (i) => ({ value: i, text: data.variables[i].name });
    this.x = choice('map-x', 'Across', data.placed.map(named));
    this.y = choice('map-y', 'Up', []);
    this.colour = choice('map-colour', 'Colour', [
      { value: 'runs', text: 'runs in the cell' },
      ...data.metrics.flatMap((i, m) =>
        data.variables[i].kind === 'held'
          ? [{ value: `mean ${m}`, text: 'share of runs not held' }]
          : [
              { value: `mean ${m}`, text: `mean of ${data.variables[i].name}` },
              { value: `worst ${m}`, text: `${data.variables[i].worstWord} ${data.variables[i].name}` },
            ],
      ),
    ]);
    this.box = h('div', { class: 'plot map', tabindex: 0, role: 'group', 'aria-roledescription': 'map of cells', 'aria-describedby': 'map-readout' });
    this.bar = h('div', { class: 'colourbar' });
    this.readout = h('div', { id: 'map-readout', class: 'readout' });
    this.title = h('h3');
    this.element = h(
      'div',
      {},
      h('div', { class: 'controls', role: 'toolbar', 'aria-label': 'What the map shows' }, this.x.element, this.y.element, this.colour.element),
      h('figure', {}, h('figcaption', {}, this.title), this.bar, this.box, this.readout),
    );
    this.x.select.addEventListener('change', () => this.chooseX());
    this.y.select.addEventListener('change', () => this.show());
    this.colour.select.addEventListener('change', () => this.show());
    this.box.addEventListener('keydown', (event) => this.key(event));
    this.box.addEventListener('click', () => this.pin());
  }

  start() {
    new ResizeObserver(() => {
      if (this.plot && this.box.clientWidth > 0 && Math.abs(this.box.clientWidth - this.plot.width) > 1) this.size(this.box.clientWidth);
    }).observe(this.box);
    // What moves most first: the strongest entry across, what it moves up.
    this.x.select.value = this.data.strongest.entry;
    this.chooseX(this.data.strongest.second);
    if (this.data.placed.length > 1 && this.data.metrics.length > 0) {
      this.colour.select.value = `mean ${this.data.metrics.indexOf(this.data.strongest.metric)}`;
      this.show();
    }
  }

  /** Chooses what may stand up beside it. */
  chooseX(wanted) {
    const { data } = this;
    const x = Number(this.x.select.value);
    const before = wanted ?? Number(this.y.select.value || -1);
    const others = [...data.placed.filter((i) => i !== x), ...data.metrics];
    this.y.select.replaceChildren(...others.map((i) => h('option', { value: i }, data.variables[i].name)));
    this.y.select.value = others.includes(before) ? before : others[0];
    this.show();
  }

  /** Reads what is chosen, and draws it. */
  show() {
    const { data } = this;
    const [x, y] = [this.x, this.y].map(({ select }) => Number(select.value));
    const map = data.maps.list.find((one) => (one.x === x && one.y === y) || (one.x === y && one.y === x));
    if (!map) return;
    const axes = [x, y].map((i) => new Cells(data.variables[i], data.variables[i].map_axis, []));
    const transposed = map.x !== x;
    this.cells = cellsOf(map, this.bits, data.metrics, transposed ? axes[0].count : axes[1].count, transposed);
    ['x', 'y'].forEach((key, i) => {
      const occupied = [];
      for (const cell of this.cells) occupied[cell[key]] = true;
      axes[i] = new Cells(data.variables[[x, y][i]], data.variables[[x, y][i]].map_axis, occupied);
    });
    this.axes = axes;
    const [kind, m] = this.colour.select.value.split(' ');
    this.kind = kind;
    this.m = Number(m);
    this.valueOf = kind === 'runs' ? (cell) => cell.runs : (cell) => cell.metric(this.m)[kind];
    this.scale = scaleOf(this.cells.map(this.valueOf).filter((value) => !Number.isNaN(value)), kind === 'runs');
    this.byPlace = new Map(this.cells.map((cell) => [cell.x * axes[1].count + cell.y, cell]));
    this.at = this.pinned = undefined;
    const colour = this.colour.select.selectedOptions[0].textContent;
    this.title.textContent = `${data.variables[y].name} over ${data.variables[x].name}: ${colour}`;
    this.box.setAttribute('aria-label', `${this.title.textContent}. ${this.cells.length} cells with runs; arrows go from cell to cell.`);
    this.showBar();
    this.say();
    this.plot?.destroy();
    this.plot = new uPlot(this.options(), [axes[0].range, [null, null]], this.box);
  }

  options() {
    const [x, y] = this.axes;
    const bare = { grid: { show: false } };
    return {
      width: this.box.clientWidth || 600,
      height: this.height,
      scales: { x: x.scale, y: y.scale },
      axes: [axis(x.variable.label, { size: 36, ...bare, ...x.ticks }), axis(y.variable.label, { size: y.even ? 66 : 96, ...bare, ...y.ticks })],
      legend: { show: false },
      cursor: { x: false, y: false, drag: { x: false, y: false }, points: { show: false } },
      hooks: { draw: [(u) => this.paint(u)], setCursor: [(u) => this.hover(u)] },
      series: [{}, { points: { show: false } }],
    };
  }

  paint(u) {
    const { ctx } = u;
    ctx.save();
    ctx.beginPath();
    ctx.rect(u.bbox.left, u.bbox.top, u.bbox.width, u.bbox.height);
    ctx.clip();
    for (const cell of this.cells) {
      const value = this.valueOf(cell);
      ctx.fillStyle = Number.isNaN(value) ? cssColour('--line') : viridis(this.scale.share(value));
      ctx.fillRect(...this.box2d(u, cell, true));
    }
    const marked = this.at ?? this.pinned;
    if (marked) {
      const [left, top, width, height] = this.box2d(u, marked);
      ctx.lineWidth = 2 * uPlot.pxRatio;
      ctx.strokeStyle = cssColour('--paper');
      ctx.strokeRect(left - 2 * uPlot.pxRatio, top - 2 * uPlot.pxRatio, width + 4 * uPlot.pxRatio, height + 4 * uPlot.pxRatio);
      ctx.strokeStyle = cssColour('--ink');
      ctx.strokeRect(left, top, width, height);
    }
    ctx.restore();
  }

  /** A cell's left, top, width and height, in the canvas's pixels; cells of lists have a gap between them. */
  box2d(u, cell, gaps = false) {
    const [left, right] = this.axes[0].place(cell.x).map((place) => Math.round(u.valToPos(place, 'x', true)));
    const [bottom, top] = this.axes[1].place(cell.y).map((place) => Math.round(u.valToPos(place, 'y', true)));
    const gap = this.axes.map(({ even }) => (gaps && !even ? uPlot.pxRatio : 0));
    return [left + gap[0], top + gap[1], Math.max(right - left - 2 * gap[0], 1), Math.max(bottom - top - 2 * gap[1], 1)];
  }

  hover(u) {
    const { left, top } = u.cursor;
    const inside = left >= 0 && top >= 0;
    const x = inside ? this.axes[0].at(u.posToVal(left, 'x')) : -1;
    const y = inside ? this.axes[1].at(u.posToVal(top, 'y')) : -1;
    this.mark(x < 0 || y < 0 ? undefined : { x, y });
  }

  mark(place) {
    if (this.at?.x === place?.x && this.at?.y === place?.y) return;
    this.at = place;
    this.plot.redraw(false);
    this.say();
  }

  /** What stays told when the pointer leaves. */
  pin() {
    this.pinned = this.at;
    this.say();
  }

  cellAt(place) {
    return place && this.byPlace.get(place.x * this.axes[1].count + place.y);
  }

  /** The cell's numbers, and the run that was worst in it. */
  say() {
    const { data } = this;
    const place = this.at ?? this.pinned;
    const cell = this.cellAt(place);
    if (!place) return this.readout.replaceChildren(h('p', {}, 'Point at a cell, or go there by the arrows, for its numbers; a click or Enter keeps it.'));
    const where = this.axes.map((one, i) => `${one.variable.name} ${one.words([place.x, place.y][i])}`).join(', ');
    if (!cell) return this.readout.replaceChildren(h('p', {}, `${where}: no run`));
    const m = this.kind === 'runs' ? data.metrics.indexOf(data.strongest.metric) : this.m;
    const variable = data.variables[data.metrics[m]];
    const { mean, worst, run } = variable ? cell.metric(m) : { run: kNoRun };
    const words = [h('p', {}, h('strong', {}, where), `: ${counted(cell.runs)} runs`)];
    if (run !== kNoRun)
      words.push(
        h('p', {}, variable.kind === 'held' ? variable.withUnit(mean) : `${variable.name}: mean ${variable.withUnit(mean, 4)}, ${variable.worstWord} ${variable.withUnit(worst, 4)} in run ${run} `,
          data.called && variable.kind !== 'held' ? copyButton(runCommand(data, run), `Copy the command of run ${run}`) : null),
      );
    else if (variable) words.push(h('p', {}, `${variable.name} was measured in none of them`));
    this.readout.replaceChildren(...words);
    return undefined;
  }

  showBar() {
    const { scale, kind } = this;
    if (!scale) return this.bar.replaceChildren();
    const variable = kind === 'runs' ? undefined : this.data.variables[this.data.metrics[this.m]];
    const text = (value) => (variable ? variable.withUnit(value, 4) : counted(value));
    this.bar.replaceChildren(
      h('span', {}, `${scale.clipsBelow ? '≤ ' : ''}${text(scale.from)}`),
      h('span', { class: 'colours', style: `background: ${gradient()}` }),
      h('span', {}, `${scale.clipsAbove ? '≥ ' : ''}${text(scale.to)}${kind === 'runs' ? ' runs' : ''}${scale.logarithmic ? ', by the logarithm' : ''}`),
    );
    return undefined;
  }

  key(event) {
    const by = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    if (event.ctrlKey || event.metaKey || event.altKey || !(by || event.key === 'Enter')) return;
    if (event.target !== this.box) return;
    event.preventDefault();
    if (!by) return this.pin();
    const most = [...this.cells].sort((a, b) => b.runs - a.runs)[0];
    const now = this.at ?? this.pinned;
    const limits = this.axes.map((one) => (one.even ? [one.below ? 0 : 1, one.above ? one.count - 1 : one.count - 2] : [0, one.count - 1]));
    const to = (i, value) => Math.min(Math.max(value, limits[i][0]), limits[i][1]);
    this.mark(now ? { x: to(0, now.x + by[0]), y: to(1, now.y + by[1]) } : { x: most.x, y: most.y });
    document.getElementById('said').textContent = this.readout.textContent;
    return undefined;
  }

  size(width) {
    this.plot.setSize({ width, height: this.height });
  }

  recolour() {
    this.plot?.redraw(false);
  }
}

/** What writes a run and goes through it. */
export function runCommand(data, run) {
  return `${data.called} --write-run ${run} && mixloop simulate ${data.fileOf(run)}`;
}
