const kMost = 4000; // places: of a live run the latest

/** The path travelled: a line that grows, shown up to a time. */
export class Trail {
  /**
   * @param {(ends: Float32Array) => LineSegmentsGeometry} drawn draws pieces from place to place
   * @param {number} least m: what moved less is left out, since nobody can see it
   */
  constructor(drawn, least) {
    this.least = least;
    this.geometry = drawn(new Float32Array(6 * kMost));
    this.pieces = this.geometry.attributes.instanceStart.data; // each: the place before, the place
    this.times = new Float64Array(kMost);
    this.forget();
  }

  forget() {
    this.travelled = 0;
    this.until = -Infinity;
    this.geometry.instanceCount = 0;
  }

  /** Adds t, x, y, z a place. */
  add(way) {
    const { array } = this.pieces;
    for (let i = 0; i < way.length; i += 4) {
      const place = way.slice(i + 1, i + 4);
      const before = this.travelled > 0 ? array.slice(6 * this.travelled - 3, 6 * this.travelled) : place;
      const moved = Math.hypot(...place.map((x, axis) => x - before[axis]));
      if (this.travelled > 0 && moved < this.least) continue;
      if (this.travelled === kMost) this.dropOldest(kMost / 4);
      this.times[this.travelled] = way[i];
      array.set([...before, ...place], 6 * this.travelled++);
    }
    this.pieces.needsUpdate = true;
    this.show(this.until);
  }

  dropOldest(count) {
    this.pieces.array.copyWithin(0, 6 * count);
    this.times.copyWithin(0, count);
    this.travelled -= count;
  }

  /** Shows it up to time t. */
  show(t) {
    this.until = t;
    let count = this.travelled;
    while (count > 0 && this.times[count - 1] > t) --count;
    this.geometry.instanceCount = count;
  }
}
