// The viewer alone, with artificial JSON: it draws, shows states, and survives a server that disappears.
import assert from 'node:assert/strict';
import { cp, mkdtemp, readdir, rm } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { fileURLToPath } from 'node:url';

import { PATIENCE_MS, colorsOnCanvas, launch, openViewer } from './browser.mjs';
import { CLOCK_AHEAD_MS, live, lost, startFakeFusion, usualWorld } from './fake_fusion.mjs';

const SOON = {}; // as long as browser.mjs has patience: a loaded machine that draws by software shows a picture now and then
const FILES = fileURLToPath(new URL('../../services/viewer/', import.meta.url));
let browser;
let fusion;
const servers = []; // stopped at the end: one that a failed test left running would keep this process from ending

async function startFusion(files, world) {
  servers.push(await startFakeFusion(files, world));
  return servers.at(-1);
}

before(async () => {
  browser = await launch();
  fusion = await startFusion(FILES);
});
after(async () => {
  await browser?.close();
  for (const server of servers) server.stop();
});

test('draws the fused body, the raw one of the live sensor, and both sensors', async () => {
  const { page, complaints } = await openViewer(browser, fusion.url);
  await page.waitForFunction(() => window.chorusViewer?.fusedFrames > 20 && window.chorusViewer.rawBones.s1 > 0, null, SOON);
  const shown = await page.evaluate(() => window.chorusViewer);
  assert.equal(shown.fusedJoints, 24, '24 joints: the untracked thumb is not drawn');
  assert.equal(shown.rawBones.s1, 23, 'all bones but the untracked thumb');
  assert.equal(shown.rawBones.s2 ?? 0, 0, 'a lost sensor shows no stale skeleton');
  assert.equal(await page.textContent('[data-sensor=s2] .state'), 'lost');
  assert.equal(await page.textContent('#verdict'), 'Good');
  await page.keyboard.press('r');
  assert.equal(await page.textContent('#reasons li'), 'a reason with <b>markup</b>', 'text, never markup');
  await page.getByRole('tab', { name: 'View' }).click();
  const full = await colorsOnCanvas(page);
  for (const box of ['#show-raw', '#show-frusta', '#show-fused']) await page.uncheck(box);
  const empty = await colorsOnCanvas(page);
  assert.ok(full > empty * 1.2, `switching everything off must empty the scene (${full} against ${empty} colours)`);
  assert.deepEqual(complaints, []);
  if (process.env.CHORUS_SCREENSHOT) {
    for (const box of ['#show-raw', '#show-frusta', '#show-fused']) await page.check(box);
    await page.waitForTimeout(300);
    await page.screenshot({ path: process.env.CHORUS_SCREENSHOT });
  }
  await page.close();
});

const text = (page, selector) => page.textContent(selector);
const headline = (page, pattern) => page.waitForFunction(
  (source) => new RegExp(source).test(document.getElementById('headline').textContent), pattern.source, SOON);
/// Sentence and colour of the same moment: a page that was held up says so in between, in another colour.
const headlineIn = (page, pattern, color) => page.waitForFunction(([source, wanted]) => {
  const said = document.getElementById('headline');
  return new RegExp(source).test(said.textContent) && getComputedStyle(said).color === wanted;
}, [pattern.source, color], SOON);
const colour = (page, selector) => page.evaluate((s) => getComputedStyle(document.querySelector(s)).color, selector);
const GREEN = 'rgb(95, 211, 141)';
const RED = 'rgb(255, 128, 116)';

async function picture(page, name) {
  if (process.env.CHORUS_SCREENSHOTS) await page.screenshot({ path: `${process.env.CHORUS_SCREENSHOTS}/${name}.png` });
}

test('the age of a frame is by the server’s clock, and errors of sensors are there to read', async () => {
  const { page } = await openViewer(browser, fusion.url);
  await headline(page, /^Live: one person\. s2 delivers nothing\.$/);
  // How old a frame really is when it is shown depends on the machine; an error of an hour does not. state_test.mjs has the milliseconds.
  const [age, unit] = (await text(page, '#age')).split(' ');
  const shown = Number(age) * (unit === 's' ? 1000 : 1);
  assert.ok(shown >= 0 && shown < CLOCK_AHEAD_MS / 10, `an hour between the clocks must not be seen, but it says ${age} ${unit}`);
  assert.equal(await text(page, '#next'), 's2: connection refused');
  const facts = (id) => page.locator(`[data-sensor=${id}] dd`).allTextContents();
  assert.deepEqual((await facts('s1')).slice(0, 4), ['1', '30.0 Hz', '12 ms', '0.97']);
  assert.deepEqual((await facts('s2')).slice(0, 4), ['–', '–', '61 s', '–']);
  assert.equal(await text(page, '[data-sensor=s2] p'), 'connection refused');
  await page.close();
});

test('green only while all is well: nobody there, no sensors, dead sensors', async () => {
  const world = usualWorld();
  world.sensors = { s1: live(), s2: live() };
  const server = await startFusion(FILES, world);
  const { page } = await openViewer(browser, server.url);
  await headline(page, /^Live: one person\. The places are in doubt\.$/); // Good, but with a reason
  assert.notEqual(await colour(page, '#headline'), GREEN);
  world.registration.reasons = [];
  await headlineIn(page, /^Live: one person, 2 sensors\.$/, GREEN);
  world.people = 0;
  await headline(page, /^Nobody is in sight\.$/);
  assert.notEqual(await colour(page, '#headline'), GREEN);
  await picture(page, 'nobody');
  world.sensors = { s1: lost(), s2: lost({ lastError: 'no answer within 3 s' }) };
  await headlineIn(page, /^None of the 2 sensors delivers anything\.$/, RED);
  assert.equal(await colour(page, '[data-sensor=s1] .state'), RED);
  assert.deepEqual(await page.locator('.card p').allTextContents(), ['connection refused', 'no answer within 3 s']);
  await picture(page, 'dead');
  world.sensors = {};
  await headlineIn(page, /^No sensors are configured\.$/, RED);
  await picture(page, 'none');
  await page.close();
});

test('what is amiss with the service itself is shown', async () => {
  const world = usualWorld();
  world.health = { status: 'degraded', warning: 'these keys were changed and wait for a restart: http.port' };
  const server = await startFusion(FILES, world);
  const { page } = await openViewer(browser, server.url);
  await page.waitForFunction(() => document.getElementById('warning')?.textContent.includes('http.port'), null, SOON);
  assert.equal(await page.isVisible('#warning'), true);
  await page.close();
});

test('reasons, what is awaited, and what is not stored are shown without a registration too', async () => {
  const world = usualWorld();
  world.sensors = { s1: live(), s2: live() };
  world.registration = { version: 0, verdict: 'None', reasons: ['sensors s1 and s2 disagree'], awaits: ['nobody is in sight'],
    storeProblem: 'state_dir is empty', session: { state: 'idle', reasons: ['sensors s1 and s2 disagree', 'withdrawn'] }, sensors: {} };
  const server = await startFusion(FILES, world);
  const { page } = await openViewer(browser, server.url);
  await headline(page, /^It is not known yet where the sensors stand\.$/);
  await page.keyboard.press('r');
  await page.waitForSelector('#reasons li'); // the drawer is loaded when it is opened first
  assert.deepEqual(await page.locator('#reasons li').allTextContents(), ['sensors s1 and s2 disagree', 'last walk: withdrawn']);
  assert.deepEqual(await page.locator('#awaits li').allTextContents(), ['nobody is in sight']);
  assert.equal(await text(page, '#next'), 'nobody is in sight');
  assert.equal(await text(page, '#stored'), 'not stored: state_dir is empty');
  await picture(page, 'unregistered');
  Object.assign(world.registration, { stored: true, storeProblem: 'the stored registration cannot be read' });
  await page.waitForFunction(() => document.getElementById('stored').textContent === 'the stored registration cannot be read');
  world.registration.session = { state: 'collecting', elapsedSeconds: 12, targetSeconds: 30 };
  await headline(page, /^Registering: 12 of 30 s of the walk seen\.$/);
  await page.close();
});

test('a proposed registration is shown beside the old one, and accepted or declined', async () => {
  const world = usualWorld();
  world.sensors = { s1: live(), s2: live() };
  const proposal = { sessionId: 7, verdict: 'Good', changes: [
    { sensorId: 's1', presentRadius: 0, expectedRadius: 0, moves: 0, turnsDegrees: 0 },
    { sensorId: 's2', expectedRadius: 0.0231, moves: 0.117, turnsDegrees: 1.26 }] };
  world.registration.proposal = proposal;
  const server = await startFusion(FILES, world);
  const { page } = await openViewer(browser, server.url);
  await headline(page, /^New places wait for your decision\.$/);
  await page.waitForSelector('#changes tr:nth-child(2) td:nth-child(5)');  // the drawer is loaded when it is opened
  assert.deepEqual(await page.locator('#changes tr:nth-child(2) td').allTextContents(), ['s2', '–', '23 mm', '117 mm', '1.3°']);
  await picture(page, 'proposal');
  await page.click('#accept');
  await page.waitForSelector('#proposal', { state: 'hidden' });
  world.token = 'secret';
  world.registration.proposal = proposal;
  await page.waitForSelector('#decline', { state: 'visible' });
  await page.click('#decline');
  await page.click('#token-cancel');
  await page.waitForFunction(() => document.getElementById('decision').textContent === 'a token is needed');
  await page.click('#decline');
  await page.fill('#token', 'secret');
  await page.click('#token-send');
  await page.waitForSelector('#proposal', { state: 'hidden' });
  assert.deepEqual(world.posted, ['/registration/accept 200', '/registration/decline 401', '/registration/decline 401', '/registration/decline 200']);
  await page.close();
});

test('the origin is set where one person stands still', async () => {
  const world = usualWorld();
  world.sensors = { s1: live(), s2: live() };
  world.still = true;
  const server = await startFusion(FILES, world);
  const { page } = await openViewer(browser, server.url);
  await page.waitForFunction(() => window.chorusViewer?.fusedFrames > 5, null, SOON);
  await page.keyboard.press('w');
  await page.click('#origin');
  await page.waitForFunction(() => document.getElementById('origin-said').textContent.startsWith('Stand where the world shall begin'));
  assert.equal(await page.isDisabled('#origin'), true);
  await page.waitForFunction(() => document.getElementById('origin-said').textContent.startsWith('The world begins'));
  assert.deepEqual(world.posted, ['/registration/origin 200']);
  const { x, z, yawDegrees } = JSON.parse(world.bodies[0]);
  assert.deepEqual([x, z, Math.round(yawDegrees)], [0, 0, 0], 'the fake person stands there and looks along +z');
  world.still = false;
  await page.click('#origin');
  await page.waitForFunction(() => document.getElementById('origin-said').textContent === 'the person moved or turned; stand still and retry');
  assert.equal(world.posted.length, 1);
  await page.close();
});

/// Where the head of the fake person is now [px]; the person sways, so it is asked for again and again.
const pointAtHead = async (page) => {
  for (const end = Date.now() + PATIENCE_MS; Date.now() < end;) {
    const at = await page.evaluate(() => window.chorusViewer.where('Head'));
    if (at) await page.mouse.move(at.x, at.y);
    if (await page.isVisible('#joint')) return at;
    await page.waitForTimeout(30);
  }
  throw new Error('no read-out beside the head');
};

test('uncertainty is shown when asked for: ellipsoids, people, and a joint with its sensors', async () => {
  const world = usualWorld();
  const server = await startFusion(FILES, world);
  const { page, complaints } = await openViewer(browser, server.url);
  await page.waitForFunction(() => window.chorusViewer?.fusedFrames > 5, null, SOON);
  assert.equal(await page.evaluate(() => window.chorusViewer.ellipsoids), 0, 'not before');
  const before = await colorsOnCanvas(page);
  await page.keyboard.press('v');
  await page.keyboard.press('u');
  assert.equal(await page.isChecked('#show-uncertainty'), true, 'by key and by switch');
  await page.waitForFunction(() => window.chorusViewer.ellipsoids === 24, null, SOON);
  assert.notEqual(await colorsOnCanvas(page), before);
  await page.waitForFunction(() => document.querySelector('#people li'), null, SOON);
  assert.deepEqual(await page.locator('#people li').allTextContents(), ['person 1: seen, left and right 98 % certain✎']);
  await pointAtHead(page);
  await page.mouse.down();
  await page.mouse.up();
  await page.mouse.move(1200, 60);
  const drawn = await page.evaluate(() => window.chorusViewer.fusedFrames);
  await page.waitForFunction((before) => window.chorusViewer.fusedFrames > before + 3, drawn, SOON);
  const said = (await text(page, '#joint')).split('\n');
  assert.deepEqual(said.slice(0, 3), ['Head, person 1', '95 % within ±56 × 28 × 14 mm', 'from s1 80 %, s2 20 %'], 'it stays when clicked');
  assert.match(said[3], /^seen, \d+ ms old$/);
  await picture(page, 'uncertainty');
  world.person = { sidesConfidence: 0.5, carriedFor: 0.42 };
  await page.waitForFunction(() => /from no sensor/.test(document.getElementById('joint').textContent), null, SOON);
  await page.waitForFunction(() => /out of sight for 0\.4 s, left and right 50 %/.test(document.getElementById('people').textContent), null, SOON);
  await page.keyboard.press('Escape');
  await page.waitForFunction(() => document.getElementById('joint').hidden, null, SOON);
  await page.keyboard.press('u');
  await page.waitForFunction(() => window.chorusViewer.ellipsoids === 0, null, SOON);
  assert.deepEqual(complaints, []);
  await page.close();
});

test('frames that stand still are grey, then gone', async () => {
  const server = await startFusion(FILES);
  const { page } = await openViewer(browser, server.url);
  await page.waitForFunction(() => window.chorusViewer?.fusedFrames > 5, null, SOON);
  server.world.frozen = true;
  await page.waitForFunction(() => /^The fused output has stood still for \d+ s\.$/.test(document.getElementById('headline').textContent)
    && document.body.dataset.fresh === 'stale', null, SOON); // of the same moment
  await page.waitForFunction(() => window.chorusViewer.fusedJoints === 0, null, SOON);
  await page.close();
});

test('says so when the server goes away, and shows nothing of it any more', async () => {
  const doomed = await startFusion(FILES, { ...usualWorld(), evaluation: { limbs: [{ bodyId: 1, limb: 'ForearmLeft', state: 'off', angleDegrees: '70.2', comment: 'off by 70 deg' }] } });
  const { page } = await openViewer(browser, doomed.url);
  await page.waitForFunction(() => window.chorusViewer?.fusedFrames > 5 && window.chorusViewer.rawBones.s1 > 0 && /off by 70 deg/.test(document.body.textContent), null, SOON);
  await page.keyboard.press('c');
  await page.getByText('ForearmLeft, person 1 70.2 °').waitFor();
  doomed.stop();
  await headlineIn(page, /^The fusion server has not answered for \d+ s\.$/, RED);
  await page.waitForFunction(() => window.chorusViewer.fresh === 'gone', null, SOON);
  await page.waitForTimeout(500);
  const shown = await page.evaluate(() => window.chorusViewer);
  assert.equal(shown.fusedJoints, 0, 'no skeleton of a dead server');
  assert.equal(shown.rawBones.s1, 0);
  assert.equal(await text(page, '#verdict'), '–');
  assert.equal(await text(page, '[data-sensor=s1] .state'), 'unknown');
  assert.deepEqual([await text(page, '#curves-now strong'), await page.getAttribute('#strip svg', 'aria-label')], ['– °', 'now waiting']);
  await picture(page, 'gone');
  await page.close();
});

test('a whole day without a shell: walk, cancel, undo, record, stop, download', async () => {
  const world = usualWorld();
  world.sensors = { s1: live(), s2: live() };
  world.registration.earlier = { version: 0 };
  const recording = { name: 'walk-1', state: 'recording', started: '2026-11-27T09:00:00Z', frames: 120, bytes: 1500000, dropped: 0, files: [] };
  world.after = (asked) => {
    if (asked === '/registration') world.registration.session = { state: 'collecting', progress: '/registration/sessions/7', elapsedSeconds: 3, targetSeconds: 30 };
    if (asked === 'DELETE /registration/sessions/7') world.registration.session = { state: 'idle', reasons: [] };
    if (asked === '/recordings/') world.recordings = [recording];
    if (asked === 'DELETE /recordings/walk-1') world.recordings = [{ ...recording, state: 'finished', download: '/recordings/walk-1.mcap' }];
  };
  world.session = { coverage: [{ target: 's1', source: 's2', sightings: 12, expectedRadius: 0.09 }], floorCells: [{ x: 0.25, z: 0.25, seenBy: 2 }] };
  const server = await startFusion(FILES, world);
  const { page, complaints } = await openViewer(browser, server.url);
  const button = (name) => page.getByRole('button', { name, exact: true });
  await page.getByRole('tab', { name: /Register/ }).click();
  await page.getByLabel('seconds').fill('45');
  await button('Start a walk').click();
  await headline(page, /^Registering: 3 of 30 s/);
  await page.waitForSelector('#coverage:not([hidden])', SOON);
  assert.match(await text(page, '#pairs'), /s1 – s2: 12 common sightings, ±90 mm expected/);
  await picture(page, 'registering');
  for (const name of ['Cancel the walk', 'Undo', 'Forget all places', 'Forget them: are you sure?']) await button(name).click();
  await page.keyboard.press('e');
  await page.getByLabel('name', { exact: true }).fill('walk-1');
  await button('Record').click();
  await page.getByText('120 frames, 1.5 MB').waitFor(SOON);
  await picture(page, 'recording');
  assert.ok(await button('Mark').isDisabled(), 'nothing is said of the present yet');
  await page.fill('#mark-text', ' takes the drill ');
  for (const name of ['Mark', 'Stop']) await button(name).click();
  const download = page.getByRole('link', { name: 'download' });
  assert.equal(await download.getAttribute('href'), '../recordings/walk-1.mcap');
  assert.deepEqual(world.posted, ['/registration 200', 'DELETE /registration/sessions/7 200', '/registration/undo 200', 'DELETE /registration 200',
    '/recordings/ 200', '/recordings/walk-1/marks 200', 'DELETE /recordings/walk-1 200']);
  assert.deepEqual(JSON.parse(world.bodies[0]), { seconds: 45, adopt: 'at-once' });
  assert.deepEqual([4, 5].map((i) => JSON.parse(world.bodies[i])), [{ name: 'walk-1', raw: true, fused: true }, { text: 'takes the drill' }]);
  assert.deepEqual(complaints, []);
  await page.close();
});

test('keys open drawers and dialogs, and stay out of text fields; a phone gets the address with the token behind #', async () => {
  const server = await startFusion(FILES);
  const { page } = await openViewer(browser, `${server.url}#token=secret`);
  await page.waitForFunction(() => window.chorusViewer?.fusedFrames > 5, null, SOON);
  assert.equal(await page.evaluate(() => location.hash), '', 'the token leaves the address bar');
  await page.keyboard.press('e');
  await page.getByLabel('name', { exact: true }).pressSequentially('rw');
  assert.equal(await page.inputValue('#record-name'), 'rw');
  assert.equal(await page.getAttribute('#tab-record', 'aria-selected'), 'true');
  await page.getByRole('button', { name: 'keys' }).click();
  assert.match(await text(page, 'dialog'), /show the uncertainty/);
  await page.keyboard.press('Escape');
  await page.getByRole('button', { name: 'phone' }).click();
  await page.waitForSelector('.qr', { state: 'visible', ...SOON });
  assert.equal(await page.evaluate(async () => (await import('./panels/phone.js')).phoneAddress('http://cell:8080/viewer/?x=1', 'a b')),
    'http://cell:8080/viewer/?x=1#token=a%20b');
  await page.keyboard.press('Escape');
  await page.keyboard.press('t');
  await picture(page, 'light');
  await page.setViewportSize({ width: 390, height: 844 });
  await page.waitForTimeout(300);
  await picture(page, 'phone');
  await page.close();
});

test('says what is missing when the libraries are not installed', async () => {
  const folder = await mkdtemp(join(tmpdir(), 'chorus-viewer-'));
  for (const file of await readdir(FILES, { recursive: true }))
    if (!file.startsWith('node_modules') && /\.(html|js|css)$/.test(file)) await cp(join(FILES, file), join(folder, file));
  const server = await startFusion(folder);
  const { page } = await openViewer(browser, server.url);
  await headline(page, /its libraries are missing/);
  assert.match(await text(page, '#next'), /npm ci/);
  await page.close();
  await rm(folder, { recursive: true });
});

test('people get names that everybody sees, and what happened stays until it is seen', async () => {
  const world = usualWorld();
  world.known = { 1: { personId: '1', state: 'seen', sensors: ['s1'] } };
  world.events = [
    { eventId: '5', time: '2026-11-27T10:00:00Z', kind: 'person-came', severity: 'calm', message: 'Person 1 came.' },
    { eventId: '6', time: '2026-11-27T10:00:01Z', kind: 'sensor-lost', severity: 'warning', message: 's2 delivers nothing: <b>refused</b>.', advice: 'Look after its host.' },
  ];
  world.after = (asked, sent) => { if (asked === 'PATCH /people/1') world.known[1].name = JSON.parse(sent).name; };
  const server = await startFusion(FILES, world);
  const { page, complaints } = await openViewer(browser, server.url);
  await page.getByRole('button', { name: 'name person 1' }).click();
  await page.getByLabel('name', { exact: true }).fill('<i>Anna</i>');
  await page.getByRole('button', { name: 'Save' }).click();
  await page.getByText('<i>Anna</i>').waitFor();
  assert.equal(world.bodies.at(-1), '{"name":"<i>Anna</i>"}');
  assert.equal(await page.locator('#people .name').textContent(), '<i>Anna</i>', 'text, never markup');
  world.known[1].name = 'Bea'; // another operator
  await page.getByText('Bea').waitFor();
  const rows = page.locator('#events li');
  await rows.nth(1).waitFor();
  assert.match(await rows.nth(0).textContent(), /s2 delivers nothing: <b>refused<\/b>\.\s*Look after its host\./, 'what was not seen is first');
  assert.equal(await text(page, '#unseen'), '1 unseen');
  await page.getByRole('button', { name: /^seen: s2/ }).click();
  await page.waitForFunction(() => !document.getElementById('unseen'), null, SOON);
  assert.match(await rows.nth(1).textContent(), /Person 1 came/);
  await page.reload();
  await page.locator('#events li').nth(1).waitFor();
  assert.equal(await page.locator('#unseen').count(), 0, 'seen is seen, on a new page too');
  assert.deepEqual(complaints, []);
  await picture(page, 'people');
  await page.close();
});
