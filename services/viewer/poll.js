// Polling the public JSON resources: a long poll where a frame is wanted at once, plain conditional GETs else.

const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
const MAX_BACKOFF_MS = 5000;

/// One resource: `next()` gives its JSON when it changed, null when it did not.
export class Resource {
  constructor(url, waitSeconds = 0) {
    this.url = url;
    this.wait = waitSeconds;
    this.etag = null;
  }

  async next() {
    const headers = { Accept: 'application/json' };
    if (this.etag) headers['If-None-Match'] = this.etag;
    if (this.etag && this.wait) headers.Prefer = `wait=${this.wait}`;
    const answer = await fetch(this.url, { headers, cache: 'no-store' });
    if (answer.status === 304) return null;
    if (!answer.ok) throw new Error(`${this.url} answered ${answer.status}`);
    this.etag = answer.headers.get('ETag');
    return answer.json();
  }
}

/// Polls forever; failures back off and are told to `onError`.
export async function follow(resource, everyMs, onValue, onError) {
  let backoff = 250;
  for (;;) {
    try {
      const value = await resource.next();
      if (value !== null) onValue(value);
      backoff = 250;
      await pause(everyMs);
    } catch (error) {
      onError(error);
      await pause(backoff);
      backoff = Math.min(backoff * 2, MAX_BACKOFF_MS);
    }
  }
}
