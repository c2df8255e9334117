// Looks at a report of two runs of another robot than the paper's, the second with a fault and limits:
// node compare.mjs CHROMIUM REPORT.html. Prints "held", or throws.
import assert from 'node:assert/strict';
import { pathToFileURL } from 'node:url';
import { opened } from './browser.mjs';

const [executable, page] = process.argv.slice(2);

await opened(executable, async (browser, tab) => {
  await tab.goto(pathToFileURL(page).href);
  await tab.waitForSelector('html[data-ready]');

  // It begins with what differs, and with nothing else.
  const first = await tab.evaluate(() => document.querySelector('#summary h2').nextElementSibling.id);
  assert.equal(first, 'differences');
  const rows = await tab.evaluate(() => [...document.querySelectorAll('#differences tbody tr')].map((row) => [...row.children].map((cell) => cell.textContent)));
  const named = Object.fromEntries(rows.map(([name, ...values]) => [name, values]));
  assert.deepEqual(named['plant.integrator'], ['–', 'leapfrog']);
  assert.deepEqual(named['integrator.name'], ['rk4', 'leapfrog']);
  assert.deepEqual(named['fault 1'], ['–', 'motor turn is off by 0.1 N m from 0.1 s on, for 0.05 s']);
  assert.ok(!('rate' in named) && !('scene.name' in named), 'what is the same is left out');

  // Nothing of the paper; each motor in its unit.
  const text = await tab.textContent('main');
  assert.doesNotMatch(text, /paper/i);
  assert.match(text, /Largest torques.* N, .* N m/);
  assert.match(text, /Faults in the plant.*motor turn is off by 0\.1 N m/);

  // Limits are said, and drawn where the curves come near.
  const limited = await tab.evaluate(() => window.mixloop.plots.filter(({ spec }) => spec.limits?.length).map(({ spec, plot }) => ({ title: spec.title, limits: spec.limits, max: plot.scales.y.max })));
  const force = limited.find(({ title }) => title.includes('torques') && title.includes('slide'));
  assert.ok(force.limits.some(({ value }) => value === 20), JSON.stringify(force));
  assert.ok(force.max >= 20, 'the limit is in the picture');
  assert.match(text, /slide, the plant’s limit: ±20/);
  assert.match(text, /past it a run has diverged: 100/);
});
console.log('held');
