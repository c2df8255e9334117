import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

const places = { space: [0.5, 0.85, 0.4], front: [0, -1, 0.001], side: [1, 0, 0.001], top: [0, -0.001, 1] };

/** The camera, turned by mouse and by keyboard. */
export class Eye {
  /** @param {THREE.Sphere} all what is to be seen */
  constructor(canvas, all, onChange) {
    Object.assign(this, { all, onChange });
    this.camera = new THREE.PerspectiveCamera(40, 1, 0.01 * all.radius, 100 * all.radius);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener('change', onChange);
    canvas.addEventListener('keydown', (event) => this.key(event));
  }

  /** From 'space', 'front', 'side' or 'top'. */
  look(from) {
    const far = (3 * this.all.radius) / Math.min(1, this.camera.aspect);
    this.controls.target.copy(this.all.center);
    this.camera.position.set(...places[from]).normalize().multiplyScalar(far).add(this.controls.target);
    this.controls.update();
    this.onChange();
  }

  turn(azimuth, polar) {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const at = new THREE.Spherical().setFromVector3(new THREE.Vector3(offset.x, offset.z, -offset.y)); // its y is up
    at.theta += azimuth;
    at.phi = Math.min(Math.max(at.phi + polar, 0.01), Math.PI - 0.01);
    const { x, y, z } = new THREE.Vector3().setFromSpherical(at);
    this.camera.position.set(x, -z, y).add(this.controls.target);
  }

  zoom(by) {
    this.camera.position.sub(this.controls.target).multiplyScalar(by).add(this.controls.target);
  }

  key(event) {
    const act = {
      ArrowLeft: () => this.turn(-0.1, 0),
      ArrowRight: () => this.turn(0.1, 0),
      ArrowUp: () => this.turn(0, -0.1),
      ArrowDown: () => this.turn(0, 0.1),
      '+': () => this.zoom(0.9),
      '=': () => this.zoom(0.9),
      '-': () => this.zoom(1.1),
      1: () => this.look('space'),
      2: () => this.look('front'),
      3: () => this.look('side'),
      4: () => this.look('top'),
    }[event.key];
    if (!act || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    act();
    this.controls.update();
    this.onChange();
  }
}
