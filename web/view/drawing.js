import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { h, shown } from '../shared/dom.js';
import { cssColour, onThemeChange } from '../shared/theme.js';

const kTrail = 8000; // points of the path travelled, the latest
const kTurn = 1.5 * Math.PI; // how far the arc of the largest torque goes

/** The mechanism, drawn: poses come in as the server works them out. */
export class Drawing {
  /** @param {HTMLCanvasElement} canvas @param {object} scene what /scene.json says */
  constructor(canvas, { mechanism, path }) {
    this.canvas = canvas;
    this.mechanism = mechanism;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
    this.space = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(40, 1, 0.01, 100);
    this.camera.up.set(0, 0, 1);
    this.reach = this.reachOf(path);
    this.controls = new OrbitControls(this.camera, canvas);
    this.look('space');
    this.controls.addEventListener('change', () => (this.changed = true));
    this.materials = {};
    this.tags = [];
    this.build(path);
    this.recolour();
    onThemeChange(() => this.recolour());
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    canvas.addEventListener('keydown', (event) => this.key(event));
    this.resize();
  }

  reachOf(path) {
    const places = path.map((p) => Math.hypot(...p));
    return Math.max(0.2, ...places);
  }

  material(name, options = {}) {
    this.materials[name] ??= new THREE.MeshStandardMaterial({ roughness: 0.6, ...options });
    return this.materials[name];
  }

  lineMaterial(name, options = {}) {
    this.materials[name] ??= options.dashSize ? new THREE.LineDashedMaterial(options) : new THREE.LineBasicMaterial(options);
    return this.materials[name];
  }

  build(path) {
    const { space, reach } = this;
    const size = 0.012 * reach;
    space.add(new THREE.HemisphereLight(0xffffff, 0x888888, 2.2));
    const sun = new THREE.DirectionalLight(0xffffff, 1.6);
    sun.position.set(2, -3, 4);
    space.add(sun);
    this.cell = niceStep(reach / 8);
    const cells = 2 * Math.ceil(reach / this.cell);
    this.grid = new THREE.GridHelper(cells * this.cell, cells);
    this.grid.rotation.x = Math.PI / 2;
    space.add(this.grid);

    const bar = new THREE.CylinderGeometry(1, 1, 1, 16).rotateX(Math.PI / 2).translate(0, 0, 0.5);
    const mesh = (geometry, name, options) => {
      const made = new THREE.Mesh(geometry, this.material(name, options));
      space.add(made);
      return made;
    };
    // A link is two bars: along its joint's axis (s), then to its frame (a).
    this.links = this.mechanism.frames.map((frame, i) =>
      i === 0 ? null : { parent: frame.parent, bars: [mesh(bar, 'link'), mesh(bar, 'link')], radius: size },
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
    this.buildAxes();
    this.torques = this.mechanism.motors.map((motor, i) => this.torqueOf(motor, i, bar));
    this.material('backward');

    this.path = new THREE.Line(new THREE.BufferGeometry().setFromPoints(path.map((p) => new THREE.Vector3(...p))), this.lineMaterial('path', { dashSize: 0.02 * reach, gapSize: 0.012 * reach }));
    this.path.computeLineDistances();
    this.trail = new THREE.Line(new THREE.BufferGeometry(), this.lineMaterial('trail'));
    this.trail.geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(3 * kTrail), 3));
    this.trail.frustumCulled = false;
    this.times = new Float64Array(kTrail);
    this.forget();
    space.add(this.path, this.trail);
  }

  /** The axes of frame 0, a few squares of the grid long. */
  buildAxes() {
    const long = 3 * this.cell;
    const ends = [[long, 0, 0], [0, long, 0], [0, 0, long]].map((place) => new THREE.Vector3(...place));
    const corners = ends.flatMap((end) => [new THREE.Vector3(), end]);
    this.space.add(new THREE.LineSegments(new THREE.BufferGeometry().setFromPoints(corners), this.lineMaterial('axes')));
    ends.forEach((end, i) => this.tag('xyz'[i], () => end));
  }

  /** A word beside a place: `at` says where, or null. */
  tag(word, at) {
    const element = h('span', { class: 'tag', 'aria-hidden': 'true' }, word);
    this.canvas.parentElement.append(element);
    this.tags.push({ element, at });
  }

  /** An arc about the joint's axis (an arrow along it, for a slide) with a tip. */
  torqueOf(motor, i, bar) {
    const { reach } = this;
    const group = new THREE.Group();
    const radius = (0.075 + 0.025 * i) * reach; // motors may share an axis
    const material = this.material('forward');
    const shaft = new THREE.Mesh(motor.linear ? bar : new THREE.BufferGeometry(), material);
    const tip = new THREE.Mesh(new THREE.ConeGeometry(0.022 * reach, 0.05 * reach, 20).translate(0, 0.025 * reach, 0), material);
    group.add(shaft, tip);
    group.visible = false;
    this.space.add(group);
    this.tag(motor.name, () => (group.visible ? tip.getWorldPosition(new THREE.Vector3()) : null));
    return { joint: motor.joint, linear: motor.linear, most: 1e-9, value: null, group, shaft, tip, radius };
  }

  /** The path travelled begins again. */
  forget() {
    this.travelled = 0;
    this.until = -Infinity;
    this.trail.geometry.setDrawRange(0, 0);
  }

  recolour() {
    const colours = {
      link: cssColour('--link'),
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

  /** Moves everything to a pose. */
  pose(pose) {
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
    for (const joint of this.joints) {
      if (!joint) continue;
      joint.mesh.position.copy(frames[joint.parent].at);
      joint.mesh.quaternion.copy(frames[joint.parent].turn);
    }
    for (const { frame, at, mesh } of this.masses) mesh.position.copy(at).applyQuaternion(frames[frame].turn).add(frames[frame].at);
    this.mechanism.closures.forEach(({ leaf, on }, i) => {
      const place = frames[leaf].at;
      const base = Math.max(this.mechanism.frames[on].parent, 0);
      stretch(this.closures[i][0], place, frames[on].at, 0.006 * this.reach);
      stretch(this.closures[i][1], place, frames[base].at, 0.006 * this.reach);
    });
    this.hand.position.set(...pose.E);
    this.goal.visible = pose.desired[0] !== null;
    if (this.goal.visible) this.goal.position.set(...pose.desired);
    this.goal.quaternion.copy(this.camera.quaternion);
    this.torques.forEach((torque, i) => this.showTorque(torque, pose.tau[i], frames));
    this.showTrail(pose.t);
    this.changed = true;
  }

  /** The largest torque of each motor, that the arcs are drawn by. */
  scaleTorques(most) {
    this.torques.forEach((torque, i) => (torque.most = Math.max(torque.most, most[i])));
  }

  /** The length of the arc is the torque over the largest seen, its direction the sign. */
  showTorque(torque, value, frames) {
    const { group, shaft, tip, radius } = torque;
    torque.value = value;
    group.visible = torque.joint >= 0 && value !== null && value !== 0;
    if (!group.visible) return;
    torque.most = Math.max(torque.most, Math.abs(value));
    const share = Math.abs(value) / torque.most;
    shaft.material = tip.material = this.materials[value > 0 ? 'forward' : 'backward'];
    if (torque.linear) {
      const length = 0.3 * this.reach * share;
      shaft.scale.set(0.009 * this.reach, 0.009 * this.reach, length);
      tip.position.set(0, 0, length);
      tip.rotation.set(Math.PI / 2, 0, 0);
    } else {
      const angle = Math.max(0.01, kTurn * share);
      shaft.geometry.dispose();
      shaft.geometry = new THREE.TorusGeometry(radius, 0.009 * this.reach, 8, 48, angle);
      tip.position.set(radius * Math.cos(angle), radius * Math.sin(angle), 0);
      tip.rotation.set(0, 0, angle);
    }
    const at = frames[this.mechanism.frames[torque.joint].parent];
    group.position.copy(at.at);
    group.quaternion.copy(at.turn);
    if (value < 0) group.rotateX(Math.PI);
  }

  /** Adds to the path travelled: t, x, y, z a place; what moved less than anyone can see is left out. */
  travel(way) {
    const positions = this.trail.geometry.attributes.position;
    for (let i = 0; i < way.length; i += 4) {
      const [x, y, z] = way.slice(i + 1, i + 4);
      const last = 3 * (this.travelled - 1);
      const moved = last < 0 ? Infinity : Math.hypot(x - positions.array[last], y - positions.array[last + 1], z - positions.array[last + 2]);
      if (moved < 5e-4 * this.reach) continue;
      if (this.travelled === kTrail) this.dropOldest(kTrail / 4);
      this.times[this.travelled] = way[i];
      positions.setXYZ(this.travelled++, x, y, z);
    }
    positions.needsUpdate = true;
    this.showTrail(this.until);
  }

  dropOldest(count) {
    this.trail.geometry.attributes.position.array.copyWithin(0, 3 * count);
    this.times.copyWithin(0, count);
    this.travelled -= count;
  }

  /** Shows the path travelled up to time t. */
  showTrail(t) {
    this.until = t;
    let count = this.travelled;
    while (count > 0 && this.times[count - 1] > t) --count;
    this.trail.geometry.setDrawRange(0, count);
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
    const far = 2.4 * this.reach;
    const places = { space: [0.5, 0.85, 0.4], front: [0, -1, 0.001], side: [1, 0, 0.001], top: [0, -0.001, 1] };
    this.controls.target.set(0, 0, 0.4 * this.reach);
    this.camera.position.set(...places[from]).normalize().multiplyScalar(far).add(this.controls.target);
    this.controls.update();
    this.changed = true;
  }

  key(event) {
    const turn = (azimuth, polar) => () => {
      const offset = this.camera.position.clone().sub(this.controls.target);
      const at = new THREE.Spherical().setFromVector3(new THREE.Vector3(offset.x, offset.z, -offset.y));
      at.theta += azimuth;
      at.phi = Math.min(Math.max(at.phi + polar, 0.01), Math.PI - 0.01);
      const v = new THREE.Vector3().setFromSpherical(at);
      this.camera.position.set(v.x, -v.z, v.y).add(this.controls.target);
    };
    const zoom = (by) => () => this.camera.position.sub(this.controls.target).multiplyScalar(by).add(this.controls.target);
    const act = {
      ArrowLeft: turn(-0.1, 0),
      ArrowRight: turn(0.1, 0),
      ArrowUp: turn(0, -0.1),
      ArrowDown: turn(0, 0.1),
      '+': zoom(0.9),
      '=': zoom(0.9),
      '-': zoom(1.1),
      1: () => this.look('space'),
      2: () => this.look('front'),
      3: () => this.look('side'),
      4: () => this.look('top'),
    }[event.key];
    if (!act || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    act();
    this.controls.update();
    this.changed = true;
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
