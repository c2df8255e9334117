// How smoothly a report pans: node pan.mjs CHROMIUM REPORT.html. The paper's figures are on the screen, a quarter of the
// time is shown, and every frame moves it by a hundredth. Prints the frames a second that were drawn, or throws where a
// curve has more points than a screen has columns for: that is what makes it smooth, on any machine.
import assert from 'node:assert/strict';
import { pathToFileURL } from 'node:url';
import { opened } from './browser.mjs';

const [executable, page] = process.argv.slice(2);
const most = 3000; // plot.js: kMostPoints

/** In the page: pans for so many ms; frames a second. */
async function pan(ms) {
  const { time } = window.mixloop;
  const frame = () => new Promise(requestAnimationFrame);
  document.getElementById('paper-figures').scrollIntoView();
  time.zoom(0.25, time.least);
  for (let i = 0; i < 3; ++i) await frame(); // what comes into sight is drawn
  const begun = performance.now();
  let frames = 0;
  let by = 0.01;
  while (performance.now() - begun < ms) {
    if (time.max >= time.greatest) by = -0.01;
    if (time.min <= time.least) by = 0.01;
    time.pan(by);
    await frame();
    ++frames;
  }
  return (1000 * frames) / (performance.now() - begun);
}

await opened(executable, async (_, tab) => {
  await tab.goto(pathToFileURL(page).href);
  await tab.waitForSelector('html[data-ready]');
  const rate = await tab.evaluate(pan, 3000);
  const points = await tab.evaluate(() => window.mixloop.plots.filter(({ visible }) => visible).map(({ plot }) => plot.data[0].length));
  console.log(`${rate.toFixed(1)} frames a second, ${points.length} plots on the screen, of up to ${Math.max(...points)} points`);
  assert.ok(points.length >= 2, 'plots are on the screen');
  assert.ok(Math.max(...points) <= most, `${points} points are drawn at once`);
  assert.ok(rate > 0);
});
