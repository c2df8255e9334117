import 'uplot/dist/uPlot.min.css';
import '../shared/page.css';
import './view.css';
import { themeButton } from '../shared/theme.js';
import { Connection } from './connection.js';
import { Drawing } from './drawing.js';
import { LivePlots } from './live-plots.js';
import { Player } from './player.js';
import { condition, numbers } from './words.js';

const kSilent = 1000; // ms without a pose after which the plant counts as silent
const kPlots = 50; // ms between two drawings of the plots
const kNumbers = 200; // ms between two changes of the table: faster can't be read
const at = (id) => document.getElementById(id);

/** The page: takes poses as they come, draws the newest. */
class Page {
  constructor(scene, text) {
    Object.assign(this, { scene, text, pose: null, poses: 0, drawn: 0, sessions: [], paused: false });
    Object.assign(this, { latest: 0, told: 0, plotted: 0, restarted: false });
    this.isLog = scene.mode === 'log';
    document.title = `${scene.label} – mixloop view`;
    at('subtitle').textContent = `${scene.label} · ${scene.mechanism.name}${this.isLog ? ' · a log' : ''}`;
    at('notes').textContent = (scene.notes ?? []).join(' ');
    this.drawing = new Drawing(at('canvas'), scene);
    at('grid-size').textContent = this.drawing.gridSize;
    this.plots = new LivePlots(at('error-plot'), at('torque-plot'), scene.mechanism.motors, this.isLog);
    this.connection = new Connection((pose) => this.take(pose), (state) => this.connected(state));
    if (this.isLog) this.startPlayer();
    else this.say('waiting', 'waiting for the plant');
    this.listen();
  }

  startPlayer() {
    const controls = { scrubber: at('scrubber'), slider: at('scrub'), speeds: at('speeds'), speed: at('speed') };
    this.player = new Player(this.scene, controls, (k) => this.connection.ask(k));
    this.player.ended = () => this.setPaused(true);
    if (matchMedia('(prefers-reduced-motion: reduce)').matches) this.setPaused(true);
  }

  listen() {
    at('pause').addEventListener('click', () => this.setPaused(!this.paused));
    document.addEventListener('keydown', (event) => {
      if (event.key !== ' ' || event.target.closest('button, select, summary')) return;
      event.preventDefault();
      this.setPaused(!this.paused);
    });
    for (const button of document.querySelectorAll('[data-camera]'))
      button.addEventListener('click', () => this.drawing.look(button.dataset.camera));
  }

  setPaused(paused) {
    this.paused = paused;
    if (this.player && !paused) this.player.play();
    if (this.player && paused) this.player.playing = false;
    at('pause').textContent = !paused ? 'Pause' : this.isLog ? 'Play' : 'Go on';
  }

  say(state, words) {
    at('status').dataset.state = state;
    if (at('status').textContent !== words) at('status').textContent = words;
  }

  /** A viewer that comes back may show something else now. */
  async connected(state) {
    if (state === 'closed') return this.say('closed', 'the viewer does not answer: trying again');
    this.restarted = true;
    const text = await (await fetch('/scene.json')).text();
    if (text !== this.text) location.reload();
  }

  take(pose) {
    this.latest = performance.now();
    if (this.restarted || pose.session !== this.sessions.at(-1)) {
      if (pose.session !== this.sessions.at(-1)) this.sessions.push(pose.session);
      this.restarted = false;
      this.forget();
    }
    this.player?.answered();
    if (pose.traces) this.keep(pose);
    if (this.paused && !this.isLog) return;
    this.pose = pose;
    ++this.poses;
    this.fresh = true;
    if (!this.isLog) at('notes').textContent = pose.note;
    this.say(...(this.isLog ? ['live', 'a log'] : condition(pose)));
  }

  forget() {
    this.drawing.trail.forget();
    this.plots.clear();
  }

  keep({ traces, t }) {
    if (this.isLog) this.forget(); // it brings all of it, each time
    this.plots.add(traces, t);
    this.drawing.trail.add(traces.way);
    const largest = (values) => values.reduce((most, value) => Math.max(most, Math.abs(value ?? 0)), 0);
    this.drawing.scaleTorques(traces.tau.map(largest));
  }

  /** A frame of the browser's. */
  frame(now) {
    this.player?.step(now);
    if (this.fresh) {
      this.fresh = false;
      this.drawing.pose(this.pose);
      this.unplotted = true;
    }
    if (this.unplotted && now - this.plotted >= kPlots) {
      this.unplotted = false;
      this.plotted = now;
      this.plots.draw(this.pose.t);
    }
    if (this.pose && now - this.told >= kNumbers) this.tell(now);
    if (this.drawing.draw()) ++this.drawn;
  }

  tell(now) {
    this.told = now;
    at('numbers').tBodies[0].replaceChildren(...numbers(this.pose, this.scene));
    const isSilent = performance.now() - this.latest > kSilent;
    if (!this.isLog && !this.paused && at('status').dataset.state !== 'closed' && isSilent)
      this.say('waiting', `no STATE since tick ${this.pose.k}: waiting for the plant`);
  }
}

themeButton(at('theme'));
const text = await (await fetch('/scene.json')).text();
const page = new Page(JSON.parse(text), text);
window.mixloop = page; // for the tests, and for the curious
const loop = (now) => {
  page.frame(now);
  requestAnimationFrame(loop);
};
requestAnimationFrame(loop);
document.documentElement.dataset.ready = 'yes';
