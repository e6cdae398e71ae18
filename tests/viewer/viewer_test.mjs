// The viewer alone, with artificial JSON: it draws, shows states, and survives a server that disappears.
import assert from 'node:assert/strict';
import { copyFile, mkdtemp, rm } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { fileURLToPath } from 'node:url';

import { colorsOnCanvas, launch, openViewer } from './browser.mjs';
import { live, lost, startFakeFusion, usualWorld } from './fake_fusion.mjs';

const SOON = { timeout: 30000 }; // a loaded machine that draws by software shows a few pictures a second
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
  assert.equal(await page.textContent('[data-sensor=s2] td:nth-child(3)'), 'lost');
  assert.equal(await page.textContent('#verdict'), 'Good');
  assert.equal(await page.textContent('#reasons li'), 'a reason with <b>markup</b>', 'text, never markup');
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
const colour = (page, selector) => page.evaluate((s) => getComputedStyle(document.querySelector(s)).color, selector);
const GREEN = 'rgb(95, 211, 141)';
const RED = 'rgb(242, 102, 91)';

async function picture(page, name) {
  if (process.env.CHORUS_SCREENSHOTS) await page.screenshot({ path: `${process.env.CHORUS_SCREENSHOTS}/${name}.png` });
}

test('the age of a frame is by the server’s clock, and errors of sensors are there to read', async () => {
  const { page } = await openViewer(browser, fusion.url);
  await headline(page, /^Live: one person\. s2 delivers nothing\.$/);
  const age = Number.parseInt(await text(page, '#age'), 10);
  assert.ok(age >= 0 && age < 1000, `an hour between the clocks must not be seen, but it says ${age} ms`);
  assert.equal(await text(page, '#errors li'), 's2: connection refused');
  assert.equal(await text(page, '#next'), 's2: connection refused');
  assert.deepEqual(await page.locator('[data-sensor=s1] td').allTextContents(), ['', 's1', 'live', '12 ms', '30.0', '1', '0.97']);
  assert.deepEqual(await page.locator('[data-sensor=s2] td').allTextContents(), ['', 's2', 'lost', '61 s', '–', '–', '–']);
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
  await headline(page, /^Live: one person, 2 sensors\.$/);
  assert.equal(await colour(page, '#headline'), GREEN);
  world.people = 0;
  await headline(page, /^Nobody is in sight\.$/);
  assert.notEqual(await colour(page, '#headline'), GREEN);
  await picture(page, 'nobody');
  world.sensors = { s1: lost(), s2: lost({ lastError: 'no answer within 3 s' }) };
  await headline(page, /^None of the 2 sensors delivers anything\.$/);
  assert.equal(await colour(page, '#headline'), RED);
  assert.equal(await colour(page, '[data-sensor=s1] td:nth-child(3)'), RED);
  assert.deepEqual(await page.locator('#errors li').allTextContents(), ['s1: connection refused', 's2: no answer within 3 s']);
  await picture(page, 'dead');
  world.sensors = {};
  await headline(page, /^No sensors are configured\.$/);
  assert.equal(await colour(page, '#headline'), RED);
  await picture(page, 'none');
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
  assert.deepEqual(await page.locator('#changes tr:nth-child(2) td').allTextContents(), ['s2', '–', '23 mm', '117 mm', '1.3°']);
  await picture(page, 'proposal');
  await page.click('#accept');
  await page.waitForSelector('#proposal', { state: 'hidden' });
  world.token = 'secret';
  world.registration.proposal = proposal;
  await page.waitForSelector('#decline', { state: 'visible' });
  page.once('dialog', (dialog) => dialog.dismiss());
  await page.click('#decline');
  await page.waitForFunction(() => document.getElementById('decision').textContent === 'a token is needed');
  page.once('dialog', (dialog) => dialog.accept('secret'));
  await page.click('#decline');
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
  for (let i = 0; i < 60; ++i) {
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
  assert.equal(await text(page, '#people'), '');
  const before = await colorsOnCanvas(page);
  await page.keyboard.press('u');
  assert.equal(await page.isChecked('#show-uncertainty'), true, 'by key and by switch');
  await page.waitForFunction(() => window.chorusViewer.ellipsoids === 24, null, SOON);
  assert.notEqual(await colorsOnCanvas(page), before);
  await page.waitForFunction(() => document.querySelector('#people li'), null, SOON);
  assert.deepEqual(await page.locator('#people li').allTextContents(), ['person 1: seen, left and right 98 % certain']);
  await pointAtHead(page);
  await page.mouse.down();
  await page.mouse.up();
  await page.mouse.move(1200, 60);
  await page.waitForTimeout(300);
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
  await page.waitForFunction(() => window.chorusViewer.ellipsoids === 0 && !document.querySelector('#people li'), null, SOON);
  assert.deepEqual(complaints, []);
  await page.close();
});

test('frames that stand still are grey, then gone', async () => {
  const server = await startFusion(FILES);
  const { page } = await openViewer(browser, server.url);
  await page.waitForFunction(() => window.chorusViewer?.fusedFrames > 5, null, SOON);
  server.world.frozen = true;
  await headline(page, /^The fused output has stood still for \d+ s\.$/);
  assert.equal(await page.evaluate(() => document.body.dataset.fresh), 'stale');
  await page.waitForFunction(() => window.chorusViewer.fusedJoints === 0, null, SOON);
  await page.close();
});

test('says so when the server goes away, and shows nothing of it any more', async () => {
  const doomed = await startFusion(FILES);
  const { page } = await openViewer(browser, doomed.url);
  await page.waitForFunction(() => window.chorusViewer?.fusedFrames > 5 && window.chorusViewer.rawBones.s1 > 0, null, SOON);
  doomed.stop();
  await headline(page, /^The fusion server has not answered for \d+ s\.$/);
  assert.equal(await colour(page, '#headline'), RED);
  await page.waitForFunction(() => window.chorusViewer.fresh === 'gone', null, SOON);
  await page.waitForTimeout(500);
  const shown = await page.evaluate(() => window.chorusViewer);
  assert.equal(shown.fusedJoints, 0, 'no skeleton of a dead server');
  assert.equal(shown.rawBones.s1, 0);
  assert.equal(await text(page, '#verdict'), '–');
  assert.equal(await text(page, '[data-sensor=s1] td:nth-child(3)'), 'unknown');
  await picture(page, 'gone');
  await page.close();
});

test('says what is missing when three.js is not installed', async () => {
  const folder = await mkdtemp(join(tmpdir(), 'chorus-viewer-'));
  for (const file of ['index.html', 'boot.js', 'viewer.js', 'viewer.css', 'poll.js', 'panel.js', 'state.js', 'coverage.js', 'framing.js', 'certainty.js',
    'readout.js', 'skeleton_view.js'])
    await copyFile(join(FILES, file), join(folder, file));
  const server = await startFusion(folder);
  const { page } = await openViewer(browser, server.url);
  await headline(page, /three\.js is missing/);
  assert.match(await text(page, '#next'), /npm ci/);
  await page.close();
  await rm(folder, { recursive: true });
});
