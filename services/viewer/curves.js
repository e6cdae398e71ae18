// The last minute of the room, as lines over time: what people do, how the sensors deliver, what worn sensors say.  Pure.
import { colourOf } from './certainty.js';
import { limbsOf } from './judged.js';

const KEPT_MS = 60000;
const EVERY_MS = 100;
const BROKEN_MS = 1500; // where nothing came for longer, lines have a gap; the page calls a frame stale then
const MOST_LINES = 12;

export const KINDS = { height: ['height of a joint', 'm'], speed: ['speed of a joint', 'm/s'], rate: ['frame rates', 'Hz'], age: ['ages of the newest frames', 'ms'], limbs: ['limbs against worn sensors', '°'] };
export const OF_JOINTS = ['height', 'speed'];

const finite = (value) => (Number.isFinite(value) ? value : null);

/// One instant in few numbers: places by person and joint, rates and ages by source, angles by limb.
function sampleOf({ frame, rate, age, sensors, evaluation }, at) {
  const people = new Map((frame?.bodies ?? []).map((body) => [body.bodyId, new Map(Object.entries(body.joints).filter(([, joint]) => Number.isFinite(joint.x))
    .map(([name, { x, y, z }]) => [name, [x, y, z]]))]));
  const delivering = Object.entries(sensors ?? {}).map(([id, sensor]) => [id, sensor.state === 'live' ? { rate: sensor.rateHz, age: sensor.ageMilliseconds } : {}]);
  const limbs = limbsOf(evaluation).map(({ bodyId, limb, state, angleDegrees, thresholdDegrees }) => [`${limb}${bodyId === undefined ? '' : `, person ${bodyId}`}`,
    { state, angle: Number(angleDegrees ?? NaN), limit: Number(thresholdDegrees ?? NaN) }]);
  return { at, captured: Date.parse(frame?.captured), people, sources: new Map([['fused', { rate, age }], ...delivering]), limbs: new Map(limbs) };
}

export class History {
  constructor() { this.samples = []; }

  /// `known`: { frame, rate, age, sensors, evaluation } as served, those that are current; `now`: [ms] of a steady clock.  Ten times a second suffice.
  take(known, now) {
    if (now - (this.samples.at(-1)?.at ?? -Infinity) < EVERY_MS - 5) return;
    this.samples.push(sampleOf(known, now));
    while (this.samples[0].at < now - KEPT_MS) this.samples.shift();
  }
}

/// Names that occur in any sample, those that came first before others.
const names = (samples, keysOf) => [...new Set(samples.flatMap((sample) => [...keysOf(sample)]))];

function speedAt(samples, i, person, joint) {
  const [before, now] = [samples[i - 1], samples[i]].map((sample) => sample?.people.get(person)?.get(joint));
  const passed = (samples[i].captured - samples[i - 1]?.captured) / 1000;
  if (!before || !now || !(passed > 0) || passed > BROKEN_MS / 1000) return null;
  return Math.hypot(now[0] - before[0], now[1] - before[1], now[2] - before[2]) / passed;
}

const VALUES = {
  height: (samples, i, person, joint) => finite(samples[i].people.get(person)?.get(joint)?.[1]),
  speed: speedAt,
  rate: (samples, i, source) => finite(samples[i].sources.get(source)?.rate),
  age: (samples, i, source) => finite(samples[i].sources.get(source)?.age),
  limbs: (samples, i, limb) => finite(samples[i].limbs.get(limb)?.angle),
};
const SOURCES = { height: 'people', speed: 'people', rate: 'sources', age: 'sources', limbs: 'limbs' };

/// The lines of one kind: { seconds: [before now, negative], lines: [{ name, colour, values }], leftOut, limit }; null in a line is a gap.
/// What the newest sample has comes first, so that it is not left out.
/// `limit`: what a limb is allowed, where all that are judged have the same.
export function linesOf({ samples }, kind, joint, now) {
  const all = names(samples, (sample) => sample[SOURCES[kind]].keys());
  const present = (name) => Number(samples.at(-1)[SOURCES[kind]].has(name));
  const drawn = [...all].sort((first, second) => present(second) - present(first)).slice(0, MOST_LINES);
  const broken = samples.map((sample, i) => i > 0 && sample.at - samples[i - 1].at > BROKEN_MS);
  const lines = drawn.map((name) => ({
    name: OF_JOINTS.includes(kind) ? `person ${name}` : String(name),
    colour: colourOf(OF_JOINTS.includes(kind) ? name : all.indexOf(name)),
    values: samples.map((_, i) => (broken[i] ? null : VALUES[kind](samples, i, name, joint))),
  }));
  const limits = kind === 'limbs' ? [...new Set(samples.flatMap(({ limbs }) => [...limbs.values()].map(({ limit }) => limit)).filter(Number.isFinite))] : [];
  return { seconds: samples.map(({ at }) => (at - now) / 1000), lines, leftOut: all.length - drawn.length, limit: limits.length === 1 ? limits[0] : null };
}

/// How each limb was judged in the last minute: [{ limb, runs: [{ state, from, to }] }]; seconds before now, negative.
export function stripOf({ samples }, now) {
  return names(samples, ({ limbs }) => limbs.keys()).map((limb) => {
    const runs = [];
    for (const { at, limbs } of samples) {
      const seconds = (at - now) / 1000;
      const state = limbs.get(limb)?.state ?? 'waiting';
      const last = runs.at(-1);
      const goesOn = last && seconds - last.to <= BROKEN_MS / 1000;
      if (goesOn) last.to = seconds;
      if (!goesOn || last.state !== state) runs.push({ state, from: seconds, to: seconds });
    }
    return { limb, runs };
  });
}
