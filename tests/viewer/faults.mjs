// Faults of the server, the network and the browser, as one list: what the page says of each, that it is never green meanwhile, never a
// frozen picture in colours, that no markup is executed, that keys still work, and that it goes on by itself when the fault is over.
// It takes minutes, so it runs at night (tests/run.sh --nightly).
import assert from 'node:assert/strict';
import { mkdirSync } from 'node:fs';
import { after, before, describe, test } from 'node:test';
import { fileURLToPath } from 'node:url';

import { PATIENCE_MS, launch } from './browser.mjs';
import { SENSORS, live, startFakeFusion, usualWorld } from './fake_fusion.mjs';

const FILES = fileURLToPath(new URL('../../services/viewer/', import.meta.url));
const PICTURES = process.env.CHORUS_SCREENSHOTS;
const MARKUP = '<img src=x onerror="window.hacked=1"><script>window.hacked=1</script>';
const HOUR_MS = 3600000;
let browser;
before(async () => {
  browser = await launch();
  if (PICTURES) mkdirSync(PICTURES, { recursive: true });
});
after(() => browser?.close());

// ---- what can be planted ---------------------------------------------------------------------------------------
const pathOf = (request) => new URL(request.url, 'http://localhost').pathname;
/// Every answer (or those of one path) has this status and text.
const answers = (status, text, only = null, type = 'application/json') => (world) => {
  world.fault = (request, response) => {
    if (only && !only.test(pathOf(request))) return false;
    response.writeHead(status, { 'Content-Type': type }).end(text);
    return true;
  };
};
const tells = (path, alter) => (world) => { world.told = { ...world.told, [path]: alter }; };
const detail = (text) => JSON.stringify({ detail: text });
const later = (ms) => new Promise((resolve) => { setTimeout(resolve, ms); });
const pressed = (name) => async (page) => { await page.getByRole('button', { name, exact: true }).click(); };
const opened = (letter) => (page) => page.keyboard.press(letter);
const record = [opened('e'), pressed('Record')];
const recording = (name, more = {}) => ({ name, state: 'finished', started: '2026-11-27T09:00:00Z', frames: 600, bytes: 1500000, dropped: 0, files: [`/recordings/${name}/a.mcap`], ...more });
const outline = { name: 'walk', seconds: 20, started: '2026-11-27T09:00:00Z', fused: true, sensors: ['s1'], registrations: [{ seconds: 0, registration: { sensors: SENSORS } }], notes: [], marks: [] };
const recorded = (world) => Object.assign(world, { recordings: [recording('walk')], outlines: { walk: outline } });
const warning = (id, message) => ({ eventId: id, time: '2026-11-27T10:00:00Z', kind: 'x', severity: 'warning', message });

const everyJoint = (value) => (frame) => ({ ...frame, bodies: frame.bodies.map((body) => ({ ...body,
  joints: Object.fromEntries(Object.entries(body.joints).map(([name, joint], i) => [name, i % 2 ? joint : value(joint)])) })) });
const many = (count) => (frame) => ({ ...frame, bodies: Array.from({ length: count }, (_, i) => ({ ...frame.bodies[0], bodyId: i + 1 })) });

/// Keeps a server from being looked at as alive.
const NOT_LIVE = /^(?!Live)/;
const LIVE = /^Live: one person, 2 sensors\.$/;

/// plant: before the page is loaded, if `early`, else while it is live.  says: the sentence at the top, or, with `where`, what a part of the
/// page holds.  green: the tracker is well, so the sentence may stay green.  steps: what is done on the page then.  check: what else holds.
/// init: runs in the page before all else.  heals: false when the fault stays.
const FAULTS = {
  'a server that was killed': { plant: (world, server) => server.stop(), says: /^The fusion server has not answered for \d+ s/, heals: false },
  'a server that takes connections and never answers': { plant: (world) => { world.silent = true; }, says: /^The fusion server has not answered for \d+ s/ },
  'a server that never answered': { early: true, plant: (world) => { world.silent = true; }, says: /does not answer/ },
  'connections that are reset': { plant: (world) => { world.fault = (request) => { request.socket.destroy(); return true; }; }, says: /has not answered for/ },
  'every second connection is reset': {
    plant: (world) => { let count = 0; world.fault = (request) => { count += 1; if (count % 2) request.socket.destroy(); return count % 2 === 1; }; },
    says: /./, green: true, check: (page, world, { framesAfter }) => framesAfter(20),
  },
  'answers that take two seconds': { plant: (world) => { world.fault = async () => { await later(2000); return false; }; }, says: NOT_LIVE },
  'an answer that stops in the middle': {
    plant: (world) => { world.fault = (request, response) => { response.writeHead(200, { 'Content-Type': 'application/json', 'Content-Length': 5000 }); response.write('{"sequence":'); setTimeout(() => request.socket.destroy(), 50); return true; }; },
    says: /^The fusion server (gives no frames: its answer cannot be read|has not answered)/,
  },
  'a server that starts anew below the page': {
    plant: (world) => { world.told = { '/frame': (frame) => ({ ...frame, sequence: frame.sequence % 1000 }) }; Object.assign(world.registration, { version: 0, verdict: 'None', sensors: {} }); },
    says: /^It is not known yet where the sensors stand/, heal: (world) => { Object.assign(world.registration, { verdict: 'Good', sensors: SENSORS }); },
  },
  '500 with HTML': { plant: answers(500, '<h1>oops</h1>', null, 'text/html'), says: /gives no frames: it answered 500\.$/ },
  '503 with a reason': { plant: answers(503, detail('too many readers')), says: /gives no frames: it answered 503: too many readers\.$/ },
  '401 while it is looked at': { plant: answers(401, detail('a token is needed')), says: /gives no frames: it asks for a token\.$/, check: async (page) => assert.match(await page.textContent('#next'), /as the password/) },
  '404 from the beginning': { early: true, plant: answers(404, ''), says: /gives no frames: it answered 404\.$/ },
  'the login page of a proxy in place of JSON': { plant: answers(200, '<html><body>Welcome</body></html>', null, 'text/html'), says: /gives no frames: its answer cannot be read\.$/ },
  'broken JSON': { plant: tells('/frame', () => '{"bodies":['), says: /gives no frames: its answer cannot be read/ },
  'a frame that is null, a list, or of another kind': {
    plant: (world) => { let count = 0; tells('/frame', () => ['null', '[]', '42', '{"bodies":7,"sequence":"x"}'][(count += 1) % 4])(world); }, says: /gives no frames: what it calls a frame is none/,
  },
  'frames that stand still': { plant: (world) => { world.frozen = true; }, says: /^The fused output has stood still for \d+ s/, heal: (world) => { world.frozen = false; } },
  'frames that stand still and are dated an hour ahead': {
    plant: (world) => { const told = {}; tells('/frame', (frame) => { told.captured ??= new Date(Date.now() + 3 * HOUR_MS).toISOString(); return { ...frame, captured: told.captured }; })(world); }, says: /has stood still for/,
  },
  'frames of an hour ago': { plant: tells('/frame', (frame) => ({ ...frame, captured: new Date(Date.parse(frame.captured) - HOUR_MS).toISOString() })), says: /has stood still for 3600 s/ },
  'frames without a time': { plant: tells('/frame', ({ captured, ...frame }) => frame), says: /what it calls a frame is none/ },
  'a clock of the server that is set back by an hour': { // the fake server's clock is an hour ahead
    plant: (world) => { world.clockSetBack = HOUR_MS; }, says: /./, green: true, check: (page, world, { sentence }) => sentence(LIVE), heals: false },
  'a server that does not tell its time, and stands still': { early: true, plant: (world) => { world.noClock = true; }, says: LIVE, green: true,
    check: async (page, world, { sentence, notGreen }) => { world.frozen = true; await sentence(/has stood still for/); await notGreen(); }, heal: (world) => { world.frozen = false; } },
  'frames of 2 MB': { plant: tells('/frame', (frame) => ({ ...frame, padding: 'x'.repeat(2_000_000) })), says: LIVE, green: true, check: (page, world, { framesAfter }) => framesAfter(10) },
  'two thousand people': { plant: tells('/frame', many(2000)), says: /^Live: 2000 people/, green: true, check: (page) => page.getByText('and 1936 more, who are not shown').waitFor() },
  'joints without places, with text, and beyond all rooms': {
    plant: tells('/frame', everyJoint((joint) => ({ ...joint, x: null, y: '7', z: 1e300 }))), says: LIVE, green: true,
    check: (page) => page.waitForFunction(() => window.chorusViewer.fusedJoints > 5 && window.chorusViewer.fusedJoints < 20),
  },
  'joints and bodies that are null': { plant: tells('/frame', (frame) => ({ ...frame, bodies: [null, 7, { bodyId: 9 }, { ...frame.bodies[0], joints: { ...frame.bodies[0].joints, Head: null } }] })), says: LIVE, green: true },
  'sensors that answer 500': { plant: answers(500, detail('broke down'), /^\/sensors\/$/), says: /^The fusion server says nothing of the sensors: it answered 500: broke down\.$/ },
  'sensors that are no list': { plant: tells('/sensors/', () => '{"sensors":"none"}'), says: /says nothing of the sensors: what it says cannot be read/ },
  'a registration of another kind': { plant: tells('/registration', () => '{"verdict":"Good","reasons":"all well"}'), says: /says nothing of where the sensors stand: what it says cannot be read/ },
  'judgements that are none': {
    early: true, plant: (world) => { let count = 0; world.evaluation = { limbs: [] }; tells('/evaluation', () => [{ limbs: {} }, { limbs: 'x' }, { limbs: [null] }][(count += 1) % 3])(world); }, says: LIVE, green: true,
    steps: [opened('c'), (page) => page.getByRole('combobox', { name: 'of the last minute' }).selectOption('height')],
    check: async (page, world, { framesAfter }) => { await framesAfter(20); await page.getByText('person 1 1.66 m').waitFor(); },
  },
  'places that are no numbers': { plant: tells('/registration', (told) => ({ ...told, sensors: { s1: { ...SENSORS.s1, x: null }, s2: { ...SENSORS.s2, qw: 'one' } } })), says: LIVE, green: true, check: (page, world, { framesAfter }) => framesAfter(10) },
  'facts that the panels cannot show': { plant: (world) => { world.events = { 0: null, length: 1 }; }, says: /./, green: true, check: (page) => page.getByText('cannot show what the server says').waitFor(), heal: (world) => { world.events = []; } },
  'a hundred sensors, some with names of JavaScript': {
    plant: (world) => { for (const name of ['constructor', '__proto__', 'toString', ...Array.from({ length: 97 }, (_, i) => `n${i}`)]) Object.defineProperty(world.sensors, name, { value: live(), enumerable: true, configurable: true, writable: true }); },
    says: /^Live: one person, 102 sensors\.$/, green: true,
    check: async (page) => assert.equal(await page.textContent('[data-sensor=constructor] [data-fact=place]'), 'none', 'it has no place because an object has a constructor'),
    heal: (world) => { world.sensors = { s1: live(), s2: live() }; },
  },
  'markup in every text': {
    plant: (world) => {
      world.sensors = { s1: live(), [MARKUP]: live({ lastError: MARKUP, url: `javascript:${MARKUP}` }), s2: live({ alarm: MARKUP }) };
      world.registration.alarms = [`${MARKUP}; ${MARKUP}`];
      world.known = { 1: { personId: '1', name: MARKUP } };
      world.events = [warning('1', MARKUP)];
      world.health = { status: 'degraded', warning: MARKUP };
      world.recordings = [recording(MARKUP), recording('../../etc/passwd'), recording('x'.repeat(300))];
      world.evaluation = { limbs: [{ bodyId: 1, limb: MARKUP, state: 'off', comment: MARKUP }] };
    },
    says: /<img src=x/, steps: [opened('e'), (page) => page.getByText('../../etc/passwd').waitFor()],
    heal: (world) => Object.assign(world, { sensors: { s1: live(), s2: live() }, registration: { ...world.registration, alarms: [] }, known: {}, events: [], health: { status: 'ok' }, recordings: [] }),
  },
  'ten thousand events that nobody has seen, without times': {
    plant: (world) => { world.events = Array.from({ length: 10000 }, (_, i) => ({ ...warning(String(i), `event ${i}`), time: 'yesterday' })); }, says: LIVE, green: true,
    check: async (page) => { await page.getByText('10000 unseen').waitFor(); assert.equal(await page.locator('#events li').count(), 100); }, heal: (world) => { world.events = []; },
  },
  'a server of an earlier version': { early: true, plant: answers(404, '', /^\/(people\/|events|setup|healthz|configuration|)$/), says: LIVE, green: true },
  'a storage that is full': {
    init: () => { Storage.prototype.setItem = () => { throw new DOMException('full', 'QuotaExceededError'); }; Storage.prototype.getItem = () => '{"not":"a list"}'; },
    plant: (world) => { world.events = [warning('1', 'Look here.')]; }, says: LIVE, green: true, steps: [pressed('seen: Look here.')],
    check: (page) => page.waitForFunction(() => !document.getElementById('unseen')),
  },
  'a browser without WebGL': {
    init: () => { const usual = HTMLCanvasElement.prototype.getContext; HTMLCanvasElement.prototype.getContext = function none(kind, ...more) { return /webgl/.test(kind) ? null : usual.call(this, kind, ...more); }; },
    plant: () => {}, says: LIVE, green: true, check: (page) => page.getByText('This browser draws nothing in three dimensions').waitFor(), heals: false,
  },
  'graphics that are lost': {
    plant: (world, server, page) => page.evaluate(() => { window.gone = document.getElementById('scene').getContext('webgl2').getExtension('WEBGL_lose_context'); window.gone.loseContext(); }),
    says: LIVE, green: true, check: (page) => page.getByText('The graphics of this browser are gone').waitFor(),
    heal: (world, page) => page.evaluate(() => window.gone.restoreContext()), healed: (page) => page.waitForFunction(() => !document.getElementById('scene-trouble')),
  },
  'a wrong token': {
    plant: (world) => { world.token = 'secret'; }, steps: [...record, (page) => page.fill('#token', 'wrong'), pressed('Send')], says: LIVE, green: true,
    check: async (page, world) => { await page.locator('#record-said', { hasText: 'a token is needed' }).waitFor(); assert.deepEqual(world.posted, ['/recordings/ 401', '/recordings/ 401']); },
  },
  'a token that nobody types': { plant: (world) => { world.token = 'secret'; }, steps: [...record, pressed('Cancel')], says: LIVE, green: true, check: (page) => page.locator('#record-said', { hasText: 'a token is needed' }).waitFor() },
  'an action that the server breaks down over': { plant: answers(500, '<h1>oops</h1>', /^\/recordings\/$/, 'text/html'), steps: [opened('w'), opened('e')], says: LIVE, green: true,
    check: (page) => page.getByText('There are no recordings here: it answered 500').waitFor() },
  'an action that is lost on its way': {
    plant: (world) => { world.fault = (request) => { if (request.method === 'POST') request.socket.destroy(); return request.method === 'POST'; }; }, steps: record, says: LIVE, green: true,
    check: (page) => page.locator('#record-said', { hasText: 'the server does not answer' }).waitFor(),
  },
  'an action that another operator was quicker with': { plant: (world) => { world.refuse = () => 'walk-1 is being recorded already'; }, steps: record, says: LIVE, green: true, check: (page) => page.locator('#record-said', { hasText: 'being recorded already' }).waitFor() },
  'a person who presses everything twice': { plant: (world) => { world.fault = async (request) => { if (request.method === 'POST') await later(500); return false; }; },
    steps: [opened('e'), (page) => page.getByRole('button', { name: 'Record', exact: true }).dblclick()], says: LIVE, green: true,
    check: async (page, world) => { await page.waitForFunction(() => !document.getElementById('record').disabled); assert.deepEqual(world.posted, ['/recordings/ 200'], 'once'); } },
  'a drawer that cannot be loaded': { plant: (world, server, page) => page.route('**/panels/record.js', (route) => route.abort()), steps: [opened('e')], says: LIVE, green: true, check: (page) => page.getByText('This part of the page cannot be loaded').waitFor(),
    heal: (world, page) => page.unroute('**/panels/record.js'), healed: async (page) => { await page.keyboard.press('e'); await page.waitForSelector('#record'); } },
  'a picture that is none': { plant: (world) => { world.fault = (request, response) => { if (!pathOf(request).endsWith('/image')) return false; response.writeHead(200, { 'Content-Type': 'image/jpeg' }).end('no picture'); return true; }; },
    steps: [pressed('picture of s1')], says: LIVE, green: true, check: (page) => page.getByText('what the server sends is no picture').waitFor() },
  'a recording whose outline is broken': { plant: (world) => { recorded(world); world.fault = (request, response) => { if (!/outline$/.test(pathOf(request))) return false; response.writeHead(200).end('{"seconds":'); return true; }; },
    steps: [opened('l'), pressed('look at walk')], says: LIVE, green: true, check: (page) => page.getByText('walk cannot be opened: what the server says of it cannot be read').waitFor() },
  'a recording of which a part cannot be read': { plant: (world) => { recorded(world); world.fault = (request, response) => { if (!/stretch$/.test(pathOf(request))) return false; response.writeHead(500).end(detail('chunk 7 is damaged')); return true; }; },
    steps: [opened('l'), pressed('look at walk')], says: /^A recording is shown: walk/, check: (page) => page.getByText('chunk 7 is damaged').waitFor(), heals: false },
};

// ---- what holds for all of them ----------------------------------------------------------------------------------
/// What can be asked of the page, each with patience.
function asked(page) {
  const wait = (what, argument) => page.waitForFunction(what, argument, { timeout: PATIENCE_MS });
  return {
    sentence: (pattern) => wait((source) => new RegExp(source).test(document.getElementById('headline').textContent), pattern.source),
    framesAfter: async (count) => wait((least) => window.chorusViewer.fusedFrames > least, count + await page.evaluate(() => window.chorusViewer.fusedFrames)),
    notGreen: async () => assert.notEqual(await page.getAttribute('#headline', 'class'), 'good', await page.textContent('#headline')),
  };
}

async function goodWorld(fault) {
  const world = usualWorld();
  world.sensors = { s1: live(), s2: live() };
  world.registration.reasons = [];
  const server = await startFakeFusion(FILES, world);
  const page = await browser.newPage({ viewport: { width: 1280, height: 800 } });
  page.setDefaultTimeout(PATIENCE_MS);
  const complaints = [];
  page.on('pageerror', (error) => complaints.push(String(error.stack ?? error)));
  if (fault.init) await page.addInitScript(fault.init);
  if (fault.early) await fault.plant(world, server, page);
  await page.goto(server.url);
  return { world, server, page, complaints, ask: asked(page) };
}

async function shownToBeWell(page, complaints) {
  assert.deepEqual(complaints, [], 'nothing is thrown that nobody catches');
  assert.equal(await page.evaluate(() => window.hacked), undefined, 'no markup is executed');
  assert.equal(await page.locator('img[src=x]').count(), 0, 'markup is text');
  await page.keyboard.press('Escape');
  await page.keyboard.press('v');
  await page.waitForSelector('#tab-view[aria-selected=true]'); // keys work
}

describe('the page names each fault', { concurrency: 2 }, () => {
  for (const [name, fault] of Object.entries(FAULTS)) {
    test(name, async () => {
      const { world, server, page, complaints, ask } = await goodWorld(fault);
      try {
        if (!fault.early) {
          await ask.sentence(LIVE);
          await fault.plant(world, server, page);
        }
        for (const step of fault.steps ?? []) await step(page);
        await ask.sentence(fault.says);
        if (!fault.green) await ask.notGreen();
        await fault.check?.(page, world, ask);
        if (/stood still|gives no frames|not answered/.test(fault.says.source)) await page.waitForFunction(() => ['stale', 'gone'].includes(document.body.dataset.fresh));
        if (PICTURES) await page.screenshot({ path: `${PICTURES}/fault-${name.replaceAll(/[^a-z0-9]+/gi, '-')}.png` });
        await shownToBeWell(page, complaints);
        if (fault.heals === false) return;
        Object.assign(world, { silent: false, fault: undefined, told: undefined });
        await fault.heal?.(world, page);
        await (fault.healed ? fault.healed(page) : ask.sentence(LIVE));
        assert.deepEqual(complaints, []);
      } finally {
        await page.close();
        server.stop();
      }
    });
  }
});
