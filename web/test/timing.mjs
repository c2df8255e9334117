// Looks at what a report of a paced run over the bus shows of TIMING: node timing.mjs CHROMIUM REPORT.html.
import assert from 'node:assert/strict';
import { pathToFileURL } from 'node:url';
import { opened } from './browser.mjs';

const [executable, page] = process.argv.slice(2);
await opened(executable, async (_, tab) => {
  await tab.goto(pathToFileURL(page).href);
  await tab.waitForSelector('html[data-ready]');
  const rows = await tab.evaluate(() => window.mixloop.runs[0].log.timing);
  assert.ok(rows.length > 1, `${rows.length} messages of TIMING`);
  for (const [title, columns] of [['Round trip', [3, 2, 1]], ['Wake-up', [6, 5, 4]], ['What came late', [7, 9, 8]]]) {
    const found = await tab.evaluate((words) => {
      const one = window.mixloop.plots.find(({ spec }) => spec.title.startsWith(words));
      return one && { labels: one.plot.axes.map(({ label }) => label), data: one.plot.data };
    }, title);
    assert.ok(found, title);
    for (const label of found.labels) assert.match(label, /\(.+\)$/, `${title}: unit`);
    const scale = title === 'What came late' ? 1 : 1e6;
    columns.forEach((column, i) =>
      assert.deepEqual(found.data[i + 1], rows.map((row) => (scale === 1 || row[column] > 0 ? Math.fround(row[column]) * scale : null)), title));
  }
});
