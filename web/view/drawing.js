import * as THREE from 'three';
import { LineMaterial } from 'three/addons/lines/LineMaterial.js';
import { LineSegments2 } from 'three/addons/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/addons/lines/LineSegmentsGeometry.js';
import { h, shown } from '../shared/dom.js';
import { cssColour, onThemeChange } from '../shared/theme.js';
import { Eye } from './eye.js';
import { solidsOf } from './solids.js';
import { Torque } from './torque.js';
import { Trail } from './trail.js';

const kWide = 2.5; // px of a path's line

/** The mechanism, drawn: poses come in as the server works them out. */
export class Drawing {
  /** @param {HTMLCanvasElement} canvas @param {object} scene what /scene.json says */
  constructor(canvas, { mechanism, path }) {
    this.canvas = canvas;
    this.mechanism = mechanism;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
    this.space = new THREE.Scene();
    const places = [...mechanism.frames.map(({ home }) => home), ...mechanism.extent, ...path].map((place) => new THREE.Vector3(...place));
    this.box = new THREE.Box3().setFromPoints(places);
    const sphere = this.box.getBoundingSphere(new THREE.Sphere());
    sphere.radius = Math.max(sphere.radius, 1e-3);
    this.reach = 1.4 * sphere.radius;
    const [x, y, z] = mechanism.gravity ?? [0, 0, 0];
    this.up = x || y || z ? new THREE.Vector3(-x, -y, -z).normalize() : new THREE.Vector3(0, 0, 1);
    this.eye = new Eye(canvas, sphere, this.up, () => (this.changed = true));
    this.camera = this.eye.camera;
    this.materials = {};
    this.tags = [];
    this.bar = new THREE.CylinderGeometry(1, 1, 1, 16).rotateX(Math.PI / 2).translate(0, 0, 0.5); // of length 1 along z
    this.buildGround();
    this.buildMechanism();
    this.buildTorques();
    this.buildPaths(path);
    this.recolour();
    onThemeChange(() => this.recolour());
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    this.resize();
    this.look('space');
  }

  material(name, options = {}) {
    this.materials[name] ??= new THREE.MeshStandardMaterial({ roughness: 0.6, ...options });
    return this.materials[name];
  }

  /** A line of some pixels' width: x, y, z of both ends of each piece. */
  line(name, ends, options = {}) {
    this.materials[name] = new LineMaterial({ linewidth: kWide, ...options });
    const made = new LineSegments2(new LineSegmentsGeometry().setPositions(ends), this.materials[name]);
    made.frustumCulled = false; // it changes, its bounds don't
    this.space.add(made);
    return made;
  }

  mesh(geometry, name, options) {
    const made = new THREE.Mesh(geometry, this.material(name, options));
    this.space.add(made);
    return made;
  }

  buildGround() {
    const { space, reach } = this;
    space.add(new THREE.HemisphereLight(0xffffff, 0x888888, 2.2));
    const sun = new THREE.DirectionalLight(0xffffff, 1.6);
    sun.position.set(2, -3, 4).applyQuaternion(this.eye.upright);
    space.add(sun);
    this.cell = niceStep(reach / 6);
    const { min, max } = this.box;
    const far = Math.max(...[min, max].flatMap((corner) => corner.toArray()).map(Math.abs)) + 0.5 * reach;
    const cells = 2 * Math.ceil(far / this.cell);
    this.grid = new THREE.GridHelper(cells * this.cell, cells);
    this.grid.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), this.up);
    space.add(this.grid);
    this.buildAxes();
  }

  /** The frame itself, or the next below it with a name: those amid a pose have none and are not drawn. */
  named(frame) {
    while (frame > 0 && !this.mechanism.frames[frame].name) frame = this.mechanism.frames[frame].parent;
    return frame;
  }

  buildMechanism() {
    const { reach, bar } = this;
    const size = 0.012 * reach;
    const mesh = (...words) => this.mesh(...words);
    this.solids = solidsOf(this.mechanism, this.material('solid'));
    for (const group of this.solids) if (group) this.space.add(group);
    // A link without a solid is two bars: along its joint's axis (s), then to its frame (a).
    this.links = this.mechanism.frames.map((frame, i) =>
      i === 0 || !frame.name || this.solids[i] ? null : { parent: this.named(frame.parent), bars: [mesh(bar, 'link'), mesh(bar, 'link')], radius: size },
    );
    const joint = new THREE.CylinderGeometry(1.9 * size, 1.9 * size, 4.5 * size, 24).rotateX(Math.PI / 2);
    const slide = new THREE.BoxGeometry(3.5 * size, 3.5 * size, 5 * size);
    this.joints = this.mechanism.frames.map((frame, i) =>
      i === 0 || !frame.coordinate ? null : { parent: frame.parent, mesh: mesh(frame.prismatic ? slide : joint, 'joint') },
    );
    const ball = new THREE.SphereGeometry(1, 24, 16);
    this.masses = this.mechanism.bodies.map((body) => {
      const made = mesh(ball, 'mass', { transparent: true, opacity: 0.35 });
      made.scale.setScalar(Math.max(1e-4, 0.03 * reach * Math.cbrt(body.mass)));
      return { frame: body.frame, at: new THREE.Vector3(...body.center_of_mass), mesh: made };
    });
    this.hand = mesh(ball, 'hand');
    this.hand.scale.setScalar(1.7 * size);
    this.goal = mesh(new THREE.TorusGeometry(2.6 * size, 0.35 * size, 8, 32), 'desired');
    this.closures = this.mechanism.closures.map(() => [mesh(bar, 'closure'), mesh(bar, 'closure')]);
  }

  buildTorques() {
    const signs = { forward: this.material('forward'), backward: this.material('backward') };
    this.torques = this.mechanism.motors.map((motor, i) => {
      const torque = new Torque(motor, i, this.reach, this.bar, signs);
      this.space.add(torque.group);
      this.tag(motor.name, () => (torque.group.visible ? torque.middle.getWorldPosition(new THREE.Vector3()) : null));
      return torque;
    });
  }

  buildPaths(path) {
    const { reach } = this;
    const pieces = path.slice(1).flatMap((place, i) => [...path[i], ...place]);
    if (pieces.length > 0)
      this.line('path', pieces, { dashed: true, dashSize: 0.02 * reach, gapSize: 0.012 * reach }).computeLineDistances();
    this.trail = new Trail((ends) => this.line('trail', ends).geometry, 1e-3 * reach);
  }

  /** The axes of frame 0, a few squares of the grid long. */
  buildAxes() {
    const long = 4 * this.cell;
    this.materials.axes = new THREE.LineBasicMaterial();
    const ends = [[long, 0, 0], [0, long, 0], [0, 0, long]].map((place) => new THREE.Vector3(...place));
    const corners = ends.flatMap((end) => [new THREE.Vector3(), end]);
    const lines = new THREE.LineSegments(new THREE.BufferGeometry().setFromPoints(corners), this.materials.axes);
    lines.position.z = 0.002 * this.reach; // above the grid
    this.space.add(lines);
    ends.forEach((end, i) => this.tag('xyz'[i], () => end));
  }

  /** A word beside a place: `at` says where, or null. */
  tag(word, at) {
    const element = h('span', { class: 'tag', 'aria-hidden': 'true' }, word);
    this.canvas.parentElement.append(element);
    this.tags.push({ element, at });
  }

  recolour() {
    const colours = {
      link: cssColour('--link'),
      solid: cssColour('--link'),
      joint: cssColour('--joint'),
      mass: cssColour('--mass'),
      hand: cssColour('--travelled'),
      trail: cssColour('--travelled'),
      desired: cssColour('--desired'),
      path: cssColour('--desired'),
      closure: cssColour('--closure'),
      axes: cssColour('--quiet'),
      forward: cssColour('--forward'),
      backward: cssColour('--backward'),
    };
    for (const [name, material] of Object.entries(this.materials)) material.color.set(colours[name]);
    this.space.background = new THREE.Color(cssColour('--paper'));
    this.grid.material.color.set(cssColour('--grid'));
    this.grid.material.vertexColors = false;
    this.grid.material.needsUpdate = true;
    this.changed = true;
  }

  /** Moves everything to a pose: the one `shown` from then on. */
  pose(pose) {
    this.shown = pose;
    const frames = this.mechanism.frames.map((_, i) => {
      const [x, y, z, qx, qy, qz, qw] = pose.frames.slice(7 * i, 7 * i + 7);
      return { at: new THREE.Vector3(x, y, z), turn: new THREE.Quaternion(qx, qy, qz, qw) };
    });
    const axis = (i) => new THREE.Vector3(0, 0, 1).applyQuaternion(frames[i].turn);
    this.links.forEach((link, i) => {
      if (!link) return;
      const from = frames[link.parent].at;
      const to = frames[i].at;
      const along = axis(link.parent);
      const elbow = from.clone().addScaledVector(along, to.clone().sub(from).dot(along));
      stretch(link.bars[0], from, elbow, link.radius);
      stretch(link.bars[1], elbow, to, link.radius);
    });
    this.solids.forEach((group, i) => {
      group?.position.copy(frames[i].at);
      group?.quaternion.copy(frames[i].turn);
    });
    for (const joint of this.joints) {
      if (!joint) continue;
      joint.mesh.position.copy(frames[joint.parent].at);
      joint.mesh.quaternion.copy(frames[joint.parent].turn);
    }
    for (const { frame, at, mesh } of this.masses) mesh.position.copy(at).applyQuaternion(frames[frame].turn).add(frames[frame].at);
    this.mechanism.closures.forEach(({ leaf, on }, i) => {
      const place = frames[leaf].at;
      const base = this.named(Math.max(this.mechanism.frames[on].parent, 0));
      stretch(this.closures[i][0], place, frames[on].at, 0.006 * this.reach);
      stretch(this.closures[i][1], place, frames[base].at, 0.006 * this.reach);
    });
    this.hand.visible = pose.E[0] !== null;
    if (this.hand.visible) this.hand.position.set(...pose.E);
    this.goal.visible = pose.desired[0] !== null;
    if (this.goal.visible) this.goal.position.set(...pose.desired);
    this.goal.quaternion.copy(this.camera.quaternion);
    this.torques.forEach((torque, i) => {
      const { parent } = this.mechanism.frames[Math.max(0, torque.joint)];
      torque.show(pose.tau[i], frames[Math.max(0, parent)]);
    });
    if (this.eye.keep([...frames.map(({ at }) => at), this.hand.position])) this.moveGrid();
    this.trail.show(pose.t);
    this.changed = true;
  }

  /** Under what is looked at, by whole squares. */
  moveGrid() {
    const at = this.eye.all.center.clone().applyQuaternion(this.grid.quaternion.clone().invert());
    const whole = (x) => Math.round(x / this.cell) * this.cell;
    this.grid.position.set(whole(at.x), 0, whole(at.z)).applyQuaternion(this.grid.quaternion);
  }

  /** The largest torque of each motor, that the arcs are drawn by. */
  scaleTorques(most) {
    this.torques.forEach((torque, i) => torque.scaleTo(most[i]));
  }

  resize() {
    const { clientWidth, clientHeight } = this.canvas.parentElement;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / Math.max(1, clientHeight);
    this.camera.updateProjectionMatrix();
    this.changed = true;
  }

  /** 'space', 'front', 'side' or 'top'. */
  look(from) {
    this.eye.look(from);
  }

  /** Draws, where anything changed; whether it did. */
  draw() {
    if (!this.changed) return false;
    this.changed = false;
    this.renderer.render(this.space, this.camera);
    this.placeTags();
    return true;
  }

  placeTags() {
    const { clientWidth, clientHeight } = this.canvas;
    for (const { element, at } of this.tags) {
      const place = at()?.clone().project(this.camera);
      element.hidden = !place || place.z > 1;
      if (!element.hidden)
        element.style.transform = `translate(${(((place.x + 1) / 2) * clientWidth).toFixed(1)}px, ${(((1 - place.y) / 2) * clientHeight).toFixed(1)}px)`;
    }
  }

  /** What a square of the grid is, in words. */
  get gridSize() {
    return `${shown(this.cell)} m`;
  }
}

/** The largest of 1, 2, 5, 10, ... that is not above x. */
function niceStep(x) {
  const power = 10 ** Math.floor(Math.log10(x));
  return power * [5, 2, 1].find((step) => step * power <= x);
}

/** Lays a bar (of length 1 along z) from one place to another; one without length is not drawn. */
function stretch(bar, from, to, radius) {
  const way = to.clone().sub(from);
  const length = way.length();
  bar.visible = length > 1e-6;
  if (!bar.visible) return;
  bar.position.copy(from);
  bar.scale.set(radius, radius, length);
  bar.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), way.divideScalar(length));
}
