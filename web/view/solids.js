import * as THREE from 'three';

const kAlongY = new THREE.Vector3(0, 1, 0); // the axis of three's own cylinders

/** The shape of a solid that the scene names, as a geometry about its own centre. */
function geometry({ shape, size, radius, from, to }) {
  const length = new THREE.Vector3(...from).distanceTo(new THREE.Vector3(...to));
  if (shape === 'box') return new THREE.BoxGeometry(...size);
  if (shape === 'sphere') return new THREE.SphereGeometry(radius, 32, 20);
  if (shape === 'cylinder') return new THREE.CylinderGeometry(radius, radius, length, 32);
  return new THREE.CapsuleGeometry(radius, length, 8, 24);
}

/** What the scene names in its frames, drawn: one group a frame, or null where it names nothing there. */
export function solidsOf({ frames, solids }, material) {
  const groups = frames.map(() => null);
  for (const solid of solids) {
    const made = new THREE.Mesh(geometry(solid), material);
    const [from, to] = [new THREE.Vector3(...solid.from), new THREE.Vector3(...solid.to)];
    made.position.lerpVectors(from, to, 0.5);
    if (from.distanceTo(to) > 0) made.quaternion.setFromUnitVectors(kAlongY, to.sub(from).normalize());
    groups[solid.frame] ??= new THREE.Group();
    groups[solid.frame].add(made);
  }
  return groups;
}
