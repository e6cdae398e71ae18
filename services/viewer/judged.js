// What worn sensors say of the limbs (/evaluation): colours and sentences.  Pure.

/// The judged limbs that an answer holds; none where it is of another kind.
export const limbsOf = (evaluation) => (Array.isArray(evaluation?.limbs) ? evaluation.limbs : []).filter((limb) => limb && typeof limb === 'object');

/// The bones of each limb, by the joint at their end.
const BONES = {
  Pelvis: ['SpineMid'], Chest: ['SpineShoulder', 'Neck'], Head: ['Head'],
  UpperArm: ['Elbow'], Forearm: ['Wrist'], Hand: ['Hand', 'HandTip', 'Thumb'],
  Thigh: ['Knee'], Shank: ['Ankle'], Foot: ['Foot'],
};
export const COLOURS = { good: '#2fa866', off: '#ff3b30', calibrating: '#f2b84b' };

/// "ForearmLeft" -> ["WristLeft"]
export function bonesOf(limb) {
  const side = ['Left', 'Right'].find((end) => limb?.endsWith(end)) ?? '';
  return (BONES[limb?.slice(0, limb.length - side.length)] ?? []).map((joint) => joint + side);
}

/// By person and joint at the bone's end: its colour.  Limbs that nobody judges at present have none.
export function judgedBones(evaluation) {
  const people = new Map();
  for (const { bodyId, limb, state } of limbsOf(evaluation)) {
    if (bodyId === undefined || !(state in COLOURS)) continue;
    const bones = people.get(Number(bodyId)) ?? {};
    for (const joint of bonesOf(limb)) bones[joint] = COLOURS[state];
    people.set(Number(bodyId), bones);
  }
  return people;
}

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

const TONES = { off: 'bad', calibrating: 'warn', waiting: 'faint' };
const ORDER = Object.keys(TONES);

/// Sentences about the limbs that are not well, the worst first, and one for all that are.
export function judgedLines(evaluation) {
  const limbs = limbsOf(evaluation);
  const good = limbs.filter(({ state }) => state === 'good').length;
  const others = limbs.filter(({ state }) => state in TONES)
    .sort((first, second) => ORDER.indexOf(first.state) - ORDER.indexOf(second.state))
    .map(({ state, comment }) => ({ tone: TONES[state], text: comment }));
  return good > 0 ? [...others, { tone: 'good', text: `${good === 1 ? 'one limb agrees' : `${good} limbs agree`}` }] : others;
}
