/** Coarser and coarser copies of a curve, each half as long, that keep every peak: of each four points the
 * least and the greatest in the order in which they come. Gaps are NaN. */
export class Pyramid {
  /** @param {Float32Array} points evenly spaced in time */
  constructor(points) {
    this.levels = [points];
    while (this.levels.at(-1).length > 512) this.levels.push(halved(this.levels.at(-1)));
  }

  /** How many levels there are. */
  get depth() {
    return this.levels.length;
  }
}

/** @param {Float32Array} from */
function halved(from) {
  const to = new Float32Array(2 * Math.ceil(from.length / 4));
  for (let i = 0, j = 0; i < from.length; i += 4, j += 2) {
    let least = -1;
    let greatest = -1;
    for (let k = i; k < Math.min(i + 4, from.length); ++k) {
      if (Number.isNaN(from[k])) continue;
      if (least < 0 || from[k] < from[least]) least = k;
      if (greatest < 0 || from[k] > from[greatest]) greatest = k;
    }
    to[j] = least < 0 ? NaN : from[Math.min(least, greatest)];
    to[j + 1] = least < 0 ? NaN : from[Math.max(least, greatest)];
  }
  return to;
}
