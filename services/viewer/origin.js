// "Origin here": one person stands where the world shall begin, facing the front, while the frames are watched.
// The same rules as `chorus origin --here` (services/ctl/align/origin_command.cpp).
import { request } from './request.js';

const SURE = 0.95; // smallest certainty of left and right
const NARROWEST = 0.05; // smallest sum of the vectors from right to left [m]
const STILL = 0.1; // largest movement [m]
const TURNED = 10; // largest turn [deg]
const ENOUGH = 5; // smallest number of frames
const GET_READY_S = 5;
const WATCH_S = 2;

const degrees = (radians) => (180 * radians) / Math.PI;
const turn = (a, b) => Math.abs(((((a - b) % 360) + 540) % 360) - 180);

/// Pure: { x, z, yaw } [m, deg] of the only person in the frame, or { problem }.
export function stanceIn(frame) {
  const bodies = frame?.bodies ?? [];
  if (bodies.length === 0) return { problem: 'nobody is seen; stand where the world shall begin' };
  if (bodies.length > 1) return { problem: 'more than one person is seen; only the one who shows the origin may be' };
  const { joints, sidesConfidence } = bodies[0];
  if (sidesConfidence < SURE) return { problem: 'which way the person faces is uncertain; walk a few steps and come back' };
  const along = (axis) => (joints.HipLeft?.[axis] - joints.HipRight?.[axis]) + (joints.ShoulderLeft?.[axis] - joints.ShoulderRight?.[axis]);
  const [x, z, leftX, leftZ] = [joints.SpineBase?.x, joints.SpineBase?.z, along('x'), along('z')];
  if (![x, z].every(Number.isFinite) || !(Math.hypot(leftX, leftZ) > NARROWEST))
    return { problem: 'hips or shoulders are not seen; turn or step aside' };
  return { x, z, yaw: degrees(Math.atan2(-leftZ, leftX)) };
}

/// Pure: the mean of the stances of a person who stands still, as POST /registration/origin takes it, or { problem }.
export function steady(stances) {
  if (stances.length < ENOUGH) return { problem: 'too few frames came; is the tracker running?' };
  const mean = (value) => stances.reduce((sum, stance) => sum + value(stance), 0) / stances.length;
  const radians = ({ yaw }) => (Math.PI * yaw) / 180;
  const [x, z] = [mean((stance) => stance.x), mean((stance) => stance.z)];
  const yawDegrees = degrees(Math.atan2(mean((stance) => Math.sin(radians(stance))), mean((stance) => Math.cos(radians(stance)))));
  const moved = stances.some((stance) => Math.hypot(stance.x - x, stance.z - z) > STILL || turn(stance.yaw, yawDegrees) > TURNED);
  return moved ? { problem: 'the person moved or turned; stand still and retry' } : { x, z, yawDegrees };
}

/// Watches the frames that `take` is given until enough are seen.
class Watch {
  stances = [];
  problem = null;

  take(frame) {
    const stance = stanceIn(frame);
    if (stance.problem) this.problem ??= stance.problem;
    else this.stances.push(stance);
  }
  result() {
    return this.problem ? { problem: this.problem } : steady(this.stances);
  }
}

let watching = null;

/// To be called with every new fused frame.
export function watchOrigin(frame) {
  watching?.take(frame);
}

const pause = (seconds) => new Promise((resolve) => { setTimeout(resolve, 1000 * seconds); });

/// Counts down, watches the person, moves the origin, and says each step.  Returns what came of it.
/// `resource`: the URL of a resource by its path; `timing`: seconds to get ready and to be watched.
export async function showOrigin(resource, say, timing = { ready: GET_READY_S, watch: WATCH_S }) {
  for (let left = timing.ready; left > 0; left -= 1) {
    say(`Stand where the world shall begin and face its front: ${left} s`);
    await pause(Math.min(1, left));
  }
  say('Stand still …');
  watching = new Watch();
  await pause(timing.watch);
  const found = watching.result();
  watching = null;
  if (found.problem) return found.problem;
  const problem = await request(resource('registration/origin'), found);
  return problem || `The world begins at what was x ${found.x.toFixed(2)} m, z ${found.z.toFixed(2)} m; its front is what was ${found.yawDegrees.toFixed(1)}°.`;
}
