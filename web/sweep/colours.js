/** Viridis (S. van der Walt & N. Smith, CC0): even in brightness, also for the colour-blind and on grey paper. */
const stops = ['#440154', '#482878', '#3e4a89', '#31688e', '#26828e', '#1f9e89', '#35b779', '#6ece58', '#b5de2b', '#fde725'].map(
  (colour) => [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16)),
);

/** The colour of a share from 0 to 1. */
export function viridis(share) {
  const at = Math.min(Math.max(share, 0), 1) * (stops.length - 1);
  const i = Math.min(Math.floor(at), stops.length - 2);
  const mixed = stops[i].map((from, k) => Math.round(from + (stops[i + 1][k] - from) * (at - i)));
  return `rgb(${mixed.join(',')})`;
}

/** It all, from left to right, as CSS. */
export function gradient() {
  return `linear-gradient(to right, ${stops.map((stop) => `rgb(${stop.join(',')})`).join(', ')})`;
}

/**
 * Numbers to shares, so far as the middle 96 % of the cells reach, so that a few that lie far outside don't take all the
 * colours; of counts, which are all of them shown, and of numbers that go over more than a power of ten, by their logarithm.
 */
export function scaleOf(numbers, counts) {
  const sorted = Float64Array.from(numbers).sort();
  if (sorted.length === 0) return null;
  const last = sorted.length - 1;
  const all = [sorted[0], sorted[last]];
  let [from, to] = counts ? all : [sorted[Math.floor(0.02 * last)], sorted[Math.ceil(0.98 * last)]];
  if (from === to) [from, to] = all;
  const logarithmic = counts || (from > 0 && to > 10 * from);
  const of = logarithmic ? Math.log : (x) => x;
  const width = of(to) - of(from);
  return { from, to, logarithmic, clipsBelow: all[0] < from, clipsAbove: all[1] > to, share: (x) => (width > 0 ? (of(x) - of(from)) / width : 0.5) };
}
