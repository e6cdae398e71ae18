// The connection to the sensor that serves this page: knocks, pushes, comes back, and knows why it does not.
import { knock } from './door.js';
import { Pusher } from './push.js';

/// States after which trying again would only be another wrong guess: somebody has to enter another token first.
export const HOPELESS = ['token', 'wrong', 'role', 'unset', 'tries'];
const MOST_SHUT = 3; // attempts without a word

/// Whether the sensor would let us push, as {state, detail}: 'open', 'unreachable' or one of HOPELESS.
export async function atTheDoor(root, token, ask = (...words) => fetch(...words)) {
  const { state, detail } = await knock(new URL('push', root).href, token, ask);
  if (state === 'token' && token) return { state: 'wrong', detail };
  if (state === 'role' && !token) return { state: 'unset', detail };
  return { state, detail };
}

export class Link {
  /// `root`: the sensor's address.  `changed({state, detail})` with 'connecting', 'welcomed' (then with `sensor`), 'busy', 'bye', 'shut' or
  /// what atTheDoor() said; `complain(text)` for each frame that is refused.
  constructor({ root, token, hello, changed, complain, Socket, ask }) {
    Object.assign(this, { root, token, changed, complain, ask });
    this.state = 'connecting';
    this.shut = 0;
    const url = new URL('push', root);
    url.protocol = url.protocol.replace('http', 'ws');
    this.pusher = new Pusher(url.href, hello, {
      token,
      tell: (text, message) => this.#told(message),
      changed: (welcome) => this.#moved(welcome),
      admitted: () => this.#admitted(),
      ...(Socket && { Socket }),
    });
  }

  say(hello) { this.pusher.say(hello); }
  push(bodies, captured) { return this.pusher.push(bodies, captured); }

  close() {
    this.closed = true;
    this.pusher.close();
  }

  #set(state, more = {}) {
    this.state = state;
    if (!this.closed) this.changed({ state, detail: '', ...more });
  }

  async #admitted() {
    const { state, detail } = await atTheDoor(this.root, this.token, this.ask);
    if (state === 'open') return true;
    if (HOPELESS.includes(state)) this.pusher.close();
    this.#set(state, { detail });
    return false;
  }

  #told({ type, code, context, detail }) {
    if (type === 'error') this.complain(context ? `${context}: ${detail}` : detail);
    else this.#set(code === 'conflict' ? 'busy' : 'bye', { detail });
  }

  #moved(welcome) {
    if (welcome) {
      this.shut = 0;
      this.#set('welcomed', { sensor: welcome.sensor });
      return;
    }
    if (this.state === 'busy' || this.state === 'bye') return; // the reason is known
    this.shut += 1;
    this.#set(this.shut > MOST_SHUT ? 'shut' : 'connecting');
  }
}
