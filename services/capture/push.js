// Pushes frames of any tracker from a web page, or from Node 22, to a chorus-sensor whose device is `bridge`.
//
//   import { Pusher } from "./push.js";
//   const pusher = new Pusher("ws://127.0.0.1:8081/push", { name: "my page", layout: "mediapipe_33", intrinsics: {...} });
//   pusher.push([{ id: 1, pixels: landmarks.map((l) => [l.x * width, l.y * height, l.visibility]) }], captured);
//
// `captured`: milliseconds as performance.now() gives them, of when the image was taken; best from requestVideoFrameCallback's
// captureTime.  A page of another origin than the sensor's needs its token and http.allowed_origin.  Frames are dropped while the
// sensor is not there, and while the network is slower than the camera.  What the messages mean: proto/bridge.md.

const RETRY_MS = 1000;
const MOST_UNSENT = 100_000; // [bytes]

/// Nanoseconds since 1970 as digits: a double is too short for them.
function nanoseconds(now) {
  const micros = Math.round((performance.timeOrigin + now) * 1000);
  return String(BigInt(micros) * 1000n);
}

export class Pusher {
  /// `hello` without its type.  `tell(text, message)` is called with every complaint of the sensor, `changed` when the sensor has welcomed
  /// us (with its message) or is lost (with null).  Before each connection `admitted` is asked whether to try.
  constructor(url, hello, { token = "", tell = console.warn, changed = () => {}, admitted = async () => true, Socket = globalThis.WebSocket } = {}) {
    Object.assign(this, { url, tell, changed, admitted, Socket });
    this.welcome = null;
    this.say(hello);
    const escaped = encodeURIComponent(token).replace(/[()']/g, (c) => "%" + c.charCodeAt(0).toString(16));
    this.protocols = token ? ["chorus.push", `chorus.token.${escaped}`] : ["chorus.push"];
    this.sequence = 0;
    this.dropped = 0;
    this.connect();
  }

  /// Says hello, now or once the sensor is there; again when lens or layout have changed.
  say(hello) {
    this.hello = JSON.stringify({ type: "hello", version: 1, ...hello });
    if (this.welcome !== null) this.socket.send(this.hello);
  }

  async connect() {
    const admitted = await this.admitted();
    if (this.closed) return;
    if (!admitted) {
      this.again();
      return;
    }
    const socket = new this.Socket(this.url, this.protocols);
    this.socket = socket;
    socket.onopen = () => socket.send(this.hello);
    socket.onmessage = (event) => this.hear(socket, JSON.parse(event.data), performance.now());
    socket.onerror = () => {};
    socket.onclose = () => {
      this.welcome = null;
      this.changed(null);
      if (!this.closed) this.again();
    };
  }

  again() {
    this.retry = setTimeout(() => this.connect(), RETRY_MS);
  }

  hear(socket, message, received) {
    if (message.type === "welcome") {
      this.welcome = message;
      this.changed(message);
    } else if (message.type === "clock") {
      socket.send(JSON.stringify({ type: "clock", sent: message.sent, received: nanoseconds(received),
        answered: nanoseconds(performance.now()) }));
    } else {
      this.tell(`${message.type}: ${message.context}: ${message.detail}`, message);
    }
  }

  /// Sends one frame; `bodies` is [] when nobody is seen.  Returns false if the frame was dropped.
  push(bodies, captured = performance.now(), more = {}) {
    this.sequence += 1;
    if (this.welcome === null || this.socket.bufferedAmount > MOST_UNSENT) {
      this.dropped += 1;
      return false;
    }
    this.socket.send(JSON.stringify({ type: "frame", sequence: this.sequence, captured: nanoseconds(captured), bodies, ...more }));
    return true;
  }

  close() {
    this.closed = true;
    clearTimeout(this.retry);
    this.socket?.close();
  }
}
