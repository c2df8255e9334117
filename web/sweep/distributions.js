import uPlot from 'uplot';
import { axis } from '../shared/axis.js';
import { counted, h, shown } from '../shared/dom.js';
import { cssColour, palettes, theme } from '../shared/theme.js';
import { Cells } from './variables.js';

const percent = (share) => `${shown(100 * share)} %`;

/** A histogram of a variable, its mean and quantiles marked. */
export class Histogram {
  constructor(variable, runs) {
    Object.assign(this, { variable, runs, height: 240, logarithmic: false });
    this.cells = new Cells(variable, variable.axis, variable.histogram.map((count) => count > 0));
    this.box = h('div', { class: 'plot', tabindex: 0, role: 'group', 'aria-roledescription': 'histogram', 'aria-label': `${variable.name}: ${this.words}` });
    this.readout = h('p', { class: 'readout' }, ' ');
    this.element = h('figure', {}, h('figcaption', {}, h('h3', {}, variable.name), h('p', {}, this.words)), this.box, this.readout);
    this.box.addEventListener('keydown', (event) => this.key(event));
  }

  /** Its numbers, for those who don't see it too. */
  get words() {
    const { variable: v, runs } = this;
    const measured = `${counted(v.measured)} runs${v.measured < runs ? `, not measured in ${counted(runs - v.measured)}` : ''}`;
    if (v.words) return measured;
    const quantiles = v.quantiles.map(([share, value]) => `${percent(share)} ${v.text(value, 5)}`).join(' · ');
    return `mean ${v.withUnit(v.mean, 5)} ± ${v.text(v.deviation, 3)} · ${quantiles} · from ${v.text(v.least, 5)} (run ${v.run_of_least}) to ${v.text(v.most, 5)} (run ${v.run_of_most}) · ${measured}`;
  }

  /** The bars that there are: those outside only where there is a run. */
  get bars() {
    const { cells, variable } = this;
    return variable.histogram.map((count, cell) => ({ count, cell })).filter(({ cell }) => !cells.even || (cell > 0 && cell < cells.count - 1) || variable.histogram[cell] > 0);
  }

  data() {
    const bars = this.bars;
    const isOutside = (cell) => this.cells.even && (cell === 0 || cell === this.cells.count - 1);
    const counts = (outside) => bars.map(({ count, cell }) => (isOutside(cell) !== outside || (this.logarithmic && count === 0) ? null : count));
    return [bars.map(({ cell }) => this.cells.middle(cell)), counts(false), counts(true)];
  }

  options() {
    const { cells, variable } = this;
    return {
      width: this.box.clientWidth || 500,
      height: this.height,
      scales: { x: cells.scale, y: this.logarithmic ? { distr: 3, range: (_, least, most) => [0.5, most * (most / 0.5) ** 0.3] } : { range: (_, least, most) => [0, most * 1.3] } },
      axes: [axis(variable.label, { size: 34, ...cells.ticks, grid: { show: false } }), axis('Runs (number)', { size: 66 })],
      legend: { show: false },
      cursor: { y: false, drag: { x: false, y: false }, points: { show: false } },
      hooks: { draw: [(u) => this.drawMarks(u)], setCursor: [(u) => this.say(u.cursor.idx)] },
      series: [
        {},
        ...[0, 1].map((colour) => ({
          fill: () => palettes[theme()][colour],
          stroke: () => palettes[theme()][colour],
          width: 0,
          paths: uPlot.paths.bars({ size: [cells.even ? 0.96 : 0.7, 90] }),
          points: { show: false },
        })),
      ],
    };
  }

  /** The mean dashed, quantiles dotted, each with its name above the bars. */
  drawMarks(u) {
    const { variable: v, cells } = this;
    if (!cells.even) return;
    const { ctx, bbox } = u;
    const ratio = uPlot.pxRatio;
    const marks = [{ value: v.mean, name: 'mean', colour: 1, dash: [6, 4] }, ...v.quantiles.map(([share, value]) => ({ value, name: percent(share), colour: 6, dash: [2, 3] }))];
    ctx.save();
    ctx.font = `${11 * ratio}px system-ui, "DejaVu Sans", sans-serif`;
    ctx.textBaseline = 'top';
    ctx.textAlign = 'left';
    const taken = [];
    for (const { value, name, colour, dash } of marks) {
      const shownValue = value * v.factor;
      if (!(shownValue >= u.scales.x.min && shownValue <= u.scales.x.max)) continue;
      const x = Math.round(u.valToPos(shownValue, 'x', true)) + 0.5;
      ctx.strokeStyle = palettes[theme()][colour];
      ctx.lineWidth = 1.5 * ratio;
      ctx.setLineDash(dash.map((length) => length * ratio));
      ctx.beginPath();
      ctx.moveTo(x, bbox.top);
      ctx.lineTo(x, bbox.top + bbox.height);
      ctx.stroke();
      // Below the names that it would run into.
      const width = ctx.measureText(name).width + 6 * ratio;
      const left = Math.min(x + 3 * ratio, bbox.left + bbox.width - width);
      let row = 0;
      while (taken.some((one) => one.row === row && left < one.right && one.left < left + width)) ++row;
      taken.push({ row, left, right: left + width });
      ctx.fillStyle = cssColour('--ink');
      ctx.fillText(name, left, bbox.top + row * 14 * ratio);
    }
    ctx.restore();
  }

  say(i) {
    const bar = i === null || i === undefined ? undefined : this.bars[i];
    this.readout.textContent = bar ? `${this.cells.words(bar.cell)}: ${counted(bar.count)} runs, ${shown((100 * bar.count) / this.variable.measured, 4)} %` : ' ';
    return this.readout.textContent;
  }

  start() {
    this.plot = new uPlot(this.options(), this.data(), this.box);
    if (this.observed) return;
    this.observed = new ResizeObserver(() => {
      if (this.box.clientWidth > 0 && Math.abs(this.box.clientWidth - this.plot.width) > 1) this.size(this.box.clientWidth);
    });
    this.observed.observe(this.box);
  }

  size(width) {
    this.plot.setSize({ width, height: this.height });
  }

  recolour() {
    this.plot.redraw(false);
  }

  /** Counts by their logarithm, or as they are. */
  count(logarithmic) {
    this.logarithmic = logarithmic;
    this.plot.destroy();
    this.start();
  }

  key(event) {
    const by = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!by || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    const [xs] = this.plot.data;
    const now = this.plot.cursor.idx ?? (by > 0 ? -1 : xs.length);
    const next = Math.min(Math.max(now + by, 0), xs.length - 1);
    this.plot.setCursor({ left: this.plot.valToPos(xs[next], 'x'), top: 20 });
    document.getElementById('said').textContent = this.say(next);
  }
}
