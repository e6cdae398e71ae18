// Makes the camera of this device a sensor: looks for people in its pictures and pushes their landmarks to the sensor that serves this page.
import { Awake } from './awake.js';
import { Camera } from './camera.js';
import { USUAL_VIEW, lensOfCalibration, lensOfView, readCalibration, sentSize, viewOf } from './lens.js';
import { HOPELESS, Link, atTheDoor } from './link.js';
import { Looker } from './looker.js';
import { Overlay } from './overlay.js';
import { adoptLens, fromLink, load, loadToken, save, saveToken } from './settings.js';
import { Pace, stateOf } from './state.js';

const ROOT = new URL('../', location.href);
const SHOW_EVERY_MS = 250;
const COMPLAINT_MS = 5000;
const ASLEEP_MS = 3000; // no timer is that late unless the device slept
const HIDDEN_MS = 5 * 60 * 1000; // so long a hidden page keeps its camera

const element = (id) => document.getElementById(id);
const settings = load();
const brought = fromLink(location.hash);
history.replaceState(null, '', location.pathname); // a token does not stay in the address
Object.assign(settings, brought.model && { model: brought.model }, brought.rate && { rate: brought.rate });
let token = brought.token ?? loadToken();
saveToken(token);

/// What stateOf() is told; also for tests and for curious people.
const known = {
  running: false, hidden: document.hidden, slept: 0, camera: { state: 'off' }, model: { state: 'off', detail: '' },
  link: { state: 'connecting', detail: '' }, lens: '', people: null, rate: 0, age: NaN, sent: 0, complaint: '',
};
window.chorusCapture = known;

const overlay = new Overlay(element('overlay'));
const canvas = document.createElement('canvas');
const pencil = canvas.getContext('2d', { willReadFrequently: true });
const camera = new Camera(element('video'), { changed: cameraChanged, picture: (captured) => onPicture(captured) });
let pace = new Pace();
let looker = null;
let link = null;
let said = {}; // the hello that the sensor has
let complained = 0;
let looked = 0;
let hidSince = performance.now();
const awake = new Awake();

// ---- pictures ------------------------------------------------------------------------------------------------
function grabbed(sent) {
  if (canvas.width !== sent.width || canvas.height !== sent.height) Object.assign(canvas, sent);
  pencil.imageSmoothingQuality = 'high';
  pencil.drawImage(element('video'), 0, 0, sent.width, sent.height);
  return pencil.getImageData(0, 0, sent.width, sent.height);
}

async function onPicture(captured) {
  const now = performance.now();
  if (!known.running || known.hidden || !looker?.free() || now - looked < 1000 / settings.rate - 4) return;
  looked = now;
  const [looking, picture] = [looker, camera.size()];
  const sent = sentSize(picture, looking.hello.image.maxSide);
  const bodies = await looking.look(grabbed(sent), captured);
  if (!bodies || looking !== looker || !known.running || known.hidden) return;
  known.people = bodies.length;
  overlay.show(bodies, sent, looking.hello.layout);
  if (!introduce(picture, sent) || !link.push(bodies, captured)) return;
  known.sent += 1;
  pace.note(performance.now(), performance.now() - captured);
}

// ---- the lens, and what the sensor is told of it -------------------------------------------------------------------
const ownLens = () => settings.lenses[camera.device()] ?? USUAL_VIEW;

function lensFor(picture, sent) {
  const own = ownLens();
  return own.calibration ? lensOfCalibration(own.calibration, picture, sent) : lensOfView(own, sent);
}

/// Connects, and says hello again if anything about it has changed.  False when the lens does not fit the picture.
function introduce(picture, sent) {
  const lens = triedLens(picture, sent);
  if (!lens || HOPELESS.includes(known.link.state)) return false;
  const { image, name, ...model } = looker.hello;
  const label = camera.label().replace(/[^ -~]/g, '').trim() || 'a camera';
  const hello = { ...model, name: `${label}, ${name}`.slice(0, 64), ...lens };
  if (said.name !== hello.name) disconnect(); // a connection keeps its name
  if (link && JSON.stringify(said) !== JSON.stringify(hello)) link.say(hello);
  said = hello;
  link ??= new Link({ root: ROOT, token, hello, changed: linkChanged, complain });
  return true;
}

function triedLens(picture, sent) {
  known.lens = '';
  try {
    return lensFor(picture, sent);
  } catch (error) {
    known.lens = `${error.message} Turn the device, or forget the calibration below.`;
    return null;
  }
}

function linkChanged(state) {
  known.link = state;
  if (state.sensor) element('sensor').textContent = state.sensor;
  if (HOPELESS.includes(state.state)) disconnect();
  show();
}

function complain(text) {
  known.complaint = text;
  complained = performance.now();
}

function disconnect() {
  link?.close();
  link = null;
  pace = new Pace();
}

/// Asks the sensor whether it would let us in, before megabytes are loaded for it.
async function ask() {
  const asked = token;
  const door = await atTheDoor(ROOT, asked);
  if (asked === token && HOPELESS.includes(door.state)) linkChanged(door);
}

// ---- starting, stopping, sleeping ---------------------------------------------------------------------------------
function startLooking() {
  looker?.end();
  known.people = null;
  looker = new Looker(settings.model, (state) => { known.model = state; show(); });
}

function start() {
  Object.assign(known, { running: true, slept: 0, complaint: '', link: { state: 'connecting', detail: '' } });
  element('settings').open = false;
  ask();
  startLooking();
  camera.open(settings.camera);
  awake.ask();
  show();
}

function stop() {
  known.running = false;
  disconnect();
  looker?.end();
  looker = null;
  camera.close();
  awake.end();
  overlay.show();
  show();
}

/// A hidden page gets no pictures, and a sensor should not wait for it: leaves, and comes back with the page.
function visibilityChanged() {
  known.hidden = document.hidden;
  hidSince = ticked = performance.now(); // timers of a hidden page are late: that is no sleep
  if (!known.running) return;
  if (known.hidden) {
    disconnect();
    overlay.show();
    known.link = HOPELESS.includes(known.link.state) ? known.link : { state: 'connecting', detail: '' };
  } else {
    if (camera.state === 'off') camera.open(settings.camera);
    camera.awake(performance.now());
    awake.ask();
  }
  show();
}

function cameraChanged(state) {
  known.camera = { state };
  if (state === 'on' && adoptLens(settings.lenses, camera.device())) save(settings);
  if (state !== 'on') overlay.show();
  if (state === 'on') listCameras().then(showLens);
  show();
}

let ticked = performance.now();
function tick() {
  const now = performance.now();
  if (known.running && !known.hidden && now - ticked > ASLEEP_MS) {
    known.slept = (now - ticked) / 1000;
    camera.awake(now);
  }
  ticked = now;
  if (known.complaint && now - complained > COMPLAINT_MS) known.complaint = '';
  Object.assign(known, pace.at(now));
  if (known.running && !known.hidden) camera.watch(now);
  if (known.running && known.hidden && camera.opened() && now - hidSince > HIDDEN_MS) camera.close();
  show();
}

// ---- showing ---------------------------------------------------------------------------------------------------------
function show() {
  const { tone, sentence, next } = stateOf(known);
  const [headline, more] = [element('headline'), element('next')];
  if (headline.textContent !== sentence) headline.textContent = sentence;
  headline.className = tone;
  if (more.textContent !== next) more.textContent = next;
  document.title = known.running ? `${sentence} – Chorus camera` : 'Chorus camera';
  document.body.dataset.running = known.running ? 'yes' : 'no';
  document.body.dataset.wants = HOPELESS.includes(known.link.state) && known.running ? 'token' : '';
  element('run').textContent = known.running ? 'Stop' : 'Start';
  element('token-section').hidden = known.running && known.link.state === 'welcomed';
  element('idle').hidden = known.camera.state === 'on';
  const live = known.running && known.rate > 0;
  const { width, height } = camera.size();
  element('people').textContent = live ? known.people : '–';
  element('rate').textContent = live ? `${known.rate.toFixed(1)} Hz` : '–';
  element('latency').textContent = live ? `${known.age.toFixed(0)} ms` : '–';
  element('size').textContent = width > 0 && known.running ? `${width} x ${height}` : '–';
}

async function listCameras() {
  const cameras = await camera.list();
  const options = cameras.filter((one) => one.label).map(({ id, label }) => new Option(label, id));
  element('camera').replaceChildren(new Option('the one that looks away from you', ''), ...options);
  element('camera').value = cameras.some((one) => one.id === settings.camera) ? settings.camera : '';
}

function showLens(problem = '') {
  const own = ownLens();
  const { width, height } = own.calibration ?? {};
  element('fov').value = own.fov ?? USUAL_VIEW.fov;
  element('sigma').value = own.sigma ?? USUAL_VIEW.sigma;
  element('fov').disabled = element('sigma').disabled = Boolean(own.calibration);
  element('uncalibrate').hidden = !own.calibration;
  element('seen').className = problem ? 'bad' : '';
  const calibrated = own.calibration && `Calibrated for pictures of ${width} x ${height}: it sees ${viewOf(own.calibration)}.`;
  element('seen').textContent = problem || calibrated || 'Of the longer side, not the diagonal. What is uncertain here is told with each ray.';
}

// ---- controls --------------------------------------------------------------------------------------------------------
function remember(change) {
  Object.assign(settings, change);
  save(settings);
}

function rememberLens(lens) {
  settings.lenses[camera.device()] = lens;
  save(settings);
  showLens();
}

function onChange(id, take) {
  element(id).addEventListener('change', () => take(element(id).value));
}

onChange('camera', (value) => {
  remember({ camera: value });
  camera.mean(value);
  if (known.running) camera.open(value);
  showLens();
});
onChange('model', (value) => { remember({ model: value }); if (known.running) startLooking(); });
onChange('pace', (value) => remember({ rate: Number(value) }));
onChange('token', (value) => {
  token = value.trim();
  saveToken(token);
  disconnect();
  known.link = { state: 'connecting', detail: '' };
  if (known.running) ask();
});
for (const id of ['fov', 'sigma']) {
  onChange(id, () => {
    const fov = Number(element('fov').value);
    if (fov >= 20 && fov <= 150) rememberLens({ fov, sigma: Number(element('sigma').value) });
    else showLens('A field of view is from 20 to 150 degrees.');
  });
}
element('calibration').addEventListener('change', async () => {
  const [file] = element('calibration').files;
  try {
    if (file) rememberLens({ calibration: readCalibration(await file.text()) });
  } catch (error) {
    showLens(error.message);
  }
  element('calibration').value = '';
});
element('uncalibrate').addEventListener('click', () => rememberLens({ ...USUAL_VIEW }));
element('run').addEventListener('click', () => (known.running ? stop() : start()));
document.addEventListener('visibilitychange', visibilityChanged);
window.addEventListener('hashchange', () => location.reload()); // a link that is opened where the page is already: its token is taken, and leaves the address
window.addEventListener('pagehide', () => known.running && disconnect());
setInterval(tick, SHOW_EVERY_MS);

element('model').value = settings.model;
element('pace').value = String(settings.rate);
element('token').value = token;
element('run').disabled = false;
camera.mean(settings.camera);
showLens();
show();
if (brought.start) start();
