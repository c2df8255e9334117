import 'uplot/dist/uPlot.min.css';
import '../shared/page.css';
import './view.css';
import { h, shown } from '../shared/dom.js';
import { themeButton } from '../shared/theme.js';
import { Connection } from './connection.js';
import { Drawing } from './drawing.js';
import { LivePlots } from './live-plots.js';

const kSilent = 1000; // ms without a pose after which the plant counts as silent
const at = (id) => document.getElementById(id);

/** The page's clock through a log: asks for the tick that is due, one question at a time. */
class Player {
  constructor(scene, ask) {
    Object.assign(this, { scene, ask, tick: scene.first_tick, playing: true });
    this.last = scene.first_tick + scene.ticks - 1;
    at('scrubber').hidden = at('speeds').hidden = false;
    this.slider = at('scrub');
    this.slider.min = scene.first_tick;
    this.slider.max = this.last;
    this.slider.addEventListener('input', () => {
      this.tick = Number(this.slider.value);
      this.show();
    });
  }

  show() {
    const k = Math.round(this.tick);
    this.slider.value = k;
    this.slider.setAttribute('aria-valuetext', `${shown(k / this.scene.rate)} s`);
    if (this.waiting && performance.now() - this.asked < 500) return;
    if (k === this.shown) return;
    this.waiting = true;
    this.asked = performance.now();
    this.ask(k);
  }

  /** A pose came. */
  answered(k) {
    this.waiting = false;
    this.shown = k;
  }

  step(now) {
    const passed = Math.min(0.1, (now - (this.before ?? now)) / 1000);
    this.before = now;
    if (this.playing) {
      this.tick += passed * this.scene.rate * Number(at('speed').value);
      if (this.tick >= this.last) {
        this.tick = this.last;
        this.ended?.();
      }
    }
    this.show();
  }
}

function numbers(pose, { mechanism }) {
  const rows = [
    ['Time', `${shown(pose.t)} s`],
    ['Tick', String(pose.k)],
    ['Position error', pose.error[0] === null ? '–' : `${shown(pose.error[0] * 1e3, 5)} mm`],
    ['E actual', `${pose.E.map((x) => x.toFixed(4)).join(', ')} m`],
    ['E desired', pose.desired[0] === null ? '–' : `${pose.desired.map((x) => x.toFixed(4)).join(', ')} m`],
    ...mechanism.motors.map(({ name, linear }, i) => [
      `τ of ${name}`,
      pose.tau[i] === null ? '–' : `${pose.tau[i].toFixed(4)} ${linear ? 'N' : 'N m'}`,
    ]),
  ];
  at('numbers').tBodies[0].replaceChildren(
    ...rows.map(([name, value]) => h('tr', {}, h('th', { scope: 'row' }, name), h('td', {}, value))),
  );
}

function start(scene) {
  const isLog = scene.mode === 'log';
  document.title = `${scene.label} – mixloop view`;
  at('subtitle').textContent = `${scene.label} · ${scene.mechanism.name}${isLog ? ' · a log' : ''}`;
  at('notes').textContent = (scene.notes ?? []).join(' ');
  const drawing = new Drawing(at('canvas'), scene);
  const plots = new LivePlots(at('error-plot'), at('torque-plot'), scene.mechanism.motors, isLog);
  const page = { drawing, plots, scene, pose: null, poses: 0, drawn: 0, sessions: [], paused: false };
  window.mixloop = page; // for the tests, and for the curious

  const say = (state, words) => {
    if (at('status').dataset.state === state) return;
    at('status').dataset.state = state;
    at('status').textContent = words;
  };
  let player;
  let latest = 0;
  const connection = new Connection(
    (pose) => {
      latest = performance.now();
      if (pose.session !== page.sessions.at(-1)) {
        page.sessions.push(pose.session);
        drawing.forget();
        plots.clear();
      }
      player?.answered(pose.k);
      if (page.paused && !isLog) return;
      if (page.pose && pose.k < page.pose.k) drawing.forget();
      page.pose = pose;
      ++page.poses;
      drawing.travel(pose.E);
      page.fresh = true;
      plots.add(pose);
      say('live', isLog ? 'a log' : 'live');
    },
    (state) => state === 'closed' && say('closed', 'the viewer does not answer: trying again'),
  );
  page.connection = connection;
  if (isLog) {
    player = new Player(scene, (k) => connection.ask(k));
    page.player = player;
    player.playing = !matchMedia('(prefers-reduced-motion: reduce)').matches;
  }

  const pause = at('pause');
  const setPaused = (paused) => {
    page.paused = paused;
    if (player) {
      if (!paused && player.tick >= player.last) player.tick = scene.first_tick;
      player.playing = !paused;
    }
    pause.textContent = paused ? (isLog ? 'Play' : 'Go on') : 'Pause';
    pause.setAttribute('aria-pressed', String(paused));
  };
  if (player) player.ended = () => setPaused(true);
  if (player && !player.playing) setPaused(true);
  pause.addEventListener('click', () => setPaused(!page.paused));
  document.addEventListener('keydown', (event) => {
    if (event.key !== ' ' || event.target.closest('button, select, summary, input')) return;
    event.preventDefault();
    setPaused(!page.paused);
  });
  for (const button of document.querySelectorAll('[data-camera]'))
    button.addEventListener('click', () => drawing.look(button.dataset.camera));

  let told = 0;
  const loop = (now) => {
    player?.step(now);
    if (page.fresh) {
      page.fresh = false;
      drawing.pose(page.pose);
      plots.draw();
    }
    if (page.pose && now - told > 200) {
      told = now;
      numbers(page.pose, scene);
      if (!isLog && !page.paused && at('status').dataset.state !== 'closed' && performance.now() - latest > kSilent)
        say('waiting', `no STATE since tick ${page.pose.k}: waiting for the plant`);
    }
    if (drawing.draw()) ++page.drawn;
    requestAnimationFrame(loop);
  };
  if (!isLog) say('waiting', 'waiting for the plant');
  requestAnimationFrame(loop);
  document.documentElement.dataset.ready = 'yes';
}

themeButton(at('theme'));
const answer = await fetch('/scene.json');
start(await answer.json());
