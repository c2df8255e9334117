import { shown } from '../shared/dom.js';

/** What the runs differ in, with its numbers as people read them: lengths below a metre in mm. */
export class Variable {
  constructor(data, index) {
    Object.assign(this, data, { index });
    const small = data.kind === 'measured' && data.unit === 'm' && Math.max(Math.abs(data.least), Math.abs(data.most)) < 1;
    this.factor = small ? 1e3 : 1;
    this.shownUnit = small ? 'mm' : data.unit;
  }

  get isEntry() {
    return ['drawn', 'listed', 'words'].includes(this.kind);
  }

  get varies() {
    return this.most > this.least;
  }

  /** The name with its unit, for an axis. */
  get label() {
    return this.shownUnit ? `${this.name} (${this.shownUnit})` : this.name;
  }

  get worstWord() {
    return this.least_is_worst ? 'least' : 'largest';
  }

  /** A value without its unit, of words the word. */
  text(value, digits = 6) {
    if (value === null || Number.isNaN(value)) return '–';
    return this.words ? this.words[value] : shown(value * this.factor, digits);
  }

  /** A value with its unit. */
  withUnit(value, digits = 6) {
    if (this.kind === 'held') return `${shown(100 * value, 4)} % not held`;
    const text = this.text(value, digits);
    return this.shownUnit && text !== '–' ? `${text} ${this.shownUnit}` : text;
  }
}

/** Cells along a variable, as places on an axis: of even cells the numbers shown, else 0, 1, 2, ... */
export class Cells {
  /** @param {boolean[]} occupied of the cells, those outside included */
  constructor(variable, axis, occupied) {
    Object.assign(this, { variable, axis, even: axis.kind === 'even' });
    this.count = this.even ? axis.cells + 2 : axis.cells;
    this.from = axis.from * variable.factor;
    this.to = axis.to * variable.factor;
    if (this.to === this.from) this.to = this.from + (Math.abs(this.from) || 1) * 1e-6;
    this.below = this.even && Boolean(occupied[0]);
    this.above = this.even && Boolean(occupied[this.count - 1]);
  }

  /** Where so many cells end, of even ones; also before the first and behind the last. */
  edge(cells) {
    const share = cells / this.axis.cells;
    return this.axis.logarithmic ? this.from * (this.to / this.from) ** share : this.from + share * (this.to - this.from);
  }

  /** Where a cell begins and ends; those of all below and above stand apart. */
  place(cell) {
    if (!this.even) return [cell - 0.5, cell + 0.5];
    const first = cell === 0 ? -2 : cell === this.count - 1 ? cell : cell - 1;
    return [this.edge(first), this.edge(first + 1)];
  }

  /** A cell's middle. */
  middle(cell) {
    const [from, to] = this.place(cell);
    return this.axis.logarithmic ? Math.sqrt(from * to) : (from + to) / 2;
  }

  get range() {
    if (!this.even) return [-0.5, this.count - 0.5];
    return [this.edge(this.below ? -2.5 : 0), this.edge(this.axis.cells + (this.above ? 2.5 : 0))];
  }

  /** uPlot's scale of it. */
  get scale() {
    return { time: false, distr: this.axis.logarithmic ? 3 : 1, range: () => this.range };
  }

  /** The cell at a place, -1 where there is none. */
  at(place) {
    for (let cell = 0; cell < this.count; ++cell) {
      const [from, to] = this.place(cell);
      if (place >= from && place < to) return cell;
    }
    return place === this.to ? this.count - 2 : -1;
  }

  /** What a cell holds, in words. */
  words(cell) {
    const { variable, axis } = this;
    if (axis.kind === 'words') return this.nameOf(cell);
    const unit = variable.shownUnit ? ` ${variable.shownUnit}` : '';
    if (axis.kind === 'values') return `${shown(axis.values[cell] * variable.factor)}${unit}`;
    if (cell === 0) return `below ${shown(this.from, 5)}${unit}`;
    if (cell === this.count - 1) return `above ${shown(this.to, 5)}${unit}`;
    const [from, to] = this.place(cell);
    return `${shown(from, 5)} to ${shown(to, 5)}${unit}`;
  }

  /** A cell of its own value or word. */
  nameOf(cell) {
    const { axis, variable } = this;
    if (axis.kind === 'values') return shown(axis.values[cell] * variable.factor);
    const others = cell === axis.cells - 1 && variable.words.length > axis.cells;
    return others ? `${variable.words[cell]} and ${variable.words.length - axis.cells} more` : variable.words[cell];
  }

  /** What uPlot needs of an axis that is no scale of numbers. */
  get ticks() {
    if (this.even) return this.axis.logarithmic ? { label: `${this.variable.label}, by the logarithm` } : {};
    const step = Math.ceil(this.count / 12);
    const splits = [];
    for (let cell = 0; cell < this.count; cell += step) splits.push(cell);
    const short = (text) => (text.length > 14 ? `${text.slice(0, 13)}…` : text);
    return { splits: () => splits, values: () => splits.map((cell) => short(this.nameOf(cell))) };
  }
}
