// The axes of limbs in both worlds, at the middle of each bone: as the tracker has them, short and thick, and as the worn sensor has
// them, long and thin with a knob (Baak et al., Figs. 2 and 6).  Red, green, blue: x, y along the bone, z ahead.
import * as THREE from 'three';

import { limbAxesOf } from './limb_axes.js';
import { BONES, Instances, at, seen } from './skeleton_view.js';

const COLOURS = [0xff5d5d, 0x5fe08a, 0x5fa8ff].map((hex) => new THREE.Color(hex));
const DIRECTIONS = [new THREE.Vector3(1, 0, 0), new THREE.Vector3(0, 1, 0), new THREE.Vector3(0, 0, 1)];
const TRACKED = { length: 0.14, radius: 0.01 };
const PREDICTED = { length: 0.2, radius: 0.005, knob: 0.014 };
const MOST = 64 * 15 * 3; // axes of one world

/// From the joint at a bone's end: the one at its beginning.
const PARENTS = new Map(BONES.map(([parent, child]) => [child, parent]));

export class LimbAxesView {
  constructor() {
    // Bodies do not hide them: the bone's own axis lies inside the bone.
    const material = new THREE.MeshBasicMaterial({ color: 0xffffff, depthTest: false, transparent: true });
    const rod = new THREE.CylinderGeometry(1, 1, 1, 8).translate(0, 0.5, 0);
    this.rods = new Instances(rod, material, 2 * MOST);
    this.knobs = new Instances(new THREE.SphereGeometry(PREDICTED.knob, 8, 6), material, MOST);
    this.object = new THREE.Group();
    this.object.add(this.rods.mesh, this.knobs.mesh);
    for (const mesh of this.object.children) mesh.renderOrder = 1;
  }

  /// `evaluation`: the answer of /evaluation, or null for none.  Returns how many limbs have axes drawn.
  show(bodies, evaluation) {
    this.rods.begin();
    this.knobs.begin();
    const joints = new Map(bodies.map((body) => [Number(body.bodyId), body.joints]));
    const drawn = limbAxesOf(evaluation).filter((limb) => this.showLimb(joints.get(limb.bodyId), limb));
    this.rods.end();
    this.knobs.end();
    return drawn.length;
  }

  showLimb(joints, { bone, tracked, predicted, twistSeen }) {
    const [from, to] = [joints?.[PARENTS.get(bone)], joints?.[bone]];
    if (!seen(from) || !seen(to)) return false;
    const middle = at(from).lerp(at(to), 0.5);
    for (const axis of twistSeen ? [0, 1, 2] : [1]) { // without twist the other two say nothing
      this.showAxis(middle, tracked, axis, TRACKED);
      this.showAxis(middle, predicted, axis, PREDICTED);
    }
    return true;
  }

  showAxis(middle, quaternion, axis, { length, radius, knob }) {
    const turn = new THREE.Quaternion(...quaternion).normalize();
    const along = DIRECTIONS[axis].clone().applyQuaternion(turn);
    const rod = new THREE.Quaternion().setFromUnitVectors(DIRECTIONS[1], along);
    this.rods.add(new THREE.Matrix4().compose(middle, rod, new THREE.Vector3(radius, length, radius)), COLOURS[axis]);
    if (knob) this.knobs.add(new THREE.Matrix4().setPosition(middle.clone().addScaledVector(along, length)), COLOURS[axis]);
  }
}
