import { Pyramid } from './pyramid.js';
import { unpack } from './unpack.js';

/** The columns of a row of the plant's TIMING. */
const kTiming = [
  'timing_time', 'round_trip_p50', 'round_trip_p99', 'round_trip_max', 'wake_up_p50', 'wake_up_p99', 'wake_up_max',
  'missed', 'resent', 'overruns',
];

/** A run with its curves at every level of detail. */
export class Run {
  constructor(data, values, index) {
    Object.assign(this, data);
    this.index = index;
    this.pyramids = new Map();
    this.offsets = data.curves;
    this.values = values;
    const rows = data.log?.timing ?? [];
    this.timing = new Map(rows.length > 1 ? kTiming.map((name, i) => [name, Float32Array.from(rows, (row) => row[i])]) : []);
    for (const [name, column] of this.timing) {
      if (!/_p50|_p99|_max/.test(name)) continue;
      if (!column.some((time) => time > 0)) this.timing.delete(name); // lockstep at full speed wakes for no tick
      column.forEach((time, i) => (column[i] = time > 0 ? time : NaN)); // nothing yet
    }
    /** Ticks from one point to the next. */
    this.step = data.width === 1 ? 1 : data.width / 2;
  }

  has(curve) {
    return curve in this.offsets || this.timing.has(curve);
  }

  /** The curve's points, finest level. */
  points(curve) {
    if (this.timing.has(curve)) return this.timing.get(curve);
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
