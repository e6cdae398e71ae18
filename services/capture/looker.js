// The page's side of looker_worker.js: one picture at a time, the newest.

export class Looker {
  /// `changed({state: 'loading' | 'ready' | 'failed', detail})`.
  constructor(model, changed) {
    this.hello = null;
    this.waiting = null;
    this.failed = false;
    this.changed = changed;
    this.worker = new Worker('looker_worker.js');
    this.worker.onmessage = ({ data }) => this.#hear(data);
    this.worker.onerror = (event) => this.#fail(event.message || 'Files of the page are missing: apt install chorus-camera, or npm ci --prefix services/pose-runner, on the sensor’s host.');
    changed({ state: 'loading', detail: '' });
    this.worker.postMessage({ type: 'load', model });
  }

  /// Whether it can take a picture now.
  free() { return this.hello !== null && this.waiting === null && !this.failed; }

  /// The bodies in a picture (ImageData), in its pixels.  `captured` [ms].  Null when it failed.
  look({ width, height, data }, captured) {
    return new Promise((resolve) => {
      this.waiting = resolve;
      this.worker.postMessage({ type: 'image', width, height, pixels: data, time: captured / 1000 }, [data.buffer]);
    });
  }

  end() {
    this.worker.terminate();
    this.#answer(null);
  }

  #answer(bodies) {
    const resolve = this.waiting;
    this.waiting = null;
    resolve?.(bodies);
  }

  #fail(detail) {
    this.failed = true;
    this.changed({ state: 'failed', detail });
    this.#answer(null);
  }

  #hear(message) {
    if (message.type === 'progress') this.changed({ state: 'loading', detail: message.detail });
    if (message.type === 'failed') this.#fail(message.detail);
    if (message.type === 'bodies') this.#answer(message.bodies);
    if (message.type !== 'ready') return;
    this.hello = message.hello;
    this.changed({ state: 'ready', detail: '' });
  }
}
