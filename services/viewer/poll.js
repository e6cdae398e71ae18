// Polls the public JSON resources: long polls for frames that are wanted at once, otherwise conditional GETs.

const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
const MAX_BACKOFF_MS = 2000;
const ANSWER_WITHIN_MS = 3000;
const LATEST_MS = 15000; // no answer is on its way for longer: a long poll and ANSWER_WITHIN_MS

/// The server's clock, from its answers (Chorus-Clock: when the request was complete, when the answer left).
/// The fastest exchange is nearest to the truth; the browser's own clock is used only for measuring elapsed time.
export class ServerClock {
  constructor(ticking = () => performance.now()) {
    this.ticking = ticking;
    this.samples = [];
  }

  observe(header) {
    const left = Number(header?.split(' ')[1]);
    if (!Number.isFinite(left) || left <= 0) return;
    const now = this.ticking();
    const offset = left / 1e6 - now;
    if (this.samples.some((sample) => sample.offset - offset > LATEST_MS)) this.samples = []; // it was set back
    this.samples.push({ now, offset });
    while (this.samples.length > 200 || now - this.samples[0].now > 60000) this.samples.shift();
  }

  /// Milliseconds since the epoch by the server's clock; NaN before its first answer.
  now() {
    if (this.samples.length === 0) return NaN;
    return this.ticking() + this.samples.reduce((best, s) => Math.max(best, s.offset), -Infinity);
  }
}
export const clock = new ServerClock();

/// Whether the server answers at all.  An error status counts as an answer.
export class Link {
  constructor(ticking = () => performance.now()) {
    this.ticking = ticking;
    this.answered = null;
    this.error = null;
  }

  up() { [this.answered, this.error] = [this.ticking(), null]; }
  down(error) { this.error = String(error?.message ?? error); }

  /// `silent`: milliseconds since the last answer, NaN if there has been none.
  state() {
    return { error: this.error, silent: this.answered === null ? NaN : this.ticking() - this.answered };
  }
}
export const link = new Link();

/// What a server says against an answer, in a few words.
async function refusalOf(answer) {
  if (answer.status === 401 || answer.status === 403) return 'it asks for a token';
  const { detail } = (await answer.json().catch(() => null)) ?? {};
  return `it answered ${answer.status}${typeof detail === 'string' ? `: ${detail}` : ''}`;
}

/// One resource: `next()` returns its JSON if it has changed, else null.  `check`: returns what is used of the JSON, or throws.
/// `problem`: the error of the newest answer, or null; `failures`: how many there were in a row.
export class Resource {
  constructor(url, waitSeconds = 0, check = (told) => told) {
    this.url = url;
    this.wait = waitSeconds;
    this.check = check;
    this.etag = null;
    this.problem = null;
    this.failures = 0;
  }

  async next() {
    try {
      const value = await this.read();
      [this.problem, this.failures] = [null, 0];
      return value;
    } catch (error) {
      [this.problem, this.failures] = [error, this.failures + 1];
      throw error;
    }
  }

  async read() {
    const headers = { Accept: 'application/json' };
    if (this.etag) headers['If-None-Match'] = this.etag;
    if (this.etag && this.wait) headers.Prefer = `wait=${this.wait}`;
    const signal = AbortSignal.timeout(this.wait * 1000 + ANSWER_WITHIN_MS);
    const answer = await this.answer(headers, signal);
    if (answer.status === 304) return null;
    if (!answer.ok) throw Object.assign(new Error(await refusalOf(answer)), { status: answer.status });
    const told = await answer.json().catch(() => { throw new Error('its answer cannot be read'); });
    const value = this.check(told);
    this.etag = answer.headers.get('ETag'); // not before: what could not be read is asked for again
    return value;
  }

  async answer(headers, signal) {
    try {
      const answer = await fetch(this.url, { headers, cache: 'no-store', signal });
      clock.observe(answer.headers.get('Chorus-Clock'));
      link.up();
      return answer;
    } catch (error) {
      link.down(error);
      throw error;
    }
  }
}

/// Polls for ever, each time after `everyMs` (a number, or a function that says it now); backs off after failures and reports them to `onError`.
export async function follow(resource, everyMs, onValue, onError) {
  let backoff = 250;
  for (;;) {
    try {
      const value = await resource.next();
      if (value !== null) onValue(value);
      backoff = 250;
      await pause(typeof everyMs === 'function' ? everyMs() : everyMs);
    } catch (error) {
      onError(error);
      await pause(backoff);
      backoff = Math.min(backoff * 2, MAX_BACKOFF_MS);
    }
  }
}
