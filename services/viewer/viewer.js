// The room as the fusion server knows it: each sensor's raw skeletons (faint), the fused ones (strong), frusta, floor.
// Polls only public resources: /frame, /sensors/, /sensors/{id}/frame, /registration.
import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

import { Resource, clock, follow, link } from './poll.js';
import { EllipsoidView, FusedView, RawView, frustum } from './skeleton_view.js';
import { jointLines } from './certainty.js';
import { showCoverage } from './coverage.js';
import { framing, roomOf } from './framing.js';
import { offerOrigin, watchOrigin } from './origin.js';
import { offerDecision, showProposal } from './proposal.js';
import { showFused, showPeople, showRegistration, showSensors, showState } from './panel.js';
import { Readout } from './readout.js';
import { OutputRate, OwnDelay, freshness, stateOf } from './state.js';

const COLORS = [0x4cc9f0, 0xf2b84b, 0x80ed99, 0xf28482, 0xb892ff, 0xffd6a5, 0x2ec4b6, 0xff9f1c, 0xa0c4ff, 0xcaffbf];
const MOVED = 0x7d3b38; // a sensor that does not stand where it was registered
const DEAD = 0x4a5260;
const RAW_EVERY_MS = 66;
const STATE_EVERY_MS = 200;
const base = new URL(new URLSearchParams(location.search).get('server') ?? '../', location.href);
const resource = (path, wait) => new Resource(new URL(path, base).href, wait);

/// What the page has shown so far, for tests and for curious people.
const shown = { fusedFrames: 0, fusedJoints: 0, ellipsoids: 0, rawBones: {}, sensors: 0, errors: 0 };
window.chorusViewer = shown;

// ---- the scene -----------------------------------------------------------------------------------------------
const canvas = document.getElementById('scene');
const renderer = new THREE.WebGLRenderer({ canvas, antialias: true });
renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
const scene = new THREE.Scene();
scene.background = new THREE.Color(0x0d1117);
scene.fog = new THREE.Fog(0x0d1117, 9, 22);
const camera = new THREE.PerspectiveCamera(45, 1, 0.05, 60);
const controls = new OrbitControls(camera, canvas);
controls.enableDamping = true;

scene.add(new THREE.HemisphereLight(0xffffff, 0x30363d, 1.6));
const sun = new THREE.DirectionalLight(0xffffff, 1.8);
sun.position.set(2, 5, 3);
scene.add(sun);
const grid = new THREE.GridHelper(12, 12, 0x55606e, 0x262d36);
scene.add(grid, new THREE.AxesHelper(0.4));

const fused = new FusedView();
const ellipsoids = new EllipsoidView();
scene.add(fused.object, ellipsoids.object);

/// Looks at the middle of the room once the sensors' places are known; people may turn the view afterwards.
function frameRoom(places) {
  const { centre, reach } = roomOf(places);
  controls.target.set(centre.x, 0.9, centre.z);
  camera.position.set(centre.x + reach * 1.15, 2.3 + reach * 0.45, centre.z + reach * 1.65);
  grid.position.set(Math.round(centre.x), 0, Math.round(centre.z));
}
frameRoom([]);

// ---- sensors -------------------------------------------------------------------------------------------------
const sensors = new Map();

function sensorView(id) {
  if (sensors.has(id)) return sensors.get(id);
  const color = COLORS[sensors.size % COLORS.length];
  const view = { id, color, raw: new RawView(color), place: new THREE.Group(), wedge: frustum(color), live: false };
  view.place.visible = false;
  view.place.add(view.wedge, view.raw.object);
  scene.add(view.place);
  sensors.set(id, view);
  follow(resource(`sensors/${id}/frame`), RAW_EVERY_MS, (frame) => showRaw(view, frame), () => view.raw.show([]));
  return view;
}

function showRaw(view, frame) {
  shown.rawBones[view.id] = view.raw.show(view.live ? frame.bodies ?? [] : []);
}

/// A sensor that delivers nothing is drawn in grey.
function paint(view, { state, alarm }) {
  const color = state === 'live' ? view.color : DEAD;
  view.wedge.traverse((part) => part.material?.color?.setHex(alarm ? MOVED : color));
}

let framedVersion = null;
function placeSensors(registration) {
  const places = Object.entries(registration.sensors ?? {}).filter(([, sensor]) => sensor.polled !== false);
  for (const view of sensors.values()) view.place.visible = false; // one that lost its place is drawn nowhere
  for (const [id, pose] of places) {
    const view = sensorView(id);
    view.place.position.set(pose.x, pose.y, pose.z);
    view.place.quaternion.set(pose.qx, pose.qy, pose.qz, pose.qw);
    view.place.visible = true;
  }
  if (places.length > 0 && framedVersion === null) {
    framedVersion = registration.version;
    frameRoom(places.map(([, pose]) => pose));
  }
}

// ---- following the server ------------------------------------------------------------------------------------
const known = { frame: null, rate: NaN, sensors: null, registration: null };

const outputRate = new OutputRate();

function failed() {
  shown.errors += 1;
}

follow(resource('frame', 10), 0, (frame) => {
  known.frame = frame;
  known.rate = outputRate.after(frame);
  shown.fusedJoints = fused.show(frame.bodies ?? []);
  shown.fusedFrames += 1;
  watchOrigin(frame);
}, failed);

follow(resource('sensors/'), 1000, ({ sensors: all }) => {
  known.sensors = all ?? {};
  for (const [id, state] of Object.entries(known.sensors)) {
    const view = sensorView(id);
    view.live = state.state === 'live';
    paint(view, state);
    if (!view.live) showRaw(view, { bodies: [] });
  }
  shown.sensors = sensors.size;
  showSensors(known.sensors, (id) => sensorView(id).color);
}, failed);

follow(resource('registration'), 1000, (registration) => {
  known.registration = registration;
  placeSensors(registration);
  showRegistration(registration);
  showProposal(registration.proposal);
  followSession(registration).catch(failed);
}, failed);

offerDecision((path) => new URL(path, base).href);
offerOrigin((path) => new URL(path, base).href);

/// The map of the walk, while a session runs.
let session = null;
async function followSession(registration) {
  const { state, progress } = registration.session ?? {};
  const runs = (state === 'collecting' || state === 'solving') && progress;
  if (!runs) session = null;
  else if (session?.path !== progress) session = { path: progress, resource: resource(progress.slice(1)) };
  const asked = session;
  const told = asked && await asked.resource.next();
  if (asked !== session || (asked && !told)) return; // the session has ended, or there is nothing new
  showCoverage(document.getElementById('coverage'), document.getElementById('pairs'), told, registration.sensors);
}

/// Checks the clock too, because frames that no longer arrive cannot say so themselves.
const ownDelay = new OwnDelay(STATE_EVERY_MS);
setInterval(() => {
  const held = ownDelay.late();
  const age = known.frame ? ageOf(known.frame) : NaN;
  const now = { ...known, link: link.state(), frameAge: age, held };
  const fresh = freshness(now);
  showState(stateOf(now), fresh);
  showPeople(switches.uncertainty.checked ? known.frame?.bodies ?? [] : []);
  showFused(fresh === 'gone' ? null : known.frame, fresh === 'live' ? known.rate : NaN, age);
  shown.fresh = fresh;
  if (fresh === 'gone' && known.frame) forget();
}, STATE_EVERY_MS);

/// Shows nothing of a server that no longer answers, except that its sensors exist.
function forget() {
  known.frame = null;
  shown.fusedJoints = fused.show([]);
  for (const view of sensors.values()) {
    view.live = false;
    showRaw(view, { bodies: [] });
  }
  const unknown = Object.keys(known.sensors ?? {}).map((id) => [id, { state: 'unknown' }]);
  showSensors(Object.fromEntries(unknown), (id) => sensorView(id).color);
  showRegistration({});
  showProposal(null);
}

// ---- drawing -------------------------------------------------------------------------------------------------
const switches = {
  raw: document.getElementById('show-raw'),
  frusta: document.getElementById('show-frusta'),
  fused: document.getElementById('show-fused'),
  uncertainty: document.getElementById('show-uncertainty'),
};
window.addEventListener('keydown', (event) => {
  if (event.key === 'u' && !event.ctrlKey && !event.metaKey && !event.altKey) switches.uncertainty.click();
});
const ageOf = (frame) => clock.now() - Date.parse(frame.captured);
const readout = new Readout(canvas, camera, document.getElementById('joint'),
  (body, name) => jointLines(body, name, ageOf(known.frame)));

/// Where a joint of the first person is on the screen [px].
shown.where = (name) => {
  const joint = known.frame?.bodies?.[0]?.joints?.[name];
  return joint && readout.toScreen(joint);
};

/// Ellipsoids and read-out of the newest frame, while somebody wants them.
function showUncertainty() {
  const bodies = switches.uncertainty.checked ? known.frame?.bodies ?? [] : [];
  fused.veil(switches.uncertainty.checked);
  shown.ellipsoids = ellipsoids.show(bodies);
  readout.show(bodies);
}

function fit() {
  renderer.setSize(window.innerWidth, window.innerHeight, false);
  camera.aspect = window.innerWidth / window.innerHeight;
  const { fov, left, top } = framing(window.innerWidth, window.innerHeight);
  camera.fov = fov;
  camera.setViewOffset(window.innerWidth, window.innerHeight, -left, -top, window.innerWidth, window.innerHeight);
  camera.updateProjectionMatrix();
}
window.addEventListener('resize', fit);
fit();

renderer.setAnimationLoop(() => {
  for (const view of sensors.values()) {
    view.raw.object.visible = switches.raw.checked;
    view.wedge.visible = switches.frusta.checked;
  }
  fused.object.visible = switches.fused.checked;
  showUncertainty();
  controls.update();
  renderer.render(scene, camera);
});
