import { palettes, theme } from './theme.js';

const borders = ['solid', 'dashed', 'dotted', 'dashed'];

/** Gives the legend of a uPlot its curves' colours in this theme, and their dashes: [{ colour, dash }], a curve each. */
export function paintLegend(u, curves) {
  const markers = [...u.root.querySelectorAll('.u-legend .u-marker')].slice(-curves.length);
  markers.forEach((marker, i) => {
    marker.style.borderColor = palettes[theme()][curves[i].colour % 8];
    marker.style.borderStyle = borders[curves[i].dash ?? 0];
  });
}
