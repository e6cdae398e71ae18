// The camera of the capture page, with a browser that is made up: what is refused, plugged in, lost, or comes too late.
import assert from 'node:assert/strict';
import { beforeEach, test } from 'node:test';

import { Camera } from '../../services/capture/camera.js';

class Track extends EventTarget {
  constructor(label) {
    super();
    Object.assign(this, { label, stopped: false });
  }

  stop() { this.stopped = true; }
  getSettings() { return { deviceId: `id of ${this.label}` }; }
}
const streamOf = (track) => ({ getTracks: () => [track], getVideoTracks: () => [track] });
const refused = (name) => async () => { throw Object.assign(new Error('no'), { name }); };
const settle = () => new Promise((resolve) => setImmediate(resolve));

let devices; // navigator.mediaDevices
let states;
let pictures;
let video;
beforeEach(() => {
  devices = new EventTarget();
  Object.defineProperty(globalThis, 'navigator', { configurable: true, value: { mediaDevices: devices } });
  [states, pictures] = [[], []];
  video = { play: async () => {}, requestVideoFrameCallback: (next) => { video.next = next; }, videoWidth: 640, videoHeight: 360 };
});
const made = () => new Camera(video, { changed: (state) => states.push(state), picture: (captured) => pictures.push(captured) });

test('a camera is asked for by its id, without sound, and never cut by the browser', async () => {
  const track = new Track('door');
  const asked = [];
  devices.getUserMedia = async (wishes) => { asked.push(wishes); return streamOf(track); };
  const camera = made();
  await camera.open('c1');
  assert.deepEqual(states, ['asking', 'on']);
  assert.equal(asked[0].audio, false);
  assert.deepEqual(asked[0].video.deviceId, { exact: 'c1' });
  assert.deepEqual(asked[0].video.resizeMode, { ideal: 'none' });
  video.next(500, { captureTime: 450 });
  assert.deepEqual(pictures, [450]);
  assert.deepEqual([camera.label(), camera.device()], ['door', 'id of door']);
  camera.close();
  assert.ok(track.stopped && video.srcObject === null);
  video.next(600, { captureTime: 550 });
  assert.deepEqual(pictures, [450], 'nothing after it is closed');
});

test('a page that is not secure has no camera', async () => {
  Object.defineProperty(globalThis, 'navigator', { configurable: true, value: {} });
  await made().open('');
  assert.deepEqual(states, ['insecure']);
});

test('who refuses is not asked again; what is missing is opened when it is plugged in', async () => {
  devices.getUserMedia = refused('NotAllowedError');
  const camera = made();
  await camera.open('');
  camera.watch(performance.now() + 60000);
  devices.dispatchEvent(new Event('devicechange'));
  await settle();
  assert.deepEqual(states, ['asking', 'denied']);
  devices.getUserMedia = refused('OverconstrainedError');
  await camera.open('c1');
  assert.equal(states.at(-1), 'absent');
  devices.getUserMedia = async () => streamOf(new Track('door'));
  devices.dispatchEvent(new Event('devicechange'));
  await settle();
  assert.equal(states.at(-1), 'on');
});

test('a camera that is allowed after all is opened', async () => {
  const permission = Object.assign(new EventTarget(), { state: 'denied' });
  const permissions = { query: async ({ name }) => { assert.equal(name, 'camera'); return permission; } };
  Object.defineProperty(globalThis, 'navigator', { configurable: true, value: { mediaDevices: devices, permissions } });
  devices.getUserMedia = refused('NotAllowedError');
  await made().open('');
  await settle();
  devices.getUserMedia = async () => streamOf(new Track('door'));
  permission.state = 'granted';
  permission.dispatchEvent(new Event('change'));
  await settle();
  assert.deepEqual(states, ['asking', 'denied', 'asking', 'on']);
});

test('a lost camera is told, then opened again every two seconds', async () => {
  const track = new Track('door');
  devices.getUserMedia = async () => streamOf(track);
  const camera = made();
  await camera.open('');
  track.dispatchEvent(new Event('ended'));
  assert.equal(states.at(-1), 'lost');
  devices.getUserMedia = refused('NotReadableError');
  const now = performance.now();
  camera.watch(now + 1000);
  assert.equal(states.at(-1), 'lost', 'long enough to be read');
  camera.watch(now + 2500);
  await settle();
  assert.equal(states.at(-1), 'busy');
});

test('a camera that stands still is opened anew, but not one whose page was hidden', async () => {
  devices.getUserMedia = async () => streamOf(new Track('door'));
  const camera = made();
  await camera.open('');
  const now = performance.now();
  camera.awake(now + 60000);
  camera.watch(now + 61000);
  assert.equal(camera.state, 'on');
  camera.watch(now + 64000);
  assert.equal(states.at(-1), 'silent');
});

test('a camera that opens after another was chosen is let go', async () => {
  const [late, door] = [new Track('late'), new Track('door')];
  let deliver;
  devices.getUserMedia = () => new Promise((resolve) => { deliver = () => resolve(streamOf(late)); });
  const camera = made();
  const first = camera.open('c1');
  devices.getUserMedia = async () => streamOf(door);
  await camera.open('c2');
  deliver();
  await first;
  assert.ok(late.stopped && !door.stopped);
  assert.equal(camera.label(), 'door');
});

test('which camera a lens belongs to is known while none is open', async () => {
  devices.getUserMedia = async () => streamOf(new Track('door'));
  const camera = made();
  assert.equal(camera.device(), '');
  camera.mean('c1');
  assert.equal(camera.device(), 'c1', 'chosen, but not opened');
  camera.mean('');
  await camera.open('');
  camera.close();
  assert.equal(camera.device(), 'id of door', 'the one that was open');
  devices.getUserMedia = refused('OverconstrainedError');
  await camera.open('c2');
  assert.equal(camera.device(), 'c2', 'the one that is waited for');
});

test('a camera whose pictures cannot be shown is let go', async () => {
  const track = new Track('door');
  devices.getUserMedia = async () => streamOf(track);
  video.play = refused('AbortError');
  const camera = made();
  await camera.open('');
  assert.equal(states.at(-1), 'busy');
  assert.ok(track.stopped && !camera.opened());
});

test('a camera that is closed before its first picture stays closed', async () => {
  let shown;
  video.play = () => new Promise((resolve) => { shown = resolve; });
  devices.getUserMedia = async () => streamOf(new Track('door'));
  const camera = made();
  const opening = camera.open('');
  await settle();
  camera.close();
  shown();
  await opening;
  assert.deepEqual(states, ['asking', 'off']);
});
