// The cockpit: the room as the fusion server knows it, and everything that an operator does to it.
// Uses only public resources: /frame, /sensors/, /sensors/{id}/frame, /registration, /people/, /events, /setup,
// /recordings/.
import { jointLines } from './certainty.js';
import { History } from './curves.js';
import { Cockpit, wantedDrawer } from './panels/cockpit.js';
import { drawerOfKey } from './drawers.js';
import { html, render } from './panels/html.js';
import { watchOrigin } from './origin.js';
import { Player } from './player.js';
import { Resource, clock, follow as followForEver, link } from './poll.js';
import { Readout } from './readout.js';
import { judgedBones } from './judged.js';
import { askFor, requested, takeToken, tokenInUse } from './request.js';
import { Room } from './room.js';
import { stepOf } from './setup.js';
import { OutputRate, OwnDelay, frameOf, freshness, registrationOf, sensorsOf, stateOf, stateOfPlayback } from './state.js';

const LISTS_RECORDINGS = ['record', 'playback'];
const RAW_EVERY_MS = 66; // at the most often; with many sensors
const RAW_SHARE_MS = 16; // each has one turn in so many milliseconds, so that reading them leaves time for drawing
const RAW_HIDDEN_MS = 500;
const STATE_EVERY_MS = 200;
const query = new URLSearchParams(location.search);
const base = new URL(query.get('server') ?? '../', location.href);
const recordingOnly = query.has('only'); // `chorus view`: there is no room behind the recording
const follow = (...what) => { if (!recordingOnly) followForEver(...what); };
const resource = (path, wait, check) => new Resource(new URL(path, base).href, wait, check);
const UNREAD_AFTER = 3; // failures in a row

/// What the page has shown so far, for tests and for curious people.
const shown = { fusedFrames: 0, fusedJoints: 0, ellipsoids: 0, limbAxes: 0, rawBones: {}, sensors: 0, errors: 0, pictures: 0, paused: false };
window.chorusViewer = shown;

takeToken(location, history);
const room = new Room(document.getElementById('scene'), { coarsens: !query.has('still') });

/// All facts that the panels show.
const known = {
  frame: null, rate: NaN, sensors: null, registration: null, told: null, recordings: null, recordingsProblem: '', people: null, events: null, evaluation: null,
  site: null, setup: null, firstRun: false, originShown: false, playback: null, playbackProblem: '',
  history: new History(),
  state: { tone: 'warn', sentence: 'Connecting to the fusion server …', next: '' }, shownFrame: null, shownRate: NaN, age: NaN,
  drawer: null, dialog: null, asking: null,
  switches: { raw: true, frusta: true, fused: true, trails: true, uncertainty: false, axes: false },
};

// ---- the panels ----------------------------------------------------------------------------------------------
const root = document.getElementById('cockpit');
const broken = document.getElementById('broken');
root.replaceChildren();

function change(facts) {
  Object.assign(known, facts);
  try {
    render(html`<${Cockpit} known=${known} act=${act} />`, root);
    broken.hidden = true;
  } catch (error) { // never a green sentence of a page that stands still
    broken.hidden = false;
    broken.textContent = `This page cannot show what the server says (${error.message}). What it shows is old.`;
    shown.errors += 1;
  }
}

/// The panels leave the scene its part of the window; in a narrow one they stand below it (viewer.css).
function fit() {
  const box = (selector) => root.querySelector(selector).getBoundingClientRect();
  document.documentElement.style.setProperty('--below-header', `${box('header').bottom + 10}px`);
  document.documentElement.style.setProperty('--above-drawer', `${window.innerHeight - box('#drawer').top}px`);
  const beside = getComputedStyle(root.querySelector('#left')).position === 'fixed';
  room.fit(beside ? { left: box('#left').right, right: window.innerWidth - box('#right').left,
    top: box('header').bottom, bottom: window.innerHeight - box('#drawer').top } : {});
}

function setTheme(theme) {
  document.documentElement.dataset.theme = theme;
  room.paintGround(theme);
}
const themeNow = () => document.documentElement.dataset.theme ?? 'dark';

function openDrawer(drawer, toggle = true) {
  change({ drawer: toggle && known.drawer === drawer ? null : drawer });
  if (LISTS_RECORDINGS.includes(known.drawer)) followRecordings();
}

const act = {
  resource: (path) => new URL(path, base).href,
  colorOf: (id) => room.colorOf(id),
  token: tokenInUse,
  onDrawer: openDrawer,
  onOriginShown: () => change({ originShown: true }),
  onFirstRunDone: () => change({ firstRun: false }),
  playback: {
    only: recordingOnly,
    open: (name) => player.open(name),
    close: () => player.close(),
    toggle: () => player.playback?.toggle(),
    seek: (seconds) => player.playback?.seek(seconds),
    speed: (speed) => player.playback?.setSpeed(speed),
    again: () => player.outlineAgain(),
  },
  onDialog: (dialog) => change({ dialog }),
  onClose: () => change({ dialog: null }),
  onTheme: () => setTheme(themeNow() === 'dark' ? 'light' : 'dark'),
  onSwitch: (key, on) => change({ switches: { ...known.switches, [key]: on } }),
  onView: (from, which) => room.view(from, which),
  onPicture: () => {
    const download = document.createElement('a');
    Object.assign(download, { href: room.picture(), download: `chorus-${new Date().toISOString().replaceAll(':', '')}.png` });
    download.click();
  },
};

askFor((reason) => new Promise((resolve) => {
  change({ asking: { reason, answer: (token) => { change({ asking: null }); resolve(token); } } });
}));

/// A recording instead of the room as it is now.
const player = new Player(room, {
  fetchJson: async (path) => { // recordings show people: they may need a token that reading the present does not
    const { problem, body } = await requested(new URL(path, base).href, null, 'GET');
    if (problem) throw new Error(problem);
    return body;
  },
  onShown: (playback) => {
    const opened = Boolean(playback) !== Boolean(known.playback);
    change({ playback, ...(opened ? { drawer: 'playback', playbackProblem: '' } : {}),
      ...(recordingOnly ? { sensors: Object.fromEntries(playback.sensors.map((id) => [id, { state: 'recorded' }])) } : {}) });
    if (opened) judge();
    if (opened) followRecordings();
    if (!playback && known.registration) room.place(known.registration);
  },
  onFailed: (playbackProblem) => change({ playbackProblem, drawer: 'playback' }),
  onFrame: (frame) => showBodies(frame),
  onRaw: (id, frame) => showRaw(room.sensor(id), frame, true),
});

const typing = (target) => target instanceof HTMLElement && target.matches('input:not([type=checkbox]), select, textarea');
window.addEventListener('keydown', (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey || typing(event.target) || document.querySelector('dialog[open]')) return;
  const drawer = drawerOfKey(event.key, known, recordingOnly);
  if (drawer) openDrawer(drawer);
  else if (event.key === 'u') act.onSwitch('uncertainty', !known.switches.uncertainty);
  else if (event.key === 'i') act.onSwitch('axes', !known.switches.axes);
  else if (event.key === 'a') act.onView('above');
  else if (event.key === 'h') act.onView('room');
  else if (event.key === 't') act.onTheme();
  else if (event.key === '?') act.onDialog('keys');
  else if (event.key === ' ' && known.playback && event.target === document.body) act.playback.toggle();
  else if (event.key === 'Escape' && known.drawer) openDrawer(known.drawer);
});

// ---- following the server ------------------------------------------------------------------------------------
const outputRate = new OutputRate();
const failed = () => { shown.errors += 1; };
const followed = new Set();

function showRaw(view, frame, recorded = false) {
  if (Boolean(known.playback) !== recorded) return;
  shown.rawBones[view.id] = view.raw.show(view.live || recorded ? frame.bodies ?? [] : []);
}

function showBodies(frame) {
  shown.fusedJoints = room.fused.show(frame.bodies ?? []);
  room.trails.show(frame.bodies ?? [], performance.now());
  room.follow(frame.bodies ?? []);
  shown.fusedFrames += 1;
}

const rawPause = () => (known.switches.raw ? Math.max(RAW_EVERY_MS, RAW_SHARE_MS * room.sensors.size) : RAW_HIDDEN_MS);

function followRaw(id) {
  if (followed.has(id)) return;
  followed.add(id);
  const view = room.sensor(id);
  follow(resource(`sensors/${encodeURIComponent(id)}/frame`), rawPause, (frame) => showRaw(view, frame), () => view.raw.show([]));
}

const frames = resource('frame', 10, frameOf);
let cameAt = -Infinity; // [ms] by this page's own clock
follow(frames, 0, (frame) => {
  if (frame.captured !== known.frame?.captured) cameAt = performance.now();
  known.frame = frame;
  known.rate = outputRate.after(frame);
  if (!known.playback) showBodies(frame);
  watchOrigin(frame);
  known.history.take({ ...known, age: ageOf(frame) }, performance.now());
}, failed);

const sensorsNow = resource('sensors/', 0, sensorsOf);
follow(sensorsNow, 1000, ({ sensors: all }) => {
  for (const [id, state] of Object.entries(all)) {
    const view = room.sensor(id);
    view.live = state.state === 'live';
    room.paint(view, state);
    if (!view.live) showRaw(view, { bodies: [] });
    followRaw(id);
  }
  for (const view of room.sensors.values()) {
    if (Object.hasOwn(all, view.id)) continue;
    view.live = false; // taken out, or silenced
    showRaw(view, { bodies: [] });
    room.paint(view, {});
  }
  shown.sensors = room.sensors.size;
  const first = known.sensors === null && Object.keys(all).length === 0;
  change({ sensors: all, ...(first ? { firstRun: true, drawer: 'sensors' } : {}) });
}, failed);

const placesNow = resource('registration', 0, registrationOf);
follow(placesNow, 1000, (registration) => {
  if (!known.playback) room.place(registration);
  const wanted = wantedDrawer(registration);
  const opens = wanted && !wantedDrawer(known.registration) && !known.playback;
  const leads = known.firstRun && stepOf({ ...known, registration }) !== stepOf(known);
  change({ registration, ...(opens ? { drawer: wanted } : leads ? { drawer: stepOf({ ...known, registration }) ?? known.drawer } : {}) });
  followSession(registration).catch(failed);
}, failed);

// Who is called what, and what happened.
follow(resource('people/'), 1000, ({ people }) => change({ people }), failed);
follow(resource('events'), 1000, ({ events }) => change({ events }), failed);

// Sensors that were found, tried, silenced.
follow(resource('setup'), 1000, (setup) => change({ setup }), () => {}); // a server of an earlier version has none

// What is amiss with the service itself although it runs: its configuration, its outputs, its disk.
follow(resource('healthz'), 5000, ({ warning }) => change({ warning: warning ?? '' }), failed);

// Whether this tracker is a cell of a hall.
if (!recordingOnly) resource('configuration').next().then((told) => change({ site: told?.inForce?.site?.name || null })).catch(() => {}); // nobody may read it

// What worn sensors say of the tracker, where somebody judges it: of the bodies that are there now, not of recorded ones.
function judge() { room.fused.judged = known.evaluation && !known.playback ? judgedBones(known.evaluation) : new Map(); }
const JUDGED_EVERY_MS = 250;
const AXES_EVERY_MS = 66; // while the axes of limbs are drawn, which turn with the limbs
const judgedPause = () => (known.switches.axes ? AXES_EVERY_MS : JUDGED_EVERY_MS);
if (!recordingOnly) resource('').next().then((self) => {
  if (!self?.evaluation) return;
  follow(resource('evaluation'), judgedPause, (evaluation) => {
    change({ evaluation });
    judge();
  }, failed);
}).catch(() => {}); // a server of an earlier version

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
  change({ told });
}

/// The recordings, while somebody looks at them.
let recordingsFollowed = false;
async function followRecordings() {
  if (recordingsFollowed) return;
  recordingsFollowed = true;
  const list = resource('recordings/?limit=1000');
  while (LISTS_RECORDINGS.includes(known.drawer)) {
    const told = await list.next().catch((error) => ({ problem: `There are no recordings here: ${error.message}` }));
    if (told?.problem) change({ recordingsProblem: told.problem });
    else if (told) change({ recordings: Array.isArray(told.recordings) ? told.recordings : Object.values(told.recordings ?? {}), recordingsProblem: '' });
    await new Promise((resolve) => { setTimeout(resolve, 1000); });
  }
  recordingsFollowed = false;
}

/// Checks the clock too, because frames that no longer arrive cannot say so themselves.
const ownDelay = new OwnDelay(STATE_EVERY_MS);
const ageOf = (frame) => clock.now() - Date.parse(frame.captured);
setInterval(() => {
  const held = ownDelay.late();
  const age = known.frame ? ageOf(known.frame) : NaN;
  const unread = [['the sensors', sensorsNow], ['where the sensors stand', placesNow]].filter(([, { failures }]) => failures >= UNREAD_AFTER)
    .map(([what, { problem }]) => [what, problem]);
  // Its own clock counts too: a server may tell the time wrong, or not at all.
  const frameAge = known.frame ? Math.max(age || 0, performance.now() - cameAt) : NaN;
  const now = { ...known, link: link.state(), frameAge, frameProblem: frames.problem, unread, held };
  const ofTheRoom = freshness(now);
  const fresh = known.playback ? 'recorded' : ofTheRoom;
  const state = known.playback ? stateOfPlayback(known.playback, recordingOnly) : stateOf(now);
  document.body.dataset.fresh = fresh;
  document.title = state.tone === 'good' || state.tone === 'calm' ? 'Chorus cockpit' : `${state.sentence} – Chorus cockpit`;
  Object.assign(shown, { fresh, age });
  change({ state, sceneTrouble: room.trouble, age: known.playback ? NaN : age, shownFrame: known.playback ? player.frame : fresh === 'gone' ? null : known.frame, shownRate: fresh === 'live' ? known.rate : NaN });
  if (fresh === 'gone' && known.frame) forget();
  // Without a current frame nobody is anywhere and nothing is judged; sensors are as a server says that answers.
  if (ofTheRoom !== 'live') known.history.take({ age, sensors: now.link.error ? null : known.sensors }, performance.now());
}, STATE_EVERY_MS);

/// Shows nothing of a server that no longer answers, except that its sensors exist.
function forget() {
  shown.fusedJoints = room.fused.show([]);
  room.trails.clear();
  for (const view of room.sensors.values()) {
    view.live = false;
    showRaw(view, { bodies: [] });
  }
  const unknown = Object.keys(known.sensors ?? {}).map((id) => [id, { state: 'unknown' }]);
  room.fused.judged = new Map();
  change({ frame: null, sensors: Object.fromEntries(unknown), registration: null, evaluation: null, told: null, people: null });
}

// ---- drawing -------------------------------------------------------------------------------------------------
const shownFrame = () => (known.playback ? player.frame : known.frame);
const readout = new Readout(room.canvas, room.camera, document.getElementById('joint'),
  (body, name) => jointLines(body, name, known.playback ? NaN : ageOf(known.frame)));

/// Where a joint of the first person is on the screen [px].
shown.where = (name) => {
  const joint = shownFrame()?.bodies?.[0]?.joints?.[name];
  return joint && readout.toScreen(joint);
};

let limbAxes = null; // loaded when somebody wants them
let limbAxesAsked = false;

async function loadLimbAxes() {
  limbAxesAsked = true;
  try {
    const { LimbAxesView } = await import('./axes_view.js');
    limbAxes = new LimbAxesView();
    room.scene.add(limbAxes.object);
  } catch { // the server does not answer
    setTimeout(() => { limbAxesAsked = false; }, 1000);
  }
}

/// The axes of judged limbs in both worlds, while somebody wants them; a recording has none.
function showLimbAxes() {
  const wanted = known.switches.axes && !known.playback && known.evaluation;
  if (wanted && !limbAxesAsked) loadLimbAxes();
  if (limbAxes) shown.limbAxes = limbAxes.show(known.frame?.bodies ?? [], wanted ? known.evaluation : null);
}

/// Ellipsoids and read-out of the newest frame, while somebody wants them.
function showUncertainty() {
  const bodies = known.switches.uncertainty ? shownFrame()?.bodies ?? [] : [];
  room.fused.veil(known.switches.uncertainty);
  shown.ellipsoids = room.ellipsoids.show(bodies);
  readout.show(bodies);
}

window.addEventListener('resize', fit);
setTheme(window.matchMedia('(prefers-color-scheme: light)').matches ? 'light' : 'dark');
change({});
const sizes = new ResizeObserver(fit);
for (const part of ['header', '#drawer']) sizes.observe(root.querySelector(part));
fit();

if (query.has('recording')) player.open(query.get('recording'), Number(query.get('at') ?? 0));

room.renderer.setAnimationLoop(() => {
  if (shown.paused) return;
  showUncertainty();
  showLimbAxes();
  room.draw(known.switches);
  shown.pictures += 1;
});
