import { axis } from '../shared/axis.js';
import { shown } from '../shared/dom.js';
import { dashes, palettes, theme } from '../shared/theme.js';
import { bisect, kMostPoints, Plot } from './plot.js';

/**
 * A path seen along an axis: { title, axes: ['x', 'y'], lines: [{ run, curves: [horizontal, vertical], name, colour,
 * dash }] }, both axes to one scale. The stretch of time that the other plots show is drawn.
 */
export class Projection extends Plot {
  constructor(spec, extent) {
    super(spec, extent);
    this.height = 330;
  }

  options() {
    const { axes, lines } = this.spec;
    this.middle = [0, 1].map((i) => this.reach(i));
    return {
      mode: 2,
      width: this.box.clientWidth || 600,
      height: this.height,
      scales: {
        x: { time: false, auto: false, range: (u) => this.range(u, 0) },
        y: { auto: false, range: (u) => this.range(u, 1) },
      },
      axes: [axis(`${axes[0]} (m)`, { size: 34 }), axis(`${axes[1]} (m)`, { size: 66 })],
      legend: { live: false },
      cursor: { show: false },
      series: [
        {},
        ...lines.map((line) => ({
          label: line.name,
          facets: [{ scale: 'x', auto: false }, { scale: 'y', auto: false }],
          stroke: () => palettes[theme()][line.colour % 8],
          dash: dashes[line.dash ?? 0],
          width: 1.75,
          pxAlign: 0,
          points: { show: false },
          paths: (u, i) => ({ stroke: drawn(u, u.data[i]), fill: null, clip: null, flags: 0 }),
        })),
      ],
    };
  }

  /** The least and the greatest that a line reaches along axis i, over the whole run. */
  reach(i) {
    let [least, greatest] = [Infinity, -Infinity];
    for (const { run, curves } of this.spec.lines)
      for (const value of run.pyramid(curves[i]).levels.at(-1)) {
        if (value < least) least = value;
        if (value > greatest) greatest = value;
      }
    return least <= greatest ? [least, greatest] : [0, 1];
  }

  /** Of axis i: a metre is as long along the other one. */
  range(u, i) {
    const { width, height } = u.bbox.width > 0 ? u.bbox : { width: 2, height: 1 };
    const spans = this.middle.map(([least, greatest]) => 1.1 * (greatest - least));
    const metre = Math.max(spans[0] / width, spans[1] / height, 1e-9);
    const half = (metre * (i === 0 ? width : height)) / 2;
    const [least, greatest] = this.middle[i];
    return [(least + greatest) / 2 - half, (least + greatest) / 2 + half];
  }

  start() {
    super.start();
    this.refresh(); // now that the room for it is known
  }

  size(width, height) {
    super.size(width, height);
    this.refresh(); // to one scale again
  }

  data() {
    return [[], ...this.spec.lines.map((line) => this.places(line))];
  }

  /** [xs, ys] of a line within the extent: of a long run the middles of a few ticks each. */
  places({ run, curves }) {
    const [across, up] = curves.map((curve) => run.pyramid(curve));
    for (let level = 0; ; ++level) {
      const { length } = across.levels[level];
      const at = (i) => run.time(level, i);
      const from = Math.max(0, bisect(at, length, this.extent.min) - 1) & ~1;
      const to = Math.min(length, bisect(at, length, this.extent.max) + 1);
      if (to - from > kMostPoints && level + 1 < across.depth) continue;
      const parts = [across, up].map(({ levels }) => levels[level].subarray(from, to));
      return run.step === 1 && level === 0 ? parts : parts.map(middles);
    }
  }

  describe() {
    const { title, axes, lines } = this.spec;
    const ranges = axes.map((name, i) => `${name} from ${this.middle[i].map((value) => shown(value, 4)).join(' to ')} m`);
    this.box.setAttribute('aria-label', `${title}: ${lines.map(({ name }) => name).join(', ')}. ${ranges.join('; ')}`);
  }

  legendRows() {
    return [...this.plot.root.querySelectorAll('.u-legend .u-series')];
  }

  moveCursor() {}
}

/** Of each two values, the least and the greatest of a stretch, the middle. */
function middles(values) {
  return Float32Array.from({ length: values.length >> 1 }, (_, i) => (values[2 * i] + values[2 * i + 1]) / 2);
}

/** The line through the places; it is broken where one isn't known. */
function drawn(u, [xs, ys]) {
  const path = new Path2D();
  let going = false;
  for (let i = 0; i < xs.length; ++i) {
    const known = !Number.isNaN(xs[i]) && !Number.isNaN(ys[i]);
    if (known) path[going ? 'lineTo' : 'moveTo'](u.valToPos(xs[i], 'x', true), u.valToPos(ys[i], 'y', true));
    going = known;
  }
  return path;
}
