// The pictures in docs/figures: node pictures.mjs CHROMIUM MIXLOOP EXPERIMENT FOLDER WORK. Of the view beside a run and of
// that run's log, of the report, light and dark, and of the report of a sweep; PNGs into FOLDER. WORK keeps the runs.
import { execFileSync } from 'node:child_process';
import path from 'node:path';
import { pathToFileURL } from 'node:url';
import { opened, webgl } from './browser.mjs';
import { endAll, ended, started, viewing } from './viewer.mjs';

const [executable, mixloop, experiment, folder, result] = process.argv.slice(2);
const file = (name) => path.join(folder, name);
const silence = (complaints) => (complaints.length = 0);

async function view(what, colorScheme, wait, name) {
  const { child, url } = await viewing(mixloop, what, '--port', '0');
  await opened(executable, async (_, tab, complaints) => {
    await tab.emulateMedia({ colorScheme });
    await tab.goto(url);
    await wait(tab);
    await tab.waitForTimeout(1000); // a frame or two, without a graphics card
    await tab.screenshot({ path: file(name) });
    silence(complaints);
  }, webgl);
  await ended({ child });
}

try {
  let run;
  await view(experiment, 'light', async (tab) => {
    run = started(mixloop, 'run', experiment, '--speed', '0.1', '--json', '--out', path.join(result, 'run'));
    await tab.waitForFunction(() => window.mixloop?.pose?.t > 0.55, undefined, { timeout: 60_000 });
    await tab.click('#pause');
  }, 'view.png');
  await run.over;
  const over = (tab) => tab.waitForFunction(() => window.mixloop?.pose?.t >= 1);
  await view(path.join(result, 'run'), 'dark', over, 'view_log.png');

  execFileSync(mixloop, ['simulate', experiment, '--json', '--out', path.join(result, 'alone')]);
  execFileSync(mixloop, ['report', path.join(result, 'alone')]);
  await opened(executable, async (_, tab, complaints) => {
    await tab.goto(pathToFileURL(path.resolve(result, 'alone/report.html')).href);
    await tab.waitForSelector('html[data-ready]');
    await tab.setViewportSize({ width: 1180, height: 1480 });
    await tab.screenshot({ path: file('report.png') });
    await tab.emulateMedia({ colorScheme: 'dark' });
    await tab.locator('#error').screenshot({ path: file('report_dark.png') });
    silence(complaints);
  });

  const sweep = path.join(result, 'sweep');
  execFileSync(mixloop, ['sweep', experiment, '--sample', 'parameters.payload=normal(5 kg, 0.5 kg)', '--sample', 'plant.command_delay=uniform(0, 760 us)',
    '--sample', 'controller.kp[0]=uniform(60, 140 N m/rad)', '--set', 'expect={}', '--runs', '20000', '--json', '--out', sweep]);
  execFileSync(mixloop, ['report', sweep]);
  await opened(executable, async (_, tab, complaints) => {
    await tab.setViewportSize({ width: 1180, height: 1330 });
    await tab.goto(pathToFileURL(path.join(sweep, 'report.html')).href);
    await tab.waitForSelector('html[data-ready]');
    await tab.locator('#influence-metric').selectOption({ label: 'max_torque[2]' });
    await tab.locator('#map-colour').selectOption({ label: 'mean of max_torque[2]' });
    await tab.evaluate(() => document.getElementById('influence').scrollIntoView());
    const { width, height } = await tab.locator('.map .u-over').boundingBox();
    await tab.locator('.map .u-over').click({ position: { x: 0.96 * width, y: 0.6 * height } });
    await tab.screenshot({ path: file('sweep_report.png') });
    silence(complaints);
  });
} finally {
  endAll();
}
