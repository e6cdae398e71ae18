// Every state of the page, dark and light: the accessibility checker (npm axe-core) finds nothing, the page asks no other origin, and
// a picture of it is kept where CHORUS_SCREENSHOTS says.
import assert from 'node:assert/strict';
import { mkdirSync } from 'node:fs';
import { createRequire } from 'node:module';
import { after, before, test } from 'node:test';
import { fileURLToPath } from 'node:url';

import { launch, openViewer } from './browser.mjs';
import { SENSORS, live, lost, startFakeFusion, usualWorld } from './fake_fusion.mjs';

const AXE = createRequire(import.meta.url).resolve('axe-core/axe.min.js');
const FILES = fileURLToPath(new URL('../../services/viewer/', import.meta.url));
const PICTURES = process.env.CHORUS_SCREENSHOTS;
let browser;
before(async () => {
  browser = await launch();
  if (PICTURES) mkdirSync(PICTURES, { recursive: true });
});
after(() => browser?.close());

const good = (world) => {
  world.sensors = { s1: live(), s2: live() };
  world.registration.reasons = [];
};
const collecting = { state: 'collecting', progress: '/registration/sessions/7', elapsedSeconds: 12, targetSeconds: 30, reasons: [] };
const recording = { name: 'walk-1', state: 'finished', started: '2026-11-27T09:00:00Z', frames: 600, bytes: 1500000, dropped: 0, files: ['/recordings/walk-1/a.mcap'] };
const event = (id, severity, message, advice) => ({ eventId: id, time: '2026-11-27T10:00:00Z', kind: 'x', severity, message, advice });
const says = (text) => (page) => page.waitForFunction((wanted) => document.body.textContent.includes(wanted), text);
const key = (letter) => (page) => page.keyboard.press(letter);

/// name: what the server says, and what is done on the page until the state is there.
const STATES = {
  connecting: { world: (world) => { world.silent = true; }, reach: [(page) => page.waitForFunction(() => /Connecting|does not answer/.test(document.body.textContent))] },
  'no-sensors': {
    world: (world) => {
      Object.assign(world, { sensors: {}, people: 0 });
      world.registration = { version: 0, verdict: 'None', reasons: [], awaits: ['no sensor is configured'], session: { state: 'idle', reasons: [] }, sensors: {} };
      world.setup = { file: '/var/lib/chorus/sensors.json', found: [{ id: 's1', url: 'http://10.0.0.1:8081/', host: 's1.local' }],
        searchProblem: 'avahi-daemon is not running on this host: systemctl start avahi-daemon' };
    },
    reach: [says('Search the network')],
  },
  adding: {
    world: (world) => {
      STATES['no-sensors'].world(world);
      const words = { 'http://10.0.0.1:8081/': { state: 'good', words: 'Sensor s1 is there and sees one person.', sensorId: 's1' },
        'http://10.0.0.9:8081/': { state: 'bad', words: 'At 10.0.0.9:8081 no program listens: start chorus-sensor there.' } };
      world.after = (asked, text) => { if (asked === '/setup/try') world.setup.trials = { ...world.setup.trials, [JSON.parse(text).url]: words[JSON.parse(text).url] }; };
      world.answers = { '/setup/preview': { file: '/var/lib/chorus/sensors.json', text: '{\n  "sensors": [ { "id": "s1", "url": "http://10.0.0.1:8081/" } ]\n}\n' } };
    },
    reach: [(page) => page.getByRole('button', { name: 'try s1' }).click(), (page) => page.getByRole('button', { name: 'Take it' }).click(), says('will hold'),
      (page) => page.getByLabel('address', { exact: true }).fill('10.0.0.9'), (page) => page.getByRole('button', { name: 'Try', exact: true }).click(), says('no program listens')],
  },
  registering: {
    world: (world) => {
      good(world);
      Object.assign(world.registration, { verdict: 'None', session: collecting, sensors: {}, awaits: ['walk where s1 and s2 both see you'] });
      world.session = { coverage: [{ target: 's1', source: 's2', sightings: 12, expectedRadius: 0.09 }], floorCells: [{ x: 0.25, z: 0.25, seenBy: 2 }, { x: 0.5, z: 0.25, seenBy: 1 }] };
    },
    reach: [says('Registering: 12 of 30 s'), says('12 common sightings')],
  },
  provisional: { world: (world) => { good(world); Object.assign(world.registration, { verdict: 'Provisional', awaits: ['walk on for 15 s'] }); }, reach: [says('The places are provisional'), key('r')] },
  proposal: {
    world: (world) => {
      good(world);
      world.registration.proposal = { sessionId: 7, verdict: 'Good', changes: [{ sensorId: 's2', presentRadius: 0.03, expectedRadius: 0.0231, moves: 0.117, turnsDegrees: 1.26 }] };
    },
    reach: [says('New places wait for your decision')],
  },
  good: { world: good, reach: [says('Live: one person, 2 sensors.')] },
  moved: {
    world: (world) => { good(world); world.sensors.s2.alarm = 'sensor s2 does not stand where it was registered'; world.registration.alarms = ['s2 was moved by about 120 mm; register it again']; },
    reach: [says('s2 was moved')],
  },
  'lost-sensor': { world: (world) => { world.registration.reasons = []; world.sensors = { s1: live(), s2: lost() }; world.setup = { silenced: { s3: 'http://10.0.0.3:8081/' } }; }, reach: [says('s2 delivers nothing'), says('hear it again')] },
  stale: { world: good, reach: [says('Live: one person'), (page, server) => { server.world.frozen = true; }, says('has stood still for')] },
  gone: { world: good, own: true, reach: [says('Live: one person'), (page, server) => server.stop(), says('has not answered for'), (page) => page.waitForFunction(() => window.chorusViewer.fresh === 'gone')] },
  recording: { world: (world) => { good(world); world.recordings = [{ ...recording, name: 'now', state: 'recording' }, recording]; }, reach: [says('Live: one person'), key('e'), says('● recording')] },
  'disk-full': {
    world: (world) => {
      good(world);
      world.health = { status: 'degraded', warning: 'the disk of this service is nearly full: 0.4 GB are left' };
      world.events = [event('1', 'calm', 'Person 1 came.'), event('2', 'error', 'The recording walk-1 was ended: the disk is full.', 'Make room on it.')];
    },
    reach: [says('nearly full'), says('Make room on it')],
  },
  'six-people': { world: (world) => { good(world); world.people = 6; world.known = { 2: { personId: '2', name: 'Anna' } }; }, reach: [says('Live: 6 people')] },
  playback: {
    world: (world) => {
      good(world);
      world.recordings = [recording];
      world.outlines = { 'walk-1': { name: 'walk-1', seconds: 20, started: '2026-11-27T09:00:00Z', fused: true, sensors: ['s1', 's2'], registrations: [{ seconds: 0, registration: { sensors: SENSORS } }],
        notes: ['the file has no end: its last second may be missing'], writable: true, marks: [{ id: 1, seconds: 5, text: 'takes the drill' }] } };
    },
    reach: [says('Live: one person'), key('l'), (page) => page.getByRole('button', { name: 'look at walk-1' }).click(), says('A recording is shown'), (page) => page.getByRole('slider').fill('6.5'), says('0:06.5 of')],
  },
  card: {
    world: (world) => { good(world); world.setup = { added: ['s1'] }; world.pictures = { s1: '<svg xmlns="http://www.w3.org/2000/svg" width="320" height="180"><rect width="320" height="180" fill="#345"/></svg>' }; },
    reach: [says('Live: one person'), (page) => page.getByRole('button', { name: 'picture of s1' }).click(), (page) => page.getByRole('button', { name: 'more of s1' }).click(),
      (page) => page.getByRole('img', { name: 'what s1 sees' }).waitFor(), (page) => page.getByRole('button', { name: 'take s1 out' }).waitFor()],
  },
  world: { world: good, reach: [says('Live: one person'), key('w'), says('facing its front')] },
  view: { world: good, reach: [says('Live: one person'), key('v'), key('u'), says('drag to turn')] },
  curves: {
    world: (world) => { good(world); world.evaluation = { limbs: [{ bodyId: 1, limb: 'ForearmLeft', state: 'off', angleDegrees: '70.2', thresholdDegrees: '45.0', comment: 'left forearm off by 70 deg for 4 s' }] }; },
    reach: [says('Live: one person'), says('left forearm off'), key('c'), (page) => page.getByRole('combobox', { name: 'of the last minute' }).selectOption('speed'), (page) => page.waitForFunction(() => /person 1 \d\.\d\d m\/s/.test(document.getElementById('curves-now').textContent)),
      (page) => page.getByRole('combobox', { name: 'of the last minute' }).selectOption('limbs'), says('ForearmLeft, person 1 70.2 °'), (page) => page.waitForSelector('.curves canvas'), (page) => page.getByRole('img', { name: 'now off' }).waitFor()],
  },
  work: { world: good, reach: [says('Live: one person'), key('p'), says('No posture scores')] },
  hall: {
    world: (world) => {
      good(world);
      world.site = { siteName: 'hall-1', cell: 'A', connected: true, dropped: 0, siteCells: { A: { state: 'own', placed: true, people: 1, x: 0, y: 0, z: 0, qx: 0, qy: 0, qz: 0, qw: 1 },
        B: { state: 'heard', placed: true, people: 1, address: 'http://b:8080/', x: 6, y: 0, z: 1, qx: 0, qy: 0.38, qz: 0, qw: 0.92 }, C: { state: 'heard', placed: false, people: 0 }, D: { state: 'silent', placed: true, people: 0, x: 0, y: 0, z: 7, qx: 0, qy: 0, qz: 0, qw: 1 } } };
      world.sitePeople = { 'A-3': { bodyId: 3, siteCertainty: 0.99, cell: 'A', x: 0.5, y: 0.9, z: 0.4 }, 'B-7': { bodyId: 4, siteCertainty: 0.8, cell: 'B', x: 5, y: 0.9, z: 0 } };
    },
    reach: [says('Live: one person'), (page) => page.getByRole('tab', { name: 'Hall' }).click(), says('nobody has walked from A to C yet'), says('80 % certain')],
  },
  keys: { world: good, reach: [says('Live: one person'), key('?'), says('show the uncertainty')] },
  token: { world: (world) => { good(world); world.token = 'secret'; }, reach: [says('Live: one person'), key('e'), (page) => page.getByRole('button', { name: 'Record', exact: true }).click(), says('asks for a token')] },
  phone: { world: good, reach: [says('Live: one person')], size: { width: 390, height: 844 } },
  tablet: { world: good, reach: [says('Live: one person'), key('r')], size: { width: 820, height: 1180 } },
};

// Only colours depend on the theme.
const CHECKED = { dark: { resultTypes: ['violations'] }, light: { resultTypes: ['violations'], runOnly: ['color-contrast'] } };
const faultsOf = (page, theme) => page.evaluate(async (how) => (await window.axe.run(document, how)).violations
  .flatMap(({ id, help, nodes }) => nodes.map(({ html, any }) => `${id}: ${help}: ${html.slice(0, 160)} ${any.map(({ message }) => message).join(' ').slice(0, 160)}`)), CHECKED[theme]);

for (const [name, state] of Object.entries(STATES)) {
  test(`${name}: nothing is in the way of anybody, dark and light`, async () => {
    const world = usualWorld();
    state.world(world);
    const server = await startFakeFusion(FILES, world);
    const { page } = await openViewer(browser, server.url, state.size);
    try {
      const foreign = [];
      page.on('request', (request) => { if (!request.url().startsWith(new URL('/', server.url).href) && !/^(data|blob):/.test(request.url())) foreign.push(request.url()); });
      for (const step of state.reach) await step(page, server);
      await page.addScriptTag({ path: AXE });
      for (const theme of ['dark', 'light']) {
        await page.evaluate(() => { window.chorusViewer.paused = false; });
        await page.evaluate((wanted) => { if ((document.documentElement.dataset.theme ?? 'dark') !== wanted) document.getElementById('theme').click(); }, theme);
        if (PICTURES) await page.screenshot({ path: `${PICTURES}/${name}-${theme}.png` });
        await page.evaluate(() => { window.chorusViewer.paused = true; }); // the checker needs no picture, and is quicker without
        assert.deepEqual(await faultsOf(page, theme), [], `${name}, ${theme}`);
      }
      assert.deepEqual(foreign.filter((url) => !url.includes(':8093/')), [], 'no request to another origin');
    } finally {
      await page.close();
      server.stop();
    }
  });
}

const HEAVIEST = 900_000; // bytes, libraries included, before compression

test('the page is light: what it loads until the first body is shown', async () => {
  const server = await startFakeFusion(FILES, usualWorld());
  const page = await browser.newPage();
  const sizes = {};
  page.on('response', async (answer) => {
    const { pathname } = new URL(answer.url());
    if (pathname.startsWith('/viewer/')) sizes[pathname] = (await answer.body().catch(() => '')).length;
  });
  try {
    await page.goto(server.url);
    await page.waitForFunction(() => window.chorusViewer?.fusedFrames > 0);
    const all = Object.values(sizes).reduce((sum, size) => sum + size, 0);
    assert.ok(sizes['/viewer/node_modules/three/build/three.core.min.js'] > 100_000, 'libraries are counted');
    assert.ok(all <= HEAVIEST, `${all} bytes`);
  } finally {
    await page.close();
    server.stop();
  }
});

test('a recording that cannot be opened, and one that needs a token, say so', async () => {
  const world = usualWorld();
  STATES.playback.world(world);
  world.recordings = [recording, { ...recording, name: 'lost', started: '2026-11-27T08:00:00Z' }];
  world.recordingToken = 'secret';
  world.known = { 1: { personId: '1', name: 'Anna' } };
  world.evaluation = { limbs: [{ bodyId: 1, limb: 'ForearmLeft', state: 'good' }] };
  const server = await startFakeFusion(FILES, world);
  const { page } = await openViewer(browser, server.url);
  try {
    await says('Live: one person')(page);
    await page.keyboard.press('l');
    await page.getByRole('button', { name: 'look at walk-1' }).click();
    await page.fill('#token', 'secret');
    await page.getByRole('button', { name: 'Send' }).click();
    await says('A recording is shown: walk-1')(page);
    const people = page.getByRole('region', { name: 'People' });
    await people.getByRole('listitem').waitFor();
    const now = { name: page.locator('#people .name'), pencil: page.locator('#people .rename'), judged: page.locator('#judged') };
    for (const [what, place] of Object.entries(now)) assert.equal(await place.count(), 0, `${what}: recorded bodies are not those who are there now`);
    await page.keyboard.press('p');
    await says('a recording is shown')(page);
    await page.keyboard.press('l');
    await page.getByRole('button', { name: /^Back to the room/ }).click();
    for (const place of Object.values(now)) await place.waitFor({ state: 'attached' });
    await page.getByRole('button', { name: 'look at lost' }).click();
    await says('lost cannot be opened: there is no recording of this name')(page);
    await says('Live: one person')(page);
  } finally {
    await page.close();
    server.stop();
  }
});
