import uPlot from 'uplot';
import { axis } from '../shared/axis.js';
import { h, shown } from '../shared/dom.js';
import { paintLegend } from '../shared/legend.js';
import { dashes, palettes, theme } from '../shared/theme.js';
import { limitsNote, withLimits } from './limits.js';

export const kMostPoints = 3000; // a curve, drawn at once: more than a screen has columns
const kPerPixel = 3; // points at most, the least and the greatest of a bit less than a column

/** The stretch of x that plots share: time, or the distance along the path. */
export class Extent {
  constructor(name, unit, min, max) {
    Object.assign(this, { name, unit, least: min, greatest: max > min ? max : min + 1 });
    this.min = this.least;
    this.max = this.greatest;
    this.plots = [];
    this.listeners = [];
  }

  set(min, max) {
    const whole = this.greatest - this.least;
    const width = Math.min(Math.max(max - min, whole * 1e-7), whole);
    this.min = Math.min(Math.max(min, this.least), this.greatest - width);
    this.max = this.min + width;
    if (this.pending) return;
    this.pending = requestAnimationFrame(() => {
      this.pending = 0;
      for (const plot of this.plots) plot.stale = true;
      for (const plot of this.plots) if (plot.visible) plot.refresh();
      for (const listener of this.listeners) listener(this);
    });
  }

  all() {
    this.set(this.least, this.greatest);
  }

  zoom(factor, about = (this.min + this.max) / 2) {
    this.set(about + (this.min - about) * factor, about + (this.max - about) * factor);
  }

  pan(share) {
    const by = share * (this.max - this.min);
    this.set(this.min + by, this.max + by);
  }
}

/** The first index from which on `at(i)` is not below x. */
export function bisect(at, length, x) {
  let from = 0;
  let to = length;
  while (from < to) {
    const middle = (from + to) >> 1;
    if (at(middle) < x) from = middle + 1;
    else to = middle;
  }
  return from;
}

/**
 * A plot: { title, label, note, lines: [{ run, curve, name, scale, colour, dash }] } over an Extent. Each line is
 * drawn at the level of detail that its stretch needs.
 */
export class Plot {
  constructor(spec, extent) {
    Object.assign(this, { spec, extent, visible: false, stale: true, height: 270 });
    extent.plots.push(this);
    this.box = h('div', { class: 'plot', tabindex: 0, role: 'group', 'aria-roledescription': 'plot' });
    this.element = h(
      'figure',
      {},
      h('figcaption', {}, h('h3', {}, spec.title), spec.note ? h('p', {}, spec.note) : null, this.limitsNote()),
      this.box,
    );
    this.box.addEventListener('keydown', (event) => this.key(event));
    this.box.addEventListener('wheel', (event) => this.wheel(event), { passive: false });
  }

  limitsNote() {
    const note = limitsNote(this.spec.limits ?? []);
    return note ? h('p', { class: 'limits' }, note) : null;
  }

  options() {
    const { spec, extent } = this;
    return {
      width: this.box.clientWidth || 600,
      height: this.height,
      scales: {
        x: { time: false, auto: false, range: () => [extent.min, extent.max] },
        y: spec.logarithmic ? { distr: 3 } : spec.limits?.length ? { range: (_, least, most) => withLimits(uPlot.rangeNum(least, most, 0.1, true), spec.limits) } : {},
      },
      axes: [axis(`${extent.name} (${extent.unit})`, { size: 34 }), axis(spec.label, { size: 66 })],
      legend: { live: true },
      cursor: {
        sync: { key: extent.name, scales: ['x', null] },
        drag: { x: true, y: false, setScale: false },
        bind: {
          dblclick: () => () => {
            extent.all();
            return null;
          },
        },
        points: { size: 7 },
      },
      hooks: {
        draw: [(u) => this.drawLimits(u)],
        setSelect: [
          (u) => {
            if (u.select.width < 3) return;
            extent.set(u.posToVal(u.select.left, 'x'), u.posToVal(u.select.left + u.select.width, 'x'));
            u.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
          },
        ],
      },
      series: [
        { label: extent.name, value: (_, x) => (x == null ? '–' : `${shown(x)} ${extent.unit}`) },
        ...spec.lines.map((line) => ({
          label: line.name,
          stroke: () => palettes[theme()][line.colour % 8],
          dash: dashes[line.dash ?? 0],
          width: 1.75,
          pxAlign: 0,
          points: { show: false },
          value: (_, y) => shown(y),
        })),
      ],
    };
  }

  /** A dashed line across for each limit that the scale of y reaches. */
  drawLimits(u) {
    const { ctx, bbox } = u;
    ctx.save();
    for (const { value, colour } of this.spec.limits ?? []) {
      if (!(value >= u.scales.y.min && value <= u.scales.y.max)) continue;
      const y = Math.round(u.valToPos(value, 'y', true)) + 0.5;
      ctx.strokeStyle = palettes[theme()][colour % 8];
      ctx.lineWidth = uPlot.pxRatio;
      ctx.setLineDash([8 * uPlot.pxRatio, 5 * uPlot.pxRatio]);
      ctx.beginPath();
      ctx.moveTo(bbox.left, y);
      ctx.lineTo(bbox.left + bbox.width, y);
      ctx.stroke();
    }
    ctx.restore();
  }

  /** Draws it; the element is in the document now. */
  start() {
    this.plot = new uPlot(this.options(), this.data(), this.box);
    this.legendByKeyboard();
    paintLegend(this.plot, this.spec.lines);
    this.describe();
    this.stale = false;
    new ResizeObserver(() => this.resize()).observe(this.box);
    new IntersectionObserver(([entry]) => {
      this.visible = entry.isIntersecting;
      if (this.visible && this.stale) this.refresh();
    }).observe(this.box);
  }

  resize() {
    const width = this.box.clientWidth;
    if (width > 0 && Math.abs(width - this.plot.width) > 1) this.size(width, this.height);
  }

  size(width, height) {
    this.plot.setSize({ width, height });
  }

  /** In the theme's colours. */
  recolour() {
    paintLegend(this.plot, this.spec.lines);
    this.plot.redraw(false);
  }

  refresh() {
    this.stale = false;
    this.plot.setData(this.data(), true);
  }

  /** The abscissa of a line's points. */
  abscissa(line, level) {
    if (this.spec.over === undefined) return (i) => line.run.time(level, i);
    const along = line.run.pyramid(this.spec.over).levels[level];
    return (i) => along[i];
  }

  /** How many points of a curve are worth drawing. */
  get most() {
    return Math.min(kMostPoints, kPerPixel * this.box.clientWidth * window.devicePixelRatio);
  }

  /** Per run a table of the points within the extent, at the level that is fine enough; joined. */
  data() {
    const tables = [];
    for (const run of new Set(this.spec.lines.map((line) => line.run))) {
      const lines = this.spec.lines.filter((line) => line.run === run);
      const pyramids = lines.map((line) => run.pyramid(line.curve));
      let level = 0;
      let from;
      let to;
      for (; level < pyramids[0].depth; ++level) {
        const at = this.abscissa(lines[0], level);
        const { length } = pyramids[0].levels[level];
        from = Math.max(0, bisect(at, length, this.extent.min) - 2);
        to = Math.min(length, bisect(at, length, this.extent.max) + 2);
        if (to - from <= this.most) break;
      }
      level = Math.min(level, pyramids[0].depth - 1);
      const at = this.abscissa(lines[0], level);
      const xs = Array.from({ length: to - from }, (_, i) => at(from + i));
      const ys = lines.map((line, j) => {
        const points = pyramids[j].levels[level];
        const scale = line.scale ?? 1;
        return Array.from({ length: to - from }, (_, i) => {
          const y = points[from + i];
          return Number.isNaN(y) ? null : y * scale;
        });
      });
      tables.push([xs, ...ys]);
    }
    return this.inOrder(tables.length === 1 ? tables[0] : uPlot.join(tables));
  }

  /** join() puts a run's lines next to each other; the series stand as the lines do. */
  inOrder(data) {
    const runs = [...new Set(this.spec.lines.map((line) => line.run))];
    const joined = runs.flatMap((run) => this.spec.lines.filter((line) => line.run === run));
    return [data[0], ...this.spec.lines.map((line) => data[1 + joined.indexOf(line)])];
  }

  /** Those of the legend's rows that are curves: not the abscissa's. */
  legendRows() {
    const [abscissa, ...rows] = this.plot.root.querySelectorAll('.u-legend .u-series');
    abscissa.querySelector('th').style.pointerEvents = 'none';
    return rows;
  }

  legendByKeyboard() {
    this.legendRows().forEach((row, i) => {
      const head = row.querySelector('th');
      const say = () => head.setAttribute('aria-pressed', String(this.plot.series[i + 1].show));
      head.tabIndex = 0;
      head.setAttribute('role', 'button');
      head.addEventListener('click', () => queueMicrotask(say));
      head.addEventListener('keydown', (event) => {
        if (event.key !== 'Enter' && event.key !== ' ') return;
        event.preventDefault();
        event.stopPropagation();
        head.click();
      });
      say();
    });
  }

  /** What one who can't see the plot is told of it. */
  describe() {
    const ranges = this.spec.lines.map((line) => {
      let least = Infinity;
      let greatest = -Infinity;
      for (const y of line.run.pyramid(line.curve).levels.at(-1)) {
        if (y < least) least = y;
        if (y > greatest) greatest = y;
      }
      const scale = line.scale ?? 1;
      return `${line.name} from ${shown(least * scale, 4)} to ${shown(greatest * scale, 4)}`;
    });
    this.box.setAttribute('aria-label', `${this.spec.title}: ${this.spec.label}. ${ranges.join('; ')}`);
  }

  key(event) {
    const { extent } = this;
    const act = {
      ArrowLeft: () => (event.shiftKey ? extent.pan(-0.2) : this.moveCursor(-1)),
      ArrowRight: () => (event.shiftKey ? extent.pan(0.2) : this.moveCursor(1)),
      '+': () => extent.zoom(0.5),
      '=': () => extent.zoom(0.5),
      '-': () => extent.zoom(2),
      0: () => extent.all(),
      Home: () => extent.all(),
    }[event.key];
    if (!act || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    act();
  }

  moveCursor(by) {
    const u = this.plot;
    const [xs] = u.data;
    const step = Math.max(1, Math.round(xs.length / 100));
    const now = u.cursor.idx ?? bisect((i) => xs[i], xs.length, (this.extent.min + this.extent.max) / 2);
    const idx = Math.min(Math.max(now + by * step, 0), xs.length - 1);
    u.setCursor({ left: u.valToPos(xs[idx], 'x'), top: u.bbox.height / uPlot.pxRatio / 2 });
    clearTimeout(this.saying);
    this.saying = setTimeout(() => {
      const values = this.spec.lines.map((line, i) => `${line.name} ${shown(u.data[i + 1][idx], 4)}`);
      document.getElementById('said').textContent = `${shown(xs[idx])} ${this.extent.unit}: ${values.join(', ')}`;
    }, 300);
  }

  wheel(event) {
    if (event.ctrlKey) {
      const rect = this.plot.over.getBoundingClientRect();
      this.extent.zoom(event.deltaY > 0 ? 1.25 : 0.8, this.plot.posToVal(event.clientX - rect.left, 'x'));
    } else if (event.shiftKey) {
      this.extent.pan(((event.deltaX || event.deltaY) > 0 ? 1 : -1) * 0.1);
    } else {
      return;
    }
    event.preventDefault();
  }
}
