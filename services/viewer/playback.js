// Plays a recording from the server, stretch by stretch.  Pure but for `fetchStretch`; times are seconds since the recording's beginning.

const AHEAD_S = 2; // at speed 1
const STEP_S = 1; // what is asked for at once, at speed 1
const LONGEST_S = 5; // as the server allows
const KEPT_S = 12; // behind the instant that is shown
const GONE_S = 1; // what was recorded longer ago is not shown
const DRAWN_HZ = 30;

/// The last message of each topic at or before an instant, by topic; without those that are long past, except for places.
export function latest(messages, at) {
  const found = {};
  for (const message of messages) {
    if (message.seconds > at) break;
    if (message.topic === '/registration' || at - message.seconds <= GONE_S) found[message.topic] = message.message;
    else delete found[message.topic];
  }
  return found;
}

/// Where sensors stood at an instant: the last of the outline's registrations at or before it; before the first one, the first, because
/// they stood there already.  Undefined without any.
export const placesAt = (registrations, at) => ((registrations ?? []).findLast(({ seconds }) => seconds <= at) ?? registrations?.[0])?.registration;

/// The stretch that is fetched next, or null when enough lies ahead.  `held`: [from, to] of what is there, or null; the server may have
/// answered with less than was asked for, and then the rest is asked for.
export function nextStretch(held, at, { speed, length }) {
  const inside = held && at >= held[0] && at - held[1] <= GONE_S;
  const from = inside ? held[1] : Math.max(0, at - GONE_S);
  const wanted = Math.min(length, at + AHEAD_S * Math.max(1, speed));
  if (inside && (held[1] >= wanted || held[1] >= length)) return null;
  const to = Math.min(Math.max(length, from), from + Math.min(LONGEST_S, STEP_S * Math.max(1, speed)));
  return { from, to, every: speed > 1 ? speed / DRAWN_HZ : 0 };
}

/// "1:02.4" of 62.4 s.
export function timeText(seconds) {
  if (!Number.isFinite(seconds)) return '–';
  const tenths = Math.round(10 * seconds);
  return `${Math.floor(tenths / 600)}:${String(Math.floor(tenths / 10) % 60).padStart(2, '0')}.${tenths % 10}`;
}

export class Playback {
  /// `fetchStretch`: resolves to what /recordings/{name}/stretch answers; `ticking`: [ms] of a steady clock.
  constructor(outline, fetchStretch, ticking = () => performance.now()) {
    Object.assign(this, { outline, fetchStretch, ticking, at: 0, speed: 1, playing: false, messages: [], held: null, fetching: false, problem: '' });
    this.last = ticking();
  }

  get length() { return this.outline.seconds; }
  /// Whether it waits for the server.
  get waiting() { return !this.held || this.at < this.held[0] || (this.at > this.held[1] && this.held[1] < this.length); }

  seek(seconds) {
    this.at = Math.min(this.length, Math.max(0, seconds));
    if (this.held && (this.at < this.held[0] || this.at > this.held[1])) this.drop();
    this.fill();
  }

  setSpeed(speed) {
    if (speed > 1 || this.speed > 1) this.drop(); // other frames are left out
    this.speed = speed;
    this.fill();
  }

  toggle() {
    if (!this.playing && this.at >= this.length) this.seek(0);
    this.playing = !this.playing;
  }

  drop() { [this.messages, this.held] = [[], null]; }

  /// Goes on by the time that has passed, and returns what is to be seen now, by topic.
  tick() {
    const now = this.ticking();
    const passed = (now - this.last) / 1000;
    this.last = now;
    if (this.playing && !this.waiting) this.at = Math.min(this.length, this.at + passed * this.speed);
    if (this.at >= this.length) this.playing = false;
    this.fill();
    return latest(this.messages, this.at);
  }

  async fill() {
    const wanted = nextStretch(this.held, this.at, this);
    if (!wanted || this.fetching || this.ticking() < (this.notBefore ?? -Infinity)) return;
    this.fetching = true;
    const held = this.held;
    try {
      const told = await this.fetchStretch(wanted);
      if (!Number.isFinite(told?.to) || !Array.isArray(told.messages)) throw new Error('what the server says of this stretch cannot be read');
      if (held === this.held) this.take(told);
      this.problem = '';
    } catch (error) {
      this.problem = String(error?.message ?? error);
      this.notBefore = this.ticking() + 1000;
    }
    this.fetching = false;
  }

  take({ from, to, messages }) {
    if (this.held && from !== this.held[1]) this.drop(); // it was asked for before a jump
    const behind = Math.max(from, this.at) - KEPT_S;
    const places = this.messages.filter(({ topic }) => topic === '/registration').slice(-1);
    const kept = this.messages.filter((message) => message.seconds >= behind);
    const known = new Set(kept);
    const last = this.messages.at(-1);
    const fresh = last ? messages.filter(({ seconds, topic }) => seconds > last.seconds || (seconds === last.seconds && topic !== last.topic)) : messages;
    this.messages = [...places.filter((one) => !known.has(one)), ...kept, ...fresh];
    this.held = [this.held ? Math.max(this.held[0], behind) : from, to];
  }
}
