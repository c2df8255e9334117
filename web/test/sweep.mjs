// Looks at the report of a sweep in a browser: node sweep.mjs CHROMIUM REPORT.html TABLE.csv. Prints how long the page takes
// and how smoothly it goes, or throws.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { pathToFileURL } from 'node:url';
import { opened } from './browser.mjs';
import { contrast } from './contrast.mjs';

const [executable, page, csv] = process.argv.slice(2);
const [header, ...lines] = readFileSync(csv, 'utf8').trim().split('\n');
const names = header.split(',').map((name) => name.replace(/ \[.*/, ''));
const rows = lines.map((line) => line.split(','));
const column = (name) => rows.map((row) => Number(row[names.indexOf(name)]));
const greatest = (numbers) => numbers.reduce((a, b) => Math.max(a, b));

await opened(executable, async (browser, tab) => {
  const asked = [];
  tab.on('request', (request) => asked.push(request.url()));
  const begun = Date.now();
  await tab.goto(pathToFileURL(page).href);
  await tab.waitForSelector('html[data-ready]');
  const ready = Date.now() - begun;
  assert.deepEqual(asked.filter((url) => !url.startsWith('file:') && !url.startsWith('data:')), [], 'asks for nothing');

  // Each variable's figure has every run; units at the axes.
  const figures = await tab.evaluate(() =>
    window.mixloop.figures.filter((one) => one.variable).map(({ variable, plot }) => ({
      name: variable.name, runs: plot.data[1].reduce((a, b) => a + b, 0) + plot.data[2].reduce((a, b) => a + b, 0), label: plot.axes[0].label,
    })));
  for (const name of ['max_position_error', 'max_torque[0]', 'parameters.payload', 'plant.command_delay'])
    assert.equal(figures.find((one) => one.name === name)?.runs, rows.length, name);
  assert.ok(figures.some(({ label }) => label === 'max_position_error (mm)'));

  // A map that is chosen: its cells are the table's.
  const seen = () => tab.evaluate(() => {
    const { map } = window.mixloop;
    return { runs: map.cells.reduce((all, cell) => all + cell.runs, 0), title: map.title.textContent, worst: map.cells.map((cell) => cell.metric(0)) };
  });
  const choose = async (id, label) => tab.locator(id).selectOption({ label });
  await choose('#map-x', 'plant.command_delay');
  await choose('#map-y', 'parameters.payload');
  await choose('#map-colour', 'largest max_position_error');
  const across = await seen();
  assert.equal(across.title, 'parameters.payload over plant.command_delay: largest max_position_error');
  assert.equal(across.runs, rows.length);
  const errors = column('max_position_error');
  const worst = across.worst.reduce((a, b) => (b.worst > a.worst ? b : a));
  assert.equal(worst.run, errors.indexOf(greatest(errors)), 'the worst run of all is that of a cell');
  assert.ok(Math.abs(worst.worst / greatest(errors) - 1) < 1e-4, 'to four digits');
  await choose('#map-y', 'max_torque[0]');
  await choose('#map-colour', 'runs in the cell');
  assert.equal((await seen()).runs, rows.length);
  // The same two the other way about are the same cells.
  const product = () => tab.evaluate(() => window.mixloop.map.cells.reduce((all, cell) => all + (cell.x + 1) * (100 + cell.y) * cell.runs, 0));
  await choose('#map-y', 'parameters.payload');
  const [one, other] = [await product(), await tab.evaluate(() => window.mixloop.map.cells.reduce((all, cell) => all + (cell.y + 1) * (100 + cell.x) * cell.runs, 0))];
  await choose('#map-x', 'parameters.payload');
  await choose('#map-y', 'plant.command_delay');
  assert.equal(await product(), other);
  assert.notEqual(one, other);

  // By keyboard: to a cell, on, and kept; its numbers are said, and its worst run's command copied.
  await tab.focus('.map');
  await tab.keyboard.press('ArrowRight');
  await tab.keyboard.press('Enter');
  const told = await tab.textContent('#map-readout');
  assert.match(told, /parameters\.payload .* kg, plant\.command_delay .* us: \d+ runs.*mean [\d.]+ mm, largest [\d.]+ mm in run \d+/);
  assert.equal(await tab.textContent('#said'), told);
  await tab.keyboard.press('ArrowUp');
  assert.notEqual(await tab.textContent('#map-readout'), told);
  const command = await tab.getAttribute('#map-readout button', 'data-text').catch(() => null);
  assert.match(command ?? '', /^mixloop sweep .* --write-run \d+ && mixloop simulate /);
  await tab.focus('#distributions .plot');
  await tab.keyboard.press('ArrowRight');
  assert.match(await tab.textContent('#said'), /\d+ runs, /);

  // What moves what: the payload moves the error; the worst runs, with their commands.
  await choose('#influence-metric', 'max_position_error');
  assert.match(await tab.textContent('#influence-shown'), /parameters\.payload moves max_position_error most: 9\d(\.\d)? % ± /);
  await choose('#worst-metric', 'largest max_torque[1]');
  const torques = column('max_torque[1]');
  assert.equal(await tab.textContent('#worst-shown tbody th'), String(torques.indexOf(greatest(torques))));
  await tab.click('#worst-shown tbody button');
  await tab.waitForFunction(() => /Copied|Not allowed/.test(document.getElementById('said').textContent));

  // Counts by their logarithm.
  await tab.check('#log-counts');
  assert.equal(await tab.evaluate(() => window.mixloop.figures[0].plot.scales.y.distr), 3);

  // How long another map takes.
  const drawn = await tab.evaluate(async () => {
    const { map } = window.mixloop;
    const from = performance.now();
    for (let i = 0; i < 20; ++i) {
      map.colour.select.selectedIndex = i % map.colour.select.length;
      map.show();
    }
    const another = (performance.now() - from) / 20;
    const frame = () => new Promise(requestAnimationFrame);
    const begun = performance.now();
    let frames = 0;
    for (; performance.now() - begun < 500; ++frames) {
      map.mark({ x: 1 + (frames % 20), y: 1 + (frames % 17) }); // as the pointer goes over it
      await frame();
    }
    return { another, rate: (1000 * frames) / (performance.now() - begun) };
  });

  // A narrow window shows all of it; light and dark text stands out.
  await tab.setViewportSize({ width: 380, height: 800 });
  await tab.waitForFunction(() => window.mixloop.map.plot.width < 380);
  assert.ok(await tab.evaluate(() => document.scrollingElement.scrollWidth <= window.innerWidth + 1), 'no wider than the window');
  for (const colorScheme of ['light', 'dark']) {
    await tab.emulateMedia({ colorScheme });
    const [paper, panel, ...text] = await tab.evaluate(() => ['--paper', '--panel', '--ink', '--quiet', '--accent'].map((name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim()));
    for (const colour of text) for (const ground of [paper, panel]) assert.ok(contrast(colour, ground) >= 4.5, `${colorScheme}: ${colour} on ${ground}`);
  }
  console.log(`ready after ${ready} ms, another map in ${drawn.another.toFixed(1)} ms, ${drawn.rate.toFixed(0)} frames a second while the pointer goes over it`);
});
