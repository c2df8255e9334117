import { shown } from '../shared/dom.js';

const kImpatient = 500; // ms after which a question counts as lost

/** The page's clock through a log: asks for the tick that is due, one question at a time. */
export class Player {
  /** @param {{scrubber, slider, speeds, speed}} controls elements @param {(k: number) => void} ask */
  constructor(scene, controls, ask) {
    Object.assign(this, { scene, ask, slider: controls.slider, speed: controls.speed, tick: scene.first_tick, playing: true });
    this.last = scene.first_tick + scene.ticks - 1;
    controls.scrubber.hidden = controls.speeds.hidden = false;
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
    if (this.asked !== undefined && performance.now() - this.asked < kImpatient) return;
    if (k === this.shown) return;
    this.asked = performance.now();
    this.wanted = k;
    this.ask(k);
  }

  /** A pose came: for a tick that the log lost, that of one before it. */
  answered() {
    if (this.asked === undefined) return;
    this.asked = undefined;
    this.shown = this.wanted;
  }

  /** From the beginning, where it stands at the end. */
  play() {
    if (this.tick >= this.last) this.tick = this.scene.first_tick;
    this.playing = true;
  }

  step(now) {
    const passed = Math.min(0.1, (now - (this.before ?? now)) / 1000);
    this.before = now;
    if (this.playing) {
      this.tick += passed * this.scene.rate * Number(this.speed.value);
      if (this.tick >= this.last) {
        this.tick = this.last;
        this.ended?.();
      }
    }
    this.show();
  }
}
