// The camera of this device: opens it, tells of each picture when it was taken, and brings it back when it is lost.
import { cameraStateOf } from './state.js';

const LATENCY_MS = 60; // from light to arrival, where the browser does not tell
const SILENT_MS = 3000;
const AGAIN_MS = 2000;
// Never scaled by the browser: it would cut the picture to the wished shape, and with it the field of view.
const WISHES = { width: { ideal: 1280 }, height: { ideal: 720 }, frameRate: { ideal: 30 }, resizeMode: { ideal: 'none' } };

/// When a picture was taken, by performance.now().  `now`: when it is shown; captureTime: what the browser knows, if anything.
export function capturedAt(now, captureTime) {
  const age = now - captureTime;
  return age >= 0 && age < 1000 ? captureTime : now - LATENCY_MS;
}

export class Camera {
  /// `changed(state)`, see state.js; 'on' once there are pictures.  `picture(captured)` for each.
  constructor(video, { changed, picture }) {
    Object.assign(this, { video, changed, picture });
    this.state = 'off';
    this.turn = 0; // counts openings, so that what belongs to an earlier one is recognised
    this.seen = 0;
    this.last = ''; // the camera that was open, or is meant to be
    navigator.mediaDevices?.addEventListener('devicechange', () => this.#again(true));
  }

  /// Opens the camera with this id; '' for the one that looks away from the person, if there are two.
  async open(id) {
    this.#release();
    this.id = id;
    this.last = id || this.last;
    const turn = ++this.turn;
    if (!navigator.mediaDevices?.getUserMedia) return this.#set('insecure');
    this.#set('asking');
    const which = id ? { deviceId: { exact: id } } : { facingMode: { ideal: 'environment' } };
    try {
      const stream = await navigator.mediaDevices.getUserMedia({ audio: false, video: { ...WISHES, ...which } });
      if (turn === this.turn) await this.#show(stream, turn);
      else stream.getTracks().forEach((track) => track.stop());
    } catch (error) {
      if (turn === this.turn) this.#release(); // a stream that cannot be played keeps the camera from others
      if (turn === this.turn) this.#set(id && error?.name === 'OverconstrainedError' ? 'absent' : cameraStateOf(error));
      if (this.state === 'denied') this.#whenAllowed(turn);
    }
    return undefined;
  }

  /// Names the camera that is meant, while none is open; '' when it is not known yet which that will be.
  mean(id) { this.last = id; }

  close() {
    this.turn += 1;
    this.#release();
    this.#set('off');
  }

  /// To be called about once a second while this page is seen: notices a camera that stands still, and opens a lost one again.
  watch(now) {
    if (this.state === 'on' && now - this.seen > SILENT_MS) this.#set('silent');
    else this.#again(false, now);
  }

  /// After a pause in which no pictures could come.
  awake(now) { this.seen = now; }

  async list() {
    const all = (await navigator.mediaDevices?.enumerateDevices?.()) ?? [];
    return all.filter((device) => device.kind === 'videoinput' && device.deviceId).map(({ deviceId, label }, i) => ({ id: deviceId, label: label || `camera ${i + 1}` }));
  }

  label() { return this.stream?.getVideoTracks()[0]?.label ?? ''; }
  /// Of the open camera; else of the one before, or that is meant.
  device() { return this.stream ? this.stream.getVideoTracks()[0]?.getSettings().deviceId ?? '' : this.last; }
  opened() { return Boolean(this.stream); }
  size() { return { width: this.video.videoWidth, height: this.video.videoHeight }; }

  #set(state) {
    this.state = state;
    this.tried = performance.now();
    this.changed(state);
  }

  #again(plugged, now = performance.now()) {
    const missing = ['busy', 'lost', 'none', 'absent', 'silent'].includes(this.state);
    if (missing && (plugged || now - this.tried > AGAIN_MS)) this.open(this.id);
  }

  /// Opens it as soon as the person has changed his mind, in browsers that tell.
  async #whenAllowed(turn) {
    const permission = await navigator.permissions?.query({ name: 'camera' }).catch(() => null);
    permission?.addEventListener('change', () => {
      if (turn === this.turn && permission.state === 'granted') this.open(this.id);
    });
  }

  #release() {
    this.stream?.getTracks().forEach((track) => track.stop());
    this.stream = null;
    this.video.srcObject = null;
  }

  async #show(stream, turn) {
    this.stream = stream;
    stream.getVideoTracks()[0].addEventListener('ended', () => turn === this.turn && this.#set('lost'));
    this.video.srcObject = stream;
    await this.video.play();
    if (turn !== this.turn) return;
    this.last = this.device();
    this.seen = performance.now();
    this.#follow(turn);
    this.#set('on');
  }

  #follow(turn) {
    const took = (now, captureTime) => {
      this.seen = performance.now();
      if (this.state === 'silent') this.#set('on');
      this.picture(capturedAt(now, captureTime));
    };
    if (this.video.requestVideoFrameCallback) {
      const next = (now, { captureTime }) => {
        if (turn !== this.turn) return;
        this.video.requestVideoFrameCallback(next);
        took(now, captureTime);
      };
      this.video.requestVideoFrameCallback(next);
      return;
    }
    let last = -1;
    const look = () => {
      if (turn !== this.turn) return;
      if (this.video.currentTime !== last) took(performance.now(), NaN);
      last = this.video.currentTime;
      setTimeout(look, 15);
    };
    look();
  }
}
