// Draws bodies as bones and joints.  Everything here is metres in a right-handed, y-up space.
import * as THREE from 'three';

import { REACH, covarianceOf, rootOf } from './certainty.js';

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

const seen = (joint) =>
  joint !== undefined && joint.state !== 'NotTracked' && Number.isFinite(joint.x);
const at = (joint) => new THREE.Vector3(joint.x, joint.y, joint.z);

/// Faint lines: the bodies that one sensor sees, in that sensor's space (the group holds the pose).
export class RawView {
  constructor(color) {
    this.geometry = new THREE.BufferGeometry();
    const material = new THREE.LineBasicMaterial({ color, transparent: true, opacity: 0.55 });
    this.object = new THREE.Group();
    this.lines = new THREE.LineSegments(this.geometry, material);
    this.lines.frustumCulled = false;
    this.object.add(this.lines);
  }

  show(bodies) {
    const ends = [];
    for (const body of bodies) {
      for (const [parent, child] of BONES) {
        const a = body.joints[parent];
        const b = body.joints[child];
        if (seen(a) && seen(b)) ends.push(a.x, a.y, a.z, b.x, b.y, b.z);
      }
    }
    this.geometry.setAttribute('position', new THREE.Float32BufferAttribute(ends, 3));
    this.lines.visible = ends.length > 0;
    return ends.length / 6;
  }
}

// Shared by all bodies, so that nothing is left over when one disappears.
const BONE = new THREE.CylinderGeometry(0.022, 0.022, 1, 10);
const BALL = new THREE.SphereGeometry(0.03, 14, 10);

/// One fused body: solid bones, joints as balls, inferred parts dimmer.
class FusedBody {
  constructor(material, inferredMaterial) {
    this.materials = { Tracked: material, Inferred: inferredMaterial };
    this.object = new THREE.Group();
    this.bones = BONES.map(() => this.add(BONE));
    this.joints = new Map();
  }

  add(geometry) {
    const mesh = new THREE.Mesh(geometry, this.materials.Tracked);
    this.object.add(mesh);
    return mesh;
  }

  show(joints) {
    let drawn = 0;
    for (const [name, joint] of Object.entries(joints)) {
      if (!this.joints.has(name)) this.joints.set(name, this.add(BALL));
      const mesh = this.joints.get(name);
      mesh.visible = seen(joint);
      if (!mesh.visible) continue;
      mesh.position.copy(at(joint));
      mesh.scale.setScalar(name === 'Head' ? HEAD_RADIUS / 0.03 : 1);
      mesh.material = this.materials[joint.state];
      drawn += 1;
    }
    BONES.forEach(([parent, child], i) => this.showBone(this.bones[i], joints[parent], joints[child]));
    return drawn;
  }

  showBone(mesh, a, b) {
    mesh.visible = seen(a) && seen(b);
    if (!mesh.visible) return;
    const from = at(a);
    const along = at(b).sub(from);
    const length = along.length();
    if (length < 1e-6) {
      mesh.visible = false;
      return;
    }
    mesh.position.copy(from).addScaledVector(along, 0.5);
    mesh.quaternion.setFromUnitVectors(UP, along.divideScalar(length));
    mesh.scale.set(1, length, 1);
    mesh.material = this.materials[a.state === 'Tracked' && b.state === 'Tracked' ? 'Tracked' : 'Inferred'];
  }
}

/// All fused bodies; keeps one object per body id.
export class FusedView {
  constructor() {
    this.object = new THREE.Group();
    this.bodies = new Map();
    this.material = new THREE.MeshStandardMaterial({ color: 0xffffff, roughness: 0.35 });
    this.inferred = new THREE.MeshStandardMaterial({ color: 0x8b98a8, roughness: 0.8 });
  }

  /// Lets through what is inside the bodies: the ellipsoids are often smaller than a bone.
  veil(on) {
    for (const material of [this.material, this.inferred]) {
      if (material.transparent === on) continue;
      Object.assign(material, { transparent: on, opacity: on ? 0.25 : 1, depthWrite: !on, needsUpdate: true });
    }
  }

  show(bodies) {
    const present = new Set(bodies.map((body) => body.bodyId));
    for (const [id, view] of this.bodies) {
      if (present.has(id)) continue;
      this.object.remove(view.object);
      this.bodies.delete(id);
    }
    let drawn = 0;
    for (const body of bodies) {
      if (!this.bodies.has(body.bodyId)) {
        const view = new FusedBody(this.material, this.inferred);
        this.bodies.set(body.bodyId, view);
        this.object.add(view.object);
      }
      drawn += this.bodies.get(body.bodyId).show(body.joints);
    }
    return drawn;
  }
}

const MOST_ELLIPSOIDS = 64 * 25;

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
