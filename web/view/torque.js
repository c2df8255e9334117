import * as THREE from 'three';

const kTurn = 1.5 * Math.PI; // how far the arc of the largest torque goes

/** A motor's torque at its joint: an arc about the joint's axis (an arrow along it, for a slide) with a tip. */
export class Torque {
  /** @param {{forward, backward}} signs materials @param {THREE.BufferGeometry} bar of length 1 along z */
  constructor(motor, i, reach, bar, signs) {
    Object.assign(this, { joint: motor.joint, linear: motor.linear, reach, signs, most: 1e-9, value: null });
    this.radius = (0.075 + 0.025 * i) * reach; // motors may share an axis
    this.shaft = new THREE.Mesh(motor.linear ? bar : new THREE.BufferGeometry());
    this.tip = new THREE.Mesh(new THREE.ConeGeometry(0.022 * reach, 0.05 * reach, 20).translate(0, 0.025 * reach, 0));
    this.middle = new THREE.Object3D();
    this.group = new THREE.Group().add(this.shaft, this.tip, this.middle);
    this.group.visible = false;
  }

  /** What counts as the largest, if none was larger. */
  scaleTo(most) {
    this.most = Math.max(this.most, most);
  }

  /** Its length is the torque over the largest seen, its direction and colour the sign. */
  show(value, { at, turn }) {
    this.value = value;
    this.group.visible = this.joint >= 0 && value !== null && value !== 0;
    if (!this.group.visible) return;
    this.scaleTo(Math.abs(value));
    this.shaft.material = this.tip.material = value > 0 ? this.signs.forward : this.signs.backward;
    if (this.linear) this.arrow(Math.abs(value) / this.most);
    else this.arc(Math.abs(value) / this.most);
    this.group.position.copy(at);
    this.group.quaternion.copy(turn);
    if (value < 0) this.group.rotateX(Math.PI);
  }

  arrow(share) {
    const length = 0.3 * this.reach * share;
    this.shaft.scale.set(0.009 * this.reach, 0.009 * this.reach, length);
    this.tip.position.set(0, 0, length);
    this.tip.rotation.set(Math.PI / 2, 0, 0);
    this.middle.position.set(0, 0, length / 2);
  }

  arc(share) {
    const { radius } = this;
    const angle = Math.max(0.01, kTurn * share);
    this.shaft.geometry.dispose();
    this.shaft.geometry = new THREE.TorusGeometry(radius, 0.009 * this.reach, 8, 48, angle);
    this.tip.position.set(radius * Math.cos(angle), radius * Math.sin(angle), 0);
    this.tip.rotation.set(0, 0, angle);
    this.middle.position.set(radius * Math.cos(angle / 2), radius * Math.sin(angle / 2), 0);
  }
}
