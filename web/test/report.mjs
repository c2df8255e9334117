// Looks at a report in a browser: node report.mjs CHROMIUM REPORT.html TRAJECTORY.csv. Prints "held", or throws.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { pathToFileURL } from 'node:url';
import { opened } from './browser.mjs';
import { contrast } from './contrast.mjs';

const [executable, page, csv] = process.argv.slice(2);
const [header, ...lines] = readFileSync(csv, 'utf8').trim().split('\n');
const rows = lines.map((line) => line.split(',').map(Number));
const names = header.split(',');
const column = (name) => rows.map((row) => row[names.indexOf(name)]);

await opened(executable, async (browser, tab) => {
  const asked = [];
  tab.on('request', (request) => asked.push(request.url()));
  await tab.goto(pathToFileURL(page).href);
  await tab.waitForSelector('html[data-ready]');
  assert.deepEqual(asked.filter((url) => !url.startsWith('file:') && !url.startsWith('data:')), [], 'asks for nothing');

  // The numbers are the trajectory's, as floats.
  for (const name of ['psi_1', 'tau_3', 'position_x_actual', 'acceleration_z_desired', 'work', 'psi_desired_2']) {
    const points = await tab.evaluate((curve) => [...window.mixloop.runs[0].points(curve)], name);
    assert.deepEqual(points, column(name).map(Math.fround), name);
  }

  // The paper's figures and the rest, each with its title and the units of both axes.
  const plots = await tab.evaluate(() =>
    window.mixloop.plots.map(({ spec, plot }) => ({ title: spec.title, labels: plot.axes.map((axis) => axis.label), points: plot.data[0].length })),
  );
  for (const part of ['Figure 2', 'Figure 3', 'Figure 4', 'Figure 5', 'error over time', 'error in space', 'along the path', 'Motor coordinates', 'Dependent coordinates', 'Energy balance', 'Power balance'])
    assert.ok(plots.some(({ title }) => title.includes(part)), part);
  for (const { title, labels } of plots) for (const label of labels) assert.match(label, /\(.+\)$/, `${title}: unit`);
  assert.ok(plots.every(({ points }) => points <= 3010), 'no more points than a screen shows');
  const text = await tab.textContent('main');
  for (const part of ['13.2066936 mm', '12 mm', '✓ held', 'max_position_error', 'SHA-256', 'Processor', 'Seeds', 'feedforward_at'])
    assert.ok(text.includes(part), part);

  // The path from three sides: the trajectory's places, a metre as long along both axes.
  for (const [across, up] of ['xy', 'xz', 'yz']) {
    const seen = await tab.evaluate(([x, y]) => {
      const { plot } = window.mixloop.plots.find(({ spec }) => spec.axes?.join('') === x + y);
      const pixels = (key, to) => Math.abs(plot.valToPos(plot.scales[key].min + to, key, true) - plot.valToPos(plot.scales[key].min, key, true));
      return { metres: [pixels('x', 0.1), pixels('y', 0.1)], actual: plot.data[1].map((list) => [...list]), desired: plot.data[2].map((list) => [...list]) };
    }, [across, up]);
    assert.ok(Math.abs(seen.metres[0] / seen.metres[1] - 1) < 0.02, `${seen.metres} pixels`); // of whole pixels
    for (const kind of ['actual', 'desired'])
      assert.deepEqual(seen[kind], [across, up].map((axis) => column(`position_${axis}_${kind}`).map(Math.fround)));
  }

  // The highest peak is drawn, however far one has zoomed out.
  const drawn = await tab.evaluate(() => {
    const { plot } = window.mixloop.plots.find((one) => one.spec.title.includes('over time'));
    return Math.max(...plot.data[1].filter((y) => y !== null));
  });
  const [actual, desired] = ['actual', 'desired'].map((kind) => ['x', 'y', 'z'].map((axis) => column(`position_${axis}_${kind}`)));
  const error = rows.map((_, k) => Math.hypot(...[0, 1, 2].map((i) => actual[i][k] - desired[i][k])));
  assert.ok(Math.abs(drawn - 1e3 * Math.max(...error)) < 1e-5, `${drawn} mm drawn`); // a float's rounding of 13 mm

  // By keyboard alone: zoom, pan, cursor, a curve hidden, all again.
  const extent = () => tab.evaluate(() => [window.mixloop.time.min, window.mixloop.time.max]);
  await tab.focus('.plot');
  await tab.keyboard.press('+');
  assert.deepEqual(await extent(), [0.25, 0.75]);
  await tab.keyboard.press('Shift+ArrowRight');
  assert.deepEqual((await extent()).map((x) => x.toFixed(3)), ['0.350', '0.850']);
  await tab.keyboard.press('ArrowRight');
  await tab.waitForFunction(() => document.getElementById('said').textContent.includes(' s: '));
  await tab.keyboard.press('0');
  assert.deepEqual(await extent(), [0, 1]);
  await tab.keyboard.press('Tab');
  await tab.keyboard.press('Enter');
  assert.equal(await tab.evaluate(() => document.activeElement.getAttribute('aria-pressed')), 'false');
  assert.equal(await tab.evaluate(() => window.mixloop.plots[0].plot.series[1].show), false);

  // Light and dark: text and curves stand out.
  for (const scheme of ['light', 'dark']) {
    await tab.emulateMedia({ colorScheme: scheme });
    for (const { colours, paper, least, what } of await tab.evaluate(coloursUsed))
      for (const colour of colours)
        assert.ok(contrast(colour, paper) >= least, `${scheme}: ${what} ${colour} on ${paper} has ${contrast(colour, paper).toFixed(2)}`);
  }
});
console.log('held');

/** In the page: what is drawn in which colours. */
function coloursUsed() {
  const style = getComputedStyle(document.documentElement);
  const of = (...names) => names.map((name) => style.getPropertyValue(name).trim());
  const strokes = new Set(window.mixloop.plots.flatMap(({ plot }) => plot.series.slice(1).map((one) => one.stroke(plot))));
  return of('--paper', '--panel').flatMap((paper) => [
    { what: 'text', paper, least: 4.5, colours: of('--ink', '--quiet', '--accent', '--held', '--missed') },
    { what: 'curve', paper, least: 3, colours: [...strokes] },
  ]);
}
