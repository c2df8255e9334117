// Looks at the live view in a browser: node view.mjs CHROMIUM MIXLOOP EXPERIMENT FOLDER. The plant runs twice, a
// browser that never reads stands by, the viewer is started again, and at last shows the kept run. Prints what it
// measured, or throws.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import http from 'node:http';
import net from 'node:net';
import { opened, webgl } from './browser.mjs';
import { contrast } from './contrast.mjs';
import { endAll, ended, started, viewing as viewer } from './viewer.mjs';

const [executable, mixloop, experiment, folder] = process.argv.slice(2);
const sets = ['--set', 'path.duration=2 s', '--set', 'expect={}'];
const viewing = (what, port) => viewer(mixloop, what, '--port', String(port), ...(what === experiment ? sets : []));
const run = (out, ...more) => started(mixloop, 'run', experiment, ...sets, ...more, '--speed', '0.5', '--json', '--out', out);

/** SHA-256 of the trajectory that a folder keeps. */
const sha = (out) => JSON.parse(readFileSync(`${out}/result.json`, 'utf8')).trajectory_sha256;

/** The status of a request with these headers. */
function status(url, headers, method = 'GET') {
  return new Promise((resolve, reject) => {
    const request = http.request(url, { headers, method }, (response) => resolve(response.resume().statusCode));
    request.on('upgrade', (response, socket) => {
      socket.destroy();
      resolve(response.statusCode);
    });
    request.on('error', reject);
    request.end();
  });
}

const upgrade = (origin) => ({
  Connection: 'Upgrade',
  Upgrade: 'websocket',
  'Sec-WebSocket-Version': '13',
  'Sec-WebSocket-Key': 'dGhlIHNhbXBsZSBub25jZQ==',
  ...(origin ? { Origin: origin } : {}),
});

async function refusesStrangers(url) {
  const { host, origin } = new URL(url);
  assert.equal(await status(url, { Host: host }), 200);
  assert.equal(await status(url, { Host: 'evil.example' }), 421, 'a name bent to 127.0.0.1');
  assert.equal(await status(url, { Host: host }, 'POST'), 405);
  assert.equal(await status(`${url}live`, { Host: host, ...upgrade(origin) }), 101);
  assert.equal(await status(`${url}live`, { Host: host, ...upgrade('http://evil.example') }), 403);
  assert.equal(await status(`${url}live`, { Host: host, ...upgrade() }), 403);
  assert.equal(await status(`${url}../etc/passwd`, { Host: host }), 404);
  // What is no tick, and what is too long, does no harm to the others.
  const noise = net.connect(Number(new URL(url).port), '127.0.0.1');
  noise.write('GET /live HTTP/1.1\r\n\r\n\0\0\0');
  noise.on('error', () => {});
}

/** A browser that takes the WebSocket and never reads from it. */
function slow(url) {
  const { host, port, origin } = new URL(url);
  const socket = net.connect(Number(port), '127.0.0.1');
  socket.pause();
  const headers = Object.entries({ Host: host, ...upgrade(origin) }).map(([name, value]) => `${name}: ${value}\r\n`);
  socket.write(`GET /live HTTP/1.1\r\n${headers.join('')}\r\n`);
  socket.on('error', () => {});
  return socket;
}

const pose = (tab) => tab.evaluate(() => window.mixloop.pose);
const picture = (tab) => tab.evaluate(() => document.getElementById('canvas').toDataURL());

/** Waits until the canvas shows something else: without a graphics card it may take a while. */
const changed = (tab, before) =>
  tab.waitForFunction((old) => document.getElementById('canvas').toDataURL() !== old, before);

/** Waits for a pose past tick k of another session than `old`. */
async function past(tab, k, old) {
  await tab.waitForFunction(
    ([least, before]) => window.mixloop?.pose && window.mixloop.pose.session !== before && window.mixloop.pose.k > least,
    [k, old],
  );
}

/** Waits until the newest pose is what is drawn: a browser's frame later than it came. */
const settled = (tab) => tab.waitForFunction(() => window.mixloop.drawing.shown === window.mixloop.pose);

/** Holds poses against the plant's own memory. */
function agree(poses, out) {
  const [header, ...lines] = readFileSync(`${out}/trajectory.csv`, 'utf8').trim().split('\n');
  const names = header.split(',');
  for (const { k, psi, tau, E } of poses) {
    const row = lines[k].split(',').map(Number);
    const of = (...wanted) => wanted.map((name) => row[names.indexOf(name)]);
    assert.deepEqual(psi, of('psi_1', 'psi_2', 'psi_3'), `psi of tick ${k}`);
    if (tau[0] !== null) assert.deepEqual(tau, of('tau_1', 'tau_2', 'tau_3'), `tau of tick ${k}`);
    const place = of('position_x_actual', 'position_y_actual', 'position_z_actual');
    E.forEach((x, i) => assert.ok(Math.abs(x - place[i]) < 1e-13, `E of tick ${k}`)); // two programs' round-off
  }
}

async function live(tab, complaints) {
  let view = await viewing(experiment, 0);
  await refusesStrangers(view.url);
  await tab.goto(view.url);
  await tab.waitForSelector('#status[data-state=waiting]');

  // All that the page is sent, however seldom it draws.
  await tab.evaluate(() => {
    const page = window.mixloop;
    const take = page.take.bind(page);
    page.kept = [];
    page.take = (pose) => {
      page.kept.push(pose);
      take(pose);
    };
  });
  const counts = () => tab.evaluate(() => [performance.now(), window.mixloop.drawn, window.mixloop.poses]);
  const before = await picture(tab);
  const first = run(`${folder}/first`);
  await past(tab, 50);
  const begun = await counts();
  // Whatever a page says, the plant hears nothing of it.
  await tab.evaluate(() => {
    for (const said of ['7', '-1', '9223372036854775808', 'stop', '{"tau":[9,9,9]}', '']) window.mixloop.connection.socket.send(said);
  });
  await changed(tab, before);
  assert.equal(await first.over, 0);
  const [ms, drawn, received] = (await counts()).map((x, i) => x - begun[i]);
  const rates = { frames_per_second: (1000 * drawn) / ms, poses_per_second: (1000 * received) / ms };
  const kept = await tab.evaluate(() => window.mixloop.kept.map(({ traces, ...pose }) => pose));
  assert.ok(new Set(kept.map(({ k }) => k)).size > 10, 'poses follow each other');
  agree(kept, `${folder}/first`);
  assert.equal(await started(mixloop, 'simulate', experiment, ...sets, '--json', '--out', `${folder}/alone`).over, 0);
  assert.equal(sha(`${folder}/first`), sha(`${folder}/alone`), 'the run is the same as without a viewer');
  assert.equal(await tab.textContent('#notes'), '');
  await settled(tab);
  const { travelled, times } = await tab.evaluate(() => {
    const { trail } = window.mixloop.drawing;
    return { travelled: trail.travelled, times: [...trail.times.slice(0, trail.travelled)] };
  });
  assert.ok(travelled > 100, `${travelled} places of the path travelled`); // 0.9 m at 0.5 mm or more, whatever the frame rate
  assert.deepEqual(times, [...times].sort((a, b) => a - b));

  // The plant again, beside a browser that never reads: the page follows the new session.
  const { session } = await pose(tab);
  const sleeper = slow(view.url);
  const second = run(`${folder}/second`);
  await past(tab, 50, session);
  const { k } = await pose(tab);
  await past(tab, k + 100, session);
  assert.equal(await second.over, 0);
  assert.equal(await tab.evaluate(() => window.mixloop.sessions.length), 2);
  const last = await pose(tab);
  agree([last], `${folder}/second`);
  sleeper.destroy();

  // The viewer again, on its port: the page comes back by itself. That it was gone is all that may be complained of.
  assert.equal(await ended(view), 0);
  await tab.waitForSelector('#status[data-state=closed]');
  view = await viewing(experiment, new URL(view.url).port);
  const third = run(`${folder}/third`, '--set', 'path.duration=1.5 s');
  await past(tab, 50, last.session);
  await tab.waitForFunction(() => document.getElementById('notes').textContent.includes('another experiment: its path'));
  assert.equal(await third.over, 0);
  assert.equal(await ended(view), 0);
  const others = complaints.splice(0).filter((text) => !/WebSocket connection to .* failed/.test(text));
  assert.deepEqual(others, [], 'the console is silent');
  return rates;
}

/** Light and dark: words and what is drawn stand out. */
async function standsOut(tab) {
  const words = ['--ink', '--quiet', '--accent', '--held', '--missed'];
  const shapes = ['--link', '--joint', '--desired', '--travelled', '--closure', '--forward', '--backward'];
  for (const colorScheme of ['light', 'dark']) {
    await tab.emulateMedia({ colorScheme });
    const of = (names) => tab.evaluate((list) => list.map((name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim()), names);
    const [paper] = await of(['--paper']);
    for (const [names, least] of [[words, 4.5], [shapes, 3]])
      (await of(names)).forEach((colour, i) =>
        assert.ok(contrast(colour, paper) >= least, `${colorScheme}: ${names[i]} ${colour} on ${paper} has ${contrast(colour, paper).toFixed(2)}`));
  }
}

/** The first solid of the paper's link 2 goes from the shoulder (frame 1) to the elbow (frame 2). */
async function solidsMove(tab) {
  const { middle, bars, frames } = await tab.evaluate(() => {
    const { drawing } = window.mixloop;
    const solid = drawing.solids[2].children[0];
    solid.updateWorldMatrix(true, false);
    return { middle: solid.matrixWorld.elements.slice(12, 15), bars: drawing.links[2], frames: drawing.shown.frames };
  });
  assert.equal(bars, null, 'a solid is drawn in place of the skeleton');
  middle.forEach((x, i) => assert.ok(Math.abs(x - (frames[7 + i] + frames[14 + i]) / 2) < 1e-12, `${x} of axis ${i}`));
}

async function log(tab) {
  const view = await viewing(`${folder}/first`, 0);
  await tab.goto(view.url);
  await past(tab, -1);
  await tab.focus('#canvas');
  await tab.keyboard.press(' ');
  assert.equal(await tab.textContent('#pause'), 'Play');
  await tab.evaluate(() => {
    const scrub = document.getElementById('scrub');
    scrub.value = 1500;
    scrub.dispatchEvent(new Event('input'));
  });
  await tab.waitForFunction(() => window.mixloop.pose.k === 1500);
  await tab.focus('#scrub');
  await tab.keyboard.press('ArrowRight');
  await tab.waitForFunction(() => window.mixloop.pose.k === 1501);
  agree([await pose(tab)], `${folder}/first`);
  await settled(tab);
  await solidsMove(tab);
  assert.equal(await tab.evaluate(() => window.mixloop.plots.errors.data[0].length), 2001);
  for (const one of ['errors', 'torques'])
    for (const label of await tab.evaluate((name) => window.mixloop.plots[name].axes.map((axis) => axis.label), one)) assert.match(label, /\(.+\)$/);

  await standsOut(tab);
  await tab.waitForFunction(() => !window.mixloop.drawing.changed);

  // The camera, by keyboard and by button.
  const before = await picture(tab);
  await tab.focus('#canvas');
  await tab.keyboard.press('ArrowLeft');
  await changed(tab, before);
  const turned = await picture(tab);
  await tab.click('[data-camera=top]');
  await changed(tab, turned);
  assert.equal(await ended(view), 0);
}

try {
  await opened(executable, async (_, tab, complaints) => {
    await tab.setViewportSize({ width: 800, height: 600 }); // fewer pixels: no graphics card draws them
    console.log(JSON.stringify(await live(tab, complaints)));
    await log(tab);
    // The viewers are gone by now, and the page tries to find them.
    complaints.splice(0, complaints.length, ...complaints.filter((text) => !/WebSocket|net::ERR_CONNECTION/.test(text)));
  }, webgl);
} finally {
  endAll();
}
console.log('held');
