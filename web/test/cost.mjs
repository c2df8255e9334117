// What looking costs: node cost.mjs CHROMIUM MIXLOOP EXPERIMENT ROUNDS SECONDS. In each round the plant runs in real
// time without a viewer, with `mixloop view` that nobody looks at, and with a browser that does, the order turned from
// round to round. Prints a table of the plant's own timing, and the frame rate.
import { execFileSync } from 'node:child_process';
import os from 'node:os';
import { opened, webgl } from './browser.mjs';
import { endAll, ended, started, viewing } from './viewer.mjs';

const [executable, mixloop, experiment, rounds, seconds] = process.argv.slice(2);
// There and back is two seconds.
const sets = ['--set', `path.repeat=${Math.max(1, Math.round(seconds / 2))}`, '--set', 'expect={}'];
const us = (x) => 1e6 * x;
const measures = {
  'wake-up p50, us': (r) => us(r.wake_up_p50),
  'wake-up p99, us': (r) => us(r.wake_up_p99),
  'round trip p50, us': (r) => us(r.round_trip_p50),
  'round trip p99, us': (r) => us(r.round_trip_p99),
  'missed, of 1000 ticks': (r) => (1000 * r.missed_deadlines) / r.ticks,
};

async function run() {
  const child = started(mixloop, 'run', experiment, ...sets, '--realtime', '--json');
  await child.over;
  const result = JSON.parse(child.text);
  if (result.error) throw new Error(result.error.message);
  return result;
}

async function unseen() {
  const view = await viewing(mixloop, experiment, ...sets, '--port', '0');
  const result = await run();
  await ended(view);
  return result;
}

async function seen(rates) {
  const view = await viewing(mixloop, experiment, ...sets, '--port', '0');
  let result;
  await opened(executable, async (_, tab, complaints) => {
    await tab.goto(view.url);
    await tab.waitForSelector('html[data-ready]');
    const going = run();
    await tab.waitForFunction(() => window.mixloop.pose?.k > 500);
    const now = () => tab.evaluate(() => [performance.now(), window.mixloop.drawn, window.mixloop.poses, window.mixloop.pose.t]);
    const before = await now();
    await tab.waitForFunction((t) => window.mixloop.pose.t > t, before[3] + 0.6 * seconds);
    const after = await now();
    const [ms, drawn, poses] = after.map((x, i) => x - before[i]);
    rates.push([(1000 * drawn) / ms, (1000 * poses) / ms]);
    result = await going;
    complaints.length = 0;
  }, webgl);
  await ended(view);
  return result;
}

const median = (list) => [...list].sort((a, b) => a - b)[Math.floor(list.length / 2)];
const range = (list) => `${median(list).toFixed(1)} (${Math.min(...list).toFixed(1)} to ${Math.max(...list).toFixed(1)})`;

try {
  const rates = [];
  const ways = { 'no viewer': run, 'viewer, no page': unseen, 'viewer and page': () => seen(rates) };
  const names = Object.keys(ways);
  const results = Object.fromEntries(names.map((name) => [name, []]));
  for (let round = 0; round < rounds; ++round)
    for (let i = 0; i < names.length; ++i) {
      const name = names[(round + i) % names.length];
      results[name].push(await ways[name]());
    }
  console.log(`${os.cpus().length} x ${os.cpus()[0].model}; ${execFileSync(executable, ['--version', '--no-sandbox']).toString().trim()}, no graphics card`);
  console.log(`medians of ${rounds} interleaved rounds of ${seconds} s (least to most)\n`);
  console.log(`| | ${names.join(' | ')} |\n|---|${names.map(() => '---|').join('')}`);
  for (const [what, of] of Object.entries(measures))
    console.log(`| ${what} | ${names.map((name) => range(results[name].map(of))).join(' | ')} |`);
  console.log(`\nframes a second ${range(rates.map(([frames]) => frames))}, poses received ${range(rates.map(([, poses]) => poses))}`);
} finally {
  endAll();
}
