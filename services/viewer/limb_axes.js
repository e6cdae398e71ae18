// How the tracker and the worn sensors have each judged limb turned (/evaluation).  Pure.
import { bonesOf, limbsOf } from './judged.js';

const AXES = ['x', 'y', 'z', 'w'];
const NEAR_ONE = 0.05; // of a quaternion's length

/// The four members `name`x ... `name`w as [x, y, z, w]; null where they are no rotation.
function quaternionOf(limb, name) {
  const q = AXES.map((axis) => Number(limb[name + axis] ?? NaN));
  return Math.abs(Math.hypot(...q) - 1) <= NEAR_ONE ? q : null;
}

/// How both have each judged limb turned: [{ bodyId, bone, tracked, predicted, twistSeen }].  `bone`: the joint at its end;
/// quaternions [x, y, z, w] take limb axes (+y along the bone) to the tracker's space.
export function limbAxesOf(evaluation) {
  return limbsOf(evaluation).flatMap((limb) => {
    const [bone] = bonesOf(typeof limb.limb === 'string' ? limb.limb : undefined);
    const [tracked, predicted] = [quaternionOf(limb, 'q'), quaternionOf(limb, 'predictedQ')];
    if (limb.bodyId === undefined || !bone || !tracked || !predicted) return [];
    return [{ bodyId: Number(limb.bodyId), bone, tracked, predicted, twistSeen: limb.twistDegrees !== undefined }];
  });
}
