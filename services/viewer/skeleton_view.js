// Draws bodies as bones and joints.  Everything here is metres in a right-handed, y-up space.
import * as THREE from 'three';

import { REACH, colourOf, covarianceOf, rootOf } from './certainty.js';

// The bones of the 25 Kinect v2 joints: parent, child (common/body/bones.h).
export const BONES = [
  ['SpineBase', 'SpineMid'], ['SpineMid', 'SpineShoulder'], ['SpineShoulder', 'Neck'], ['Neck', 'Head'],
  ['SpineShoulder', 'ShoulderLeft'], ['ShoulderLeft', 'ElbowLeft'], ['ElbowLeft', 'WristLeft'],
  ['WristLeft', 'HandLeft'], ['HandLeft', 'HandTipLeft'], ['WristLeft', 'ThumbLeft'],
  ['SpineShoulder', 'ShoulderRight'], ['ShoulderRight', 'ElbowRight'], ['ElbowRight', 'WristRight'],
  ['WristRight', 'HandRight'], ['HandRight', 'HandTipRight'], ['WristRight', 'ThumbRight'],
  ['SpineBase', 'HipLeft'], ['HipLeft', 'KneeLeft'], ['KneeLeft', 'AnkleLeft'], ['AnkleLeft', 'FootLeft'],
  ['SpineBase', 'HipRight'], ['HipRight', 'KneeRight'], ['KneeRight', 'AnkleRight'], ['AnkleRight', 'FootRight'],
];

const UP = new THREE.Vector3(0, 1, 0);
const HEAD_RADIUS = 0.095;

export const seen = (joint) =>
  joint && joint.state !== 'NotTracked' && Number.isFinite(joint.x) && Number.isFinite(joint.y) && Number.isFinite(joint.z);
export const at = (joint) => new THREE.Vector3(joint.x, joint.y, joint.z);

const MOST_RAW_ENDS = 2 * BONES.length * 16; // of one sensor: sixteen bodies

/// Faint lines: the bodies that one sensor sees, in that sensor's space (the group holds the pose).  One buffer, filled anew for each frame.
export class RawView {
  constructor(color) {
    this.geometry = new THREE.BufferGeometry();
    this.geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(3 * MOST_RAW_ENDS), 3));
    const material = new THREE.LineBasicMaterial({ color, transparent: true, opacity: 0.55 });
    this.object = new THREE.Group();
    this.lines = new THREE.LineSegments(this.geometry, material);
    this.lines.frustumCulled = false;
    this.object.add(this.lines);
    this.show([]);
  }

  /// Returns how many bones are drawn.
  show(bodies) {
    const { position } = this.geometry.attributes;
    let end = 0;
    for (const { joints } of bodies) {
      for (const [parent, child] of BONES) {
        if (!seen(joints?.[parent]) || !seen(joints?.[child]) || end + 2 > MOST_RAW_ENDS) continue;
        for (const { x, y, z } of [joints[parent], joints[child]]) position.setXYZ(end++, x, y, z);
      }
    }
    position.needsUpdate = true;
    this.geometry.setDrawRange(0, end);
    this.lines.visible = end > 0;
    return end / 2;
  }
}

const MOST_BODIES = 64;
const LEFT_DARKER = 0.55; // left limbs are this much of the person's colour, so that left and right can be told apart
const INFERRED_PALER = 0.45;
const GUESSED = { dark: new THREE.Color(0x4f5a68), light: new THREE.Color(0xb9c2cc) };

const left = (name) => name.endsWith('Left');

/// Instances of one geometry that are filled anew for each frame.
export class Instances {
  constructor(geometry, material, most) {
    this.mesh = new THREE.InstancedMesh(geometry, material, most);
    this.mesh.frustumCulled = false;
    this.mesh.count = 0;
    this.most = most;
    for (let i = 0; i < most; i += 1) this.mesh.setColorAt(i, new THREE.Color(0xffffff));
  }

  begin() { this.mesh.count = 0; }

  add(matrix, color) {
    if (this.mesh.count >= this.most) return;
    this.mesh.setMatrixAt(this.mesh.count, matrix);
    this.mesh.setColorAt(this.mesh.count, color);
    this.mesh.count += 1;
  }

  end() {
    this.mesh.instanceMatrix.needsUpdate = true;
    this.mesh.instanceColor.needsUpdate = true;
  }
}

/// All fused bodies, each person in a colour of its own: solid bones, joints as balls, inferred parts paler, left limbs darker.
export class FusedView {
  constructor() {
    this.material = new THREE.MeshLambertMaterial({ color: 0xffffff });
    this.bones = new Instances(new THREE.CylinderGeometry(0.022, 0.022, 1, 6, 1, true), this.material, MOST_BODIES * BONES.length);
    this.joints = new Instances(new THREE.SphereGeometry(0.03, 8, 6), this.material, MOST_BODIES * 25);
    this.object = new THREE.Group();
    this.object.add(this.bones.mesh, this.joints.mesh);
    this.guessed = GUESSED.dark;
    this.judged = new Map(); // judgedBones() of judged.js
  }

  theme(theme) { this.guessed = GUESSED[theme]; }

  /// Lets through what is inside the bodies: the ellipsoids are often smaller than a bone.
  veil(on) {
    if (this.material.transparent === on) return;
    Object.assign(this.material, { transparent: on, opacity: on ? 0.25 : 1, depthWrite: !on, needsUpdate: true });
  }

  colour(body, name, tracked) {
    const color = new THREE.Color(colourOf(body.bodyId));
    if (left(name)) color.multiplyScalar(LEFT_DARKER);
    return tracked ? color : color.lerp(this.guessed, INFERRED_PALER);
  }

  /// A bone that worn sensors judge has the colour of the judgement.
  boneColour(body, child, tracked) {
    const judged = this.judged.get(Number(body.bodyId))?.[child];
    return judged ? new THREE.Color(judged) : this.colour(body, child, tracked);
  }

  /// Returns how many joints are drawn.
  show(bodies) {
    this.bones.begin();
    this.joints.begin();
    for (const body of bodies) this.showBody(body);
    this.bones.end();
    this.joints.end();
    return this.joints.mesh.count;
  }

  showBody(body) {
    const matrix = new THREE.Matrix4();
    for (const [name, joint] of Object.entries(body.joints ?? {})) {
      if (!seen(joint)) continue;
      const scale = name === 'Head' ? HEAD_RADIUS / 0.03 : 1;
      matrix.makeScale(scale, scale, scale).setPosition(joint.x, joint.y, joint.z);
      this.joints.add(matrix, this.colour(body, name, joint.state === 'Tracked'));
    }
    for (const [parent, child] of BONES) this.showBone(body, parent, child);
  }

  showBone(body, parent, child) {
    const [a, b] = [body.joints?.[parent], body.joints?.[child]];
    if (!seen(a) || !seen(b)) return;
    const from = at(a);
    const along = at(b).sub(from);
    const length = along.length();
    if (length < 1e-6) return;
    const middle = from.addScaledVector(along, 0.5);
    const turn = new THREE.Quaternion().setFromUnitVectors(UP, along.divideScalar(length));
    const tracked = a.state === 'Tracked' && b.state === 'Tracked';
    this.bones.add(new THREE.Matrix4().compose(middle, turn, new THREE.Vector3(1, length, 1)), this.boneColour(body, child, tracked));
  }
}

const TRAIL_S = 10;
const TRAIL_EVERY_MS = 100;
const MOST_TRAIL_ENDS = MOST_BODIES * 2 * ((1000 * TRAIL_S) / TRAIL_EVERY_MS);

/// Where people went in the last seconds, as lines on the floor in their colours.
export class TrailView {
  constructor() {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(3 * MOST_TRAIL_ENDS), 3));
    geometry.setAttribute('color', new THREE.BufferAttribute(new Float32Array(3 * MOST_TRAIL_ENDS), 3));
    this.object = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ vertexColors: true, transparent: true, opacity: 0.7 }));
    this.object.frustumCulled = false;
    this.clear();
  }

  clear() {
    this.paths = new Map();
    this.last = -Infinity;
    this.object.geometry.setDrawRange(0, 0);
  }

  /// `now`: [ms] of any steady clock.
  show(bodies, now) {
    if (now - this.last < TRAIL_EVERY_MS) return;
    this.last = now;
    for (const { bodyId, joints } of bodies) {
      if (!seen(joints?.SpineBase)) continue;
      this.paths.set(bodyId, [...(this.paths.get(bodyId) ?? []), { x: joints.SpineBase.x, z: joints.SpineBase.z, now }]);
    }
    for (const [id, path] of this.paths) {
      while (path.length > 0 && now - path[0].now > 1000 * TRAIL_S) path.shift();
      if (path.length === 0) this.paths.delete(id);
    }
    this.fill();
  }

  fill() {
    const { position, color } = this.object.geometry.attributes;
    let end = 0;
    for (const [id, path] of this.paths) {
      const own = new THREE.Color(colourOf(id));
      for (let i = 1; i < path.length && end + 2 <= MOST_TRAIL_ENDS; i += 1) {
        for (const { x, z } of [path[i - 1], path[i]]) {
          position.setXYZ(end, x, 0.01, z);
          color.setXYZ(end, own.r, own.g, own.b);
          end += 1;
        }
      }
    }
    position.needsUpdate = true;
    color.needsUpdate = true;
    this.object.geometry.setDrawRange(0, end);
  }
}

const MOST_ELLIPSOIDS = MOST_BODIES * 25;

/// Where each fused joint is with 95 % probability, as ellipsoids.  One mesh for all, because there may be 1600 of them.
export class EllipsoidView {
  constructor() {
    const material = new THREE.MeshBasicMaterial({ color: 0xff5ccf, transparent: true, opacity: 0.5, depthWrite: false });
    this.object = new THREE.InstancedMesh(new THREE.SphereGeometry(1, 16, 12), material, MOST_ELLIPSOIDS);
    this.object.frustumCulled = false;
    this.object.count = 0;
  }

  /// Returns how many joints state a covariance.
  show(bodies) {
    const matrix = new THREE.Matrix4();
    let drawn = 0;
    for (const body of bodies) {
      for (const joint of Object.values(body.joints ?? {})) {
        const covariance = seen(joint) && covarianceOf(joint);
        if (!covariance || drawn >= MOST_ELLIPSOIDS) continue;
        const [a, b, c, d, e, f] = rootOf(covariance).map((term) => REACH * term);
        matrix.set(a, 0, 0, joint.x, b, c, 0, joint.y, d, e, f, joint.z, 0, 0, 0, 1);
        this.object.setMatrixAt(drawn, matrix);
        drawn += 1;
      }
    }
    this.object.count = drawn;
    this.object.instanceMatrix.needsUpdate = true;
    return drawn;
  }
}

/// The frustum of a depth camera: 70 x 60 degrees, drawn to 1.2 m.
export function frustum(color) {
  const depth = 1.2;
  const x = depth * Math.tan((35 * Math.PI) / 180);
  const y = depth * Math.tan((30 * Math.PI) / 180);
  const eye = [0, 0, 0];
  const corners = [[-x, -y, depth], [x, -y, depth], [x, y, depth], [-x, y, depth]];
  const ends = [];
  corners.forEach((corner, i) => ends.push(...eye, ...corner, ...corner, ...corners[(i + 1) % 4]));
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(ends, 3));
  const group = new THREE.Group();
  group.add(new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ color, transparent: true, opacity: 0.8 })));
  group.add(new THREE.Mesh(new THREE.BoxGeometry(0.24, 0.06, 0.06), new THREE.MeshStandardMaterial({ color })));
  return group;
}
