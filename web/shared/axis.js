import { shown } from './dom.js';
import { cssColour } from './theme.js';

/** An axis as all plots have it. */
export function axis(label, extra) {
  return {
    label,
    labelSize: 22,
    labelGap: 2,
    font: '12px system-ui, "DejaVu Sans", sans-serif',
    labelFont: '13px system-ui, "DejaVu Sans", sans-serif',
    stroke: () => cssColour('--quiet'),
    grid: { stroke: () => cssColour('--grid'), width: 1 },
    ticks: { stroke: () => cssColour('--line'), width: 1 },
    values: (_, splits) => splits.map((value) => (value === null ? '' : shown(value, 5))),
    ...extra,
  };
}
