import { Pyramid } from './pyramid.js';
import { unpack } from './unpack.js';

/** A run with its curves at every level of detail. */
export class Run {
  constructor(data, values, index) {
    Object.assign(this, data);
    this.index = index;
    this.pyramids = new Map();
    this.offsets = data.curves;
    this.values = values;
    /** Ticks from one point to the next. */
    this.step = data.width === 1 ? 1 : data.width / 2;
  }

  has(curve) {
    return curve in this.offsets;
  }

  /** The curve's points, finest level. */
  points(curve) {
    return this.values.subarray(this.offsets[curve], this.offsets[curve] + this.length);
  }

  pyramid(curve) {
    if (!this.pyramids.has(curve)) this.pyramids.set(curve, new Pyramid(this.points(curve)));
    return this.pyramids.get(curve);
  }

  /** The plant time of a point, s. */
  time(level, i) {
    return (this.first_tick + i * this.step * 2 ** level) / this.rate;
  }

  get end() {
    return (this.first_tick + this.ticks - 1) / this.rate;
  }

  get start() {
    return this.first_tick / this.rate;
  }
}

/** Reads the data that the page was made with. */
export async function readRuns(data) {
  const values = await unpack(data.curves, data.values);
  return data.runs.map((run, index) => new Run(run, values, index));
}
