import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

const places = { space: [0.5, 0.85, 0.4], front: [0, -1, 0.001], side: [1, 0, 0.001], top: [0, -0.001, 1] };

/** The camera, turned by mouse and by keyboard. */
export class Eye {
  /** @param {THREE.Sphere} all what is to be seen @param {THREE.Vector3} up where things don't fall */
  constructor(canvas, all, up, onChange) {
    Object.assign(this, { all, onChange, chosen: false });
    this.upright = new THREE.Quaternion().setFromUnitVectors(new THREE.Vector3(0, 0, 1), up);
    this.camera = new THREE.PerspectiveCamera(40, 1, 0.01 * all.radius, 100 * all.radius);
    this.camera.up.copy(up);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener('change', onChange);
    this.controls.addEventListener('start', () => (this.chosen = true));
    canvas.addEventListener('keydown', (event) => this.key(event));
  }

  /** From 'space', 'front', 'side' or 'top'. */
  look(from) {
    const far = (3 * this.all.radius) / Math.min(1, this.camera.aspect);
    this.controls.target.copy(this.all.center);
    this.camera.position.set(...places[from]).applyQuaternion(this.upright).normalize().multiplyScalar(far).add(this.controls.target);
    this.chosen = false;
    this.controls.update();
    this.onChange();
  }

  turn(azimuth, polar) {
    const turned = this.upright.clone().invert();
    const offset = this.camera.position.clone().sub(this.controls.target).applyQuaternion(turned);
    const at = new THREE.Spherical().setFromVector3(new THREE.Vector3(offset.x, offset.z, -offset.y)); // its y is up
    at.theta += azimuth;
    at.phi = Math.min(Math.max(at.phi + polar, 0.01), Math.PI - 0.01);
    const { x, y, z } = new THREE.Vector3().setFromSpherical(at);
    this.camera.position.set(x, -z, y).applyQuaternion(this.upright).add(this.controls.target);
    this.chosen = true;
  }

  /**
   * Follows what leaves the picture: any of these places, or once a person has chosen what to look at, all of them.
   * Whether it moved.
   */
  keep(places) {
    this.camera.updateMatrixWorld();
    const isOut = (place) => {
      const { x, y, z } = place.clone().project(this.camera);
      return Math.abs(x) > 1 || Math.abs(y) > 1 || z > 1;
    };
    if (!(this.chosen ? places.every(isOut) : places.some(isOut))) return false;
    const { center, radius } = new THREE.Box3().setFromPoints(places).getBoundingSphere(new THREE.Sphere());
    this.all.center.copy(center);
    this.all.radius = Math.max(this.all.radius, radius);
    const offset = this.camera.position.clone().sub(this.controls.target);
    const far = (3 * this.all.radius) / Math.min(1, this.camera.aspect);
    if (!this.chosen && offset.length() < far) offset.setLength(far);
    this.controls.target.copy(center);
    this.camera.position.copy(center).add(offset);
    this.camera.far = Math.max(this.camera.far, 10 * offset.length());
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.onChange();
    return true;
  }

  zoom(by) {
    this.chosen = true;
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
