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
