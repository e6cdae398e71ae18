// The state of the tracker in one plain sentence, and what to do next.  Pure: known facts in, sentence out.

export const STALE_MS = 1500;
const GONE_MS = 4000;
const MOST_HZ = 1000; // no server is as fast

const many = (count, one, more) => (count === 1 ? `one ${one}` : `${count} ${more}`);
const seconds = (ms) => `${Math.round(ms / 1000)} s`;

const isObject = (value) => value !== null && typeof value === 'object' && !Array.isArray(value);
const MOST_BODIES = 64; // as many as the scene draws

/// A frame as it is shown: of more than 64 bodies the first ones, without what is no body or no joint.  Throws when it is no frame.
export function frameOf(told) {
  const is = isObject(told) && Number.isFinite(told.sequence) && /^\d+$/.test(told.capturedNanoseconds) && Number.isFinite(Date.parse(told.captured));
  if (!is) throw new Error('what it calls a frame is none');
  const jointsOf = (body) => Object.fromEntries(Object.entries(body.joints).filter(([, joint]) => isObject(joint)));
  const all = (Array.isArray(told.bodies) ? told.bodies : []).filter((body) => isObject(body) && isObject(body.joints));
  return { ...told, bodies: all.slice(0, MOST_BODIES).map((body) => ({ ...body, joints: jointsOf(body) })), leftOut: Math.max(0, all.length - MOST_BODIES) };
}

/// /sensors/ without what is no sensor.  Throws when nothing is said of sensors.
export function sensorsOf(told) {
  const all = isObject(told) ? told.sensors ?? {} : null;
  if (!isObject(all)) throw new Error('what it says cannot be read');
  return { ...told, sensors: Object.fromEntries(Object.entries(all).filter(([, sensor]) => isObject(sensor))) };
}

/// /registration if it is one: lists are lists.
export function registrationOf(told) {
  const lists = ['reasons', 'awaits', 'alarms'];
  if (!isObject(told) || !lists.every((key) => told[key] === undefined || Array.isArray(told[key])) || (told.sensors !== undefined && !isObject(told.sensors)))
    throw new Error('what it says cannot be read');
  return told;
}

function list(names) {
  if (names.length < 2) return names.join('');
  return `${names.slice(0, -1).join(', ')} and ${names.at(-1)}`;
}

/// Finds out whether this page itself was held up: its timer should go off every `every` ms.
/// What a page shows after a pause is as old as the pause, whatever the server has done meanwhile.
export class OwnDelay {
  constructor(every, ticking = () => performance.now()) {
    [this.every, this.ticking, this.last, this.until] = [every, ticking, ticking(), -Infinity];
  }

  /// Called by the timer.  True while the page catches up: for STALE_MS after it went off late.
  late() {
    const now = this.ticking();
    if (now - this.last > this.every + STALE_MS / 2) this.until = now + STALE_MS;
    this.last = now;
    return now < this.until;
  }
}

/// The rate of the fused output [Hz], by the numbers of the frames and their capture times, so that it is also right on a page
/// that is too slow to get every frame.
export class OutputRate {
  constructor() { this.recent = []; }

  after({ sequence, capturedNanoseconds }) {
    const now = { sequence, at: Number(BigInt(capturedNanoseconds) / 1000n) / 1e6 };
    const last = this.recent.at(-1);
    const goesOn = last && sequence > last.sequence && sequence - last.sequence < MOST_HZ * (now.at - last.at);
    this.recent = goesOn ? [...this.recent.slice(-60), now] : [now]; // a server that was started anew counts from elsewhere
    const first = this.recent[0];
    return now.at > first.at ? (sequence - first.sequence) / (now.at - first.at) : NaN;
  }
}

/// How old something is: milliseconds, from 10 s on seconds; a dash when unknown.
export function ageText(ms) {
  if (!Number.isFinite(ms)) return '–';
  return ms < 10000 ? `${ms.toFixed(0)} ms` : seconds(ms);
}

/// Whether the screen is current: 'live', 'stale' (old, and shown as old) or 'gone' (no longer shown).
export function freshness(known) {
  if (!known.frame) return 'gone';
  const old = Math.max(known.link.error ? known.link.silent : 0, known.frameAge || 0);
  if (old > GONE_MS && !known.held) return 'gone';
  return old > STALE_MS || known.link.error ? 'stale' : 'live';
}

function ofTheLink({ link, frame, frameAge, frameProblem, held }) {
  const silent = link.silent;
  if (held && frame && !(frameAge <= STALE_MS)) {
    return { tone: 'warn', sentence: 'This page was held up, and catches up.', next: 'This browser or its computer is busy; that says nothing about the tracker.' };
  }
  if (link.error && !(silent < STALE_MS)) {
    const since = Number.isFinite(silent) ? `The fusion server has not answered for ${seconds(silent)}.` : 'The fusion server does not answer.';
    return { tone: 'bad', sentence: since, next: 'Is chorus-fusion running there? This page goes on by itself as soon as it answers.' };
  }
  if (frameProblem && !(frame && frameAge <= STALE_MS)) {
    const next = [401, 403].includes(frameProblem.status) ? 'Load this page again, and give the token as the password.' : 'Look into the log of chorus-fusion.';
    return { tone: 'bad', sentence: `The fusion server gives no frames: ${frameProblem.message}.`, next };
  }
  if (!frame) return { tone: 'warn', sentence: 'Waiting for the first frame of the fusion server …', next: '' };
  if (frameAge > STALE_MS) {
    return { tone: 'bad', sentence: `The fused output has stood still for ${seconds(frameAge)}.`, next: 'Look into the log of chorus-fusion.' };
  }
  return null;
}

function ofTheSensors(sensors) {
  const all = Object.entries(sensors);
  const dead = all.filter(([, sensor]) => sensor.state !== 'live');
  const why = dead.map(([id, sensor]) => (sensor.lastError ? `${id}: ${sensor.lastError}` : '')).find(Boolean);
  if (all.length === 0) {
    return { tone: 'bad', sentence: 'No sensors are configured.', next: 'Add them: under Sensors, below.' };
  }
  if (dead.length === all.length) {
    const sentence = all.length === 1 ? 'The only sensor delivers nothing.' : `None of the ${all.length} sensors delivers anything.`;
    return { tone: 'bad', sentence, next: why ?? 'Start the sensors; their addresses are in the configuration.' };
  }
  if (dead.length === 0) return null;
  const names = list(dead.map(([id]) => id));
  return { tone: 'warn', sentence: `${names} ${dead.length === 1 ? 'delivers' : 'deliver'} nothing.`, next: why ?? 'Look after them.' };
}

/// A sensor that was moved is told of before anything else about places.
function ofTheAlarms({ alarms = [] }) {
  if (alarms.length === 0) return null;
  const [what, next = ''] = alarms[0].split('; ');
  return { tone: 'bad', sentence: `${what}.`, next };
}

function ofTheRegistration({ session, sensors = {}, awaits = [], verdict, proposal }) {
  const placed = Object.values(sensors).filter((sensor) => sensor.polled !== false).length;
  if (session?.state === 'solving') return { tone: 'warn', sentence: 'The walk is over: the places are being solved.', next: '' };
  if (session?.state === 'collecting') {
    const walked = `${Math.round(session.elapsedSeconds)} of ${Math.round(session.targetSeconds)} s`;
    return { tone: 'warn', sentence: `Registering: ${walked} of the walk seen.`, next: awaits.at(-1) ?? '' };
  }
  if (placed === 0) {
    return { tone: 'warn', sentence: 'It is not known yet where the sensors stand.', next: awaits.at(-1) ?? 'Walk through the room.' };
  }
  if (proposal) return { tone: 'warn', sentence: 'New places wait for your decision.', next: 'Accept them, or keep the old ones: under Register.' };
  if (verdict === 'Good') return null;
  return { tone: 'warn', sentence: '', next: '' };
}

/// A reason against a Good registration as a whole: the last walk contradicted it.
function doubtOf({ verdict, reasons = [], sensors = {}, unplaced = {} }) {
  if (verdict !== 'Good') return null;
  const own = [...Object.values(sensors), ...Object.values(unplaced)].flatMap((sensor) => sensor.reasons ?? []);
  return reasons.find((reason) => !own.includes(reason)) ?? null;
}

/// Resources that were not read the last times: what is shown of them is old.  `unread`: [[what, error]].
function ofTheUnread({ unread = [] }) {
  if (unread.length === 0) return null;
  return { tone: 'warn', sentence: `The fusion server says nothing of ${list(unread.map(([what]) => what))}: ${unread[0][1].message}.`, next: 'What is shown of that is old.' };
}

/// Returns {tone: 'good' | 'calm' | 'warn' | 'bad', sentence, next}.
export function stateOf(known) {
  const link = ofTheLink(known) ?? ofTheUnread(known);
  if (link) return link;
  const { sensors, registration, frame } = known;
  if (!sensors || !registration) return { tone: 'warn', sentence: 'Connecting to the fusion server …', next: '' };
  const missing = ofTheSensors(sensors);
  if (missing?.tone === 'bad') return missing;
  const alarm = ofTheAlarms(registration);
  if (alarm) return alarm;
  const places = ofTheRegistration(registration);
  if (places?.sentence) return missing ? { ...places, sentence: `${places.sentence} ${missing.sentence}` } : places;
  const people = (frame.bodies?.length ?? 0) + (frame.leftOut ?? 0);
  const carried = (frame.bodies ?? []).filter((body) => body.carriedFor !== undefined).length;
  const present = many(people, 'person', 'people') + (carried > 0 ? ` (${carried} out of sight)` : '');
  const seen = people === 0 ? 'Nobody is in sight.' : `Live: ${present}.`;
  if (missing) return { ...missing, sentence: `${seen} ${missing.sentence}` };
  if (places) return { tone: 'warn', sentence: `${seen} The places are provisional.`, next: registration.awaits?.[0] ?? registration.reasons?.[0] ?? '' };
  const doubt = doubtOf(registration);
  if (doubt) return { tone: 'warn', sentence: `${seen} The places are in doubt.`, next: doubt };
  const unplaced = Object.keys(registration.unplaced ?? {});
  if (unplaced.length > 0) {
    return { tone: 'warn', sentence: `${seen} ${list(unplaced)} ${unplaced.length === 1 ? 'has' : 'have'} no place.`,
      next: Object.values(registration.unplaced)[0].reasons?.[0] ?? '' };
  }
  if (people === 0) return { tone: 'calm', sentence: seen, next: 'Walk to where a sensor can see you.' };
  return { tone: 'good', sentence: `Live: ${present}, ${many(Object.keys(sensors).length, 'sensor', 'sensors')}.`, next: '' };
}

/// The lowest certainty of left and right over all people; a dash when unknown.
export function sidesOf(frame) {
  const all = (frame?.bodies ?? []).map((body) => Number(body.sidesConfidence ?? NaN)).filter(Number.isFinite);
  if (all.length === 0) return '–';
  return `${Math.floor(100 * Math.min(...all))} % certain`;
}

/// What is said while a recording is shown instead of the room.
export function stateOfPlayback({ name, at, seconds }, only) {
  const now = (time) => `${time.toFixed(1)} s`;
  return { tone: 'calm', sentence: `A recording is shown: ${name} at ${now(at)} of ${now(seconds)}.`, next: only ? '' : 'The room as it is now is behind it: “Back to the room”.' };
}
