// The pictures of shipped mechanisms in docs/figures: node mechanisms.mjs CHROMIUM MIXLOOP FOLDER WORK NAME=SECONDS=CAMERA...
// Each experiment is simulated for so long and drawn by the view where it stands then, seen from space, front, side or top:
// FOLDER/mechanism_NAME.png. WORK keeps the runs.
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import path from 'node:path';
import { opened, webgl } from './browser.mjs';
import { endAll, ended, viewing } from './viewer.mjs';

const [executable, mixloop, folder, work, ...wanted] = process.argv.slice(2);

try {
  for (const [name, seconds, camera] of wanted.map((word) => word.split('='))) {
    const result = path.join(work, name);
    const file = `experiments/${name}.yaml`;
    // One with a path runs to its end, and is shown on its way.
    const shorter = /^duration:/m.test(readFileSync(file, 'utf8')) ? ['--set', `duration=${seconds} s`, '--set', 'expect={}'] : [];
    execFileSync(mixloop, ['simulate', file, '--json', '--out', result, ...shorter]);
    const { child, url } = await viewing(mixloop, result, '--port', '0');
    await opened(executable, async (_, tab, complaints) => {
      await tab.setViewportSize({ width: 1180, height: 600 });
      await tab.emulateMedia({ colorScheme: 'light' });
      await tab.goto(url);
      await tab.waitForFunction(() => window.mixloop?.pose);
      await tab.locator('#scrub').press('End');
      await tab.click(`[data-camera=${camera}]`);
      await tab.waitForTimeout(2000); // a frame or two, without a graphics card
      await tab.locator('#canvas').screenshot({ path: path.join(folder, `mechanism_${name}.png`) });
      complaints.length = 0;
    }, webgl);
    await ended({ child });
  }
} finally {
  endAll();
}
