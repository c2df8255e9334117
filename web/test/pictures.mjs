// The pictures in docs/figures: node pictures.mjs CHROMIUM MIXLOOP EXPERIMENT FOLDER RESULT. Of the live view beside a
// run, of a log, and of the report; PNGs into FOLDER. RESULT keeps the run.
import { execFileSync } from 'node:child_process';
import path from 'node:path';
import { pathToFileURL } from 'node:url';
import { opened, webgl } from './browser.mjs';
import { endAll, ended, started, viewing } from './viewer.mjs';

const [executable, mixloop, experiment, folder, result] = process.argv.slice(2);
const file = (name) => path.join(folder, name);
const silence = (complaints) => (complaints.length = 0);

async function view(words, wait, name, schemes) {
  const { child, url } = await viewing(mixloop, ...words, '--port', '0');
  await opened(executable, async (_, tab, complaints) => {
    await tab.goto(url);
    await wait(tab);
    for (const [scheme, suffix] of schemes) {
      await tab.emulateMedia({ colorScheme: scheme });
      await tab.waitForTimeout(1000); // a frame or two, without a graphics card
      await tab.screenshot({ path: file(`${name}${suffix}.png`) });
    }
    silence(complaints);
  }, webgl);
  await ended({ child });
}

try {
  // Live, paused at a tick on the way, so that light and dark show the same.
  const both = [['light', ''], ['dark', '_dark']];
  let run;
  await view([experiment], async (tab) => {
    run = started(mixloop, 'run', experiment, '--speed', '0.1', '--json', '--out', result);
    await tab.waitForFunction(() => window.mixloop?.pose?.t > 0.55, undefined, { timeout: 60_000 });
    await tab.click('#pause');
  }, 'view', both);
  await run.over;
  await view([result], (tab) => tab.waitForFunction(() => window.mixloop?.pose?.t >= 1), 'view_log', [['light', '']]);

  execFileSync(mixloop, ['report', result]);
  await opened(executable, async (_, tab, complaints) => {
    await tab.goto(pathToFileURL(path.resolve(result, 'report.html')).href);
    await tab.waitForSelector('html[data-ready]');
    await tab.setViewportSize({ width: 1180, height: 1480 });
    await tab.screenshot({ path: file('report.png') });
    await tab.emulateMedia({ colorScheme: 'dark' });
    await tab.locator('#error').screenshot({ path: file('report_dark.png') });
    silence(complaints);
  });
} finally {
  endAll();
}
