// The capture page as a person uses it: Chromium's camera plays one instant of a take, a chorus-sensor with the runner looks at the same
// instant from another side, and chorus-fusion makes a body of both, all over TLS.
import assert from 'node:assert/strict';
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';

import { CONTROL, READ, VIDEOS, Workshop, freePort, settingsOf, until } from './rig.mjs';

const INSTANT = 30; // number of the picture
const LENS = settingsOf(join(VIDEOS, 'cam01.json')).device.camera.intrinsics;
let workshop;
let browser;
let film;
let phone; // the sensor that serves the page
let page;
const foreign = [];
const complaints = [];

const bridge = (id) => ({ id, device: { kind: 'bridge', bridge: { page: true, yields_after_s: 20 } } }); // a busy computer is no silent pusher
const headline = (text, on = page) => on.waitForFunction(
  (source) => new RegExp(source).test(document.getElementById('headline').textContent), text.source, { timeout: 60000 });
const next = (on = page) => on.textContent('#next');

async function picture(name) {
  if (process.env.CHORUS_SCREENSHOTS) await page.screenshot({ path: `${process.env.CHORUS_SCREENSHOTS}/${name}.png` });
}

async function opened(context, hash = `#token=${encodeURIComponent(CONTROL)}&model=blazepose-lite&rate=4`) {
  const fresh = await context.newPage();
  fresh.on('request', (request) => { if (!request.url().startsWith(phone.url) && !request.url().startsWith('data:')) foreign.push(request.url()); });
  fresh.on('pageerror', (error) => complaints.push(String(error)));
  fresh.on('console', (message) => { if (/Content Security Policy|Uncaught/.test(message.text())) complaints.push(message.text()); });
  await fresh.goto(`${phone.url}capture${hash}`); // without the slash, as people type it
  return fresh;
}

async function calibrate(on) {
  const file = join(workshop.folder, 'lens.json');
  writeFileSync(file, JSON.stringify(LENS));
  await on.setInputFiles('#calibration', file);
}

before(async () => {
  workshop = new Workshop();
  film = workshop.still('cam01', INSTANT);
  phone = await workshop.service('chorus-sensor', 'cam01', await freePort(), bridge('cam01'));
  browser = await workshop.browser(film);
  page = await opened(await browser.newContext({ permissions: ['camera'], viewport: { width: 390, height: 844 } }));
});
after(async () => {
  await browser?.close();
  workshop?.close();
});

test('without a token there are the files of the page, and nothing else', async () => {
  const status = async (path) => (await workshop.get(phone.url + path, { token: '' })).status;
  for (const path of ['capture/', 'capture/capture.js', 'capture/runner/people.js', 'capture/runner/models.json',
    'capture/engine/tfjs-backend-wasm-simd.wasm', 'capture/models/blazepose-lite.json']) assert.equal(await status(path), 200, path);
  assert.equal(await status('capture'), 308);
  for (const path of ['capture/models/faceres.bin', 'capture/models/..%2Fpackage.json', 'capture/engine/tfjs-core%2Fpackage.json', 'capture/runner/runner.mjs', 'capture/x.js'])
    assert.match(String(await status(path)), /^40[04]$/, path);
  for (const path of ['', 'frame', 'push', 'frame/', 'nothing']) assert.equal(await status(path), 401, path);
  const { headers } = await workshop.get(`${phone.url}capture/`, { token: '' });
  assert.match(headers['content-security-policy'], /default-src 'none'.*connect-src 'self'.*frame-ancestors 'none'/);
  assert.match(headers['permissions-policy'], /camera=\(self\)/);
});

/// The median and the greatest angle [deg] between the tracked rays of two bodies.
function apart(one, other) {
  const angles = Object.entries(one).filter(([name, joint]) => joint.rayZ !== undefined && other[name]?.rayZ !== undefined && joint.state === 'Tracked')
    .map(([name, { rayX, rayY, rayZ }]) => Math.acos(Math.min(1, rayX * other[name].rayX + rayY * other[name].rayY + rayZ * other[name].rayZ)));
  assert.ok(angles.length >= 10, `${angles.length} rays to compare`);
  const sorted = angles.map((angle) => (angle * 180) / Math.PI).sort((a, b) => a - b);
  return { median: sorted[Math.floor(sorted.length / 2)], most: sorted.at(-1) };
}

const joints = async (service) => (await workshop.json(`${service.url}frame`)).bodies[0]?.joints;

test('page and runner see the same, and make a body together', async () => {
  const watching = (id, still) => {
    const settings = settingsOf(join(VIDEOS, `${id}.json`));
    Object.assign(settings.device.camera, { source: still, max_rate_hz: 3 });
    return freePort().then((port) => workshop.service('chorus-sensor', `${id}-runner`, port, { id, device: settings.device }));
  };
  const starting = [watching('cam01', film), watching('cam02', workshop.still('cam02', INSTANT))];
  await calibrate(page);
  await page.click('#run');
  await headline(/^Live: one person, /);
  await until('frames are taken', async () => (await workshop.json(`${phone.url}push`)).pusher?.frames > 10);
  await picture('live');
  const [twin, other] = await Promise.all(starting);
  const wanted = await until('the runner sees the person', () => joints(twin));
  twin.child.kill();
  const { median, most } = apart(await joints(phone), wanted);
  assert.ok(median < 0.5 && most < 3, `the page's rays are ${median.toFixed(2)} degrees from the runner's, at most ${most.toFixed(2)}`);
  const state = await workshop.json(`${phone.url}push`);
  assert.equal(state.pusher.refused, 0);
  assert.match(state.pusher.name, /BlazePose lite$/);
  assert.ok(Math.abs(state.pusher.clockOffsetMilliseconds) < 200, 'one computer, one clock');

  const fusion = await workshop.service('chorus-fusion', 'fusion', await freePort(), {
    viewer_dir: '', poll: { ca: join(workshop.folder, 'ca/ca.crt') },
    sensors: [{ id: 'cam01', url: phone.url, token: READ }, { id: 'cam02', url: other.url, token: READ }],
    registration: { file: join(VIDEOS, 'registration.json'), auto: false },
  });
  const body = await until('a fused body', async () => (await workshop.json(`${fusion.url}frame`)).bodies[0]);
  const seen = Object.values(body.joints).filter((joint) => Number.isFinite(joint.x));
  assert.ok(seen.length >= 12, `${seen.length} joints have a place`);
  const { AnkleLeft, Head, HipLeft, HipRight } = body.joints;
  const far = (a, b) => Math.hypot(a.x - b.x, a.y - b.y, a.z - b.z);
  assert.ok(far(HipLeft, HipRight) > 0.1 && far(HipLeft, HipRight) < 0.5, 'a person’s hips');
  assert.ok(far(Head, AnkleLeft) > 1.1 && far(Head, AnkleLeft) < 2.2, 'a person’s length');
  fusion.child.kill();
  other.child.kill();
});

test('a lens that is only guessed makes rays less sure at the edge', async () => {
  const width = ({ cxx, cyy, czz }) => Math.sqrt(Number(cxx) + Number(cyy) + Number(czz));
  const calibrated = width((await joints(phone)).Head);
  await page.click('summary');
  await page.click('#uncalibrate');
  await until('the new lens is known', async () => width((await joints(phone)).Head) > 1.5 * calibrated);
});

test('another model says hello anew', async () => {
  const taken = async (name, layout) => {
    const { pusher } = await workshop.json(`${phone.url}push`);
    return pusher.name.endsWith(name) && pusher.layout === layout && pusher.frames > 1;
  };
  await page.selectOption('#model', 'movenet');
  await until('MoveNet is pushed', () => taken('MoveNet MultiPose', 'coco_17'));
  await page.selectOption('#model', 'blazepose-lite');
  await until('BlazePose is pushed', () => taken('BlazePose lite', 'mediapipe_33'));
  await headline(/^Live: one person/);
});

test('a camera that is lost, or gives nothing more, comes back', async () => {
  await page.evaluate(() => document.getElementById('video').srcObject.getVideoTracks()[0].dispatchEvent(new Event('ended')));
  await headline(/^The camera is gone\.$/);
  await headline(/^Live: one person/);
  await page.evaluate(() => document.getElementById('video').pause());
  await headline(/^The camera gives no more pictures\.$/);
  await headline(/^Live: one person/);
});

test('a hidden page leaves the sensor, and comes back', async () => {
  const hide = (hidden) => page.evaluate((value) => {
    Object.defineProperty(document, 'hidden', { configurable: true, get: () => value });
    document.dispatchEvent(new Event('visibilitychange'));
  }, hidden);
  await hide(true);
  await headline(/^Asleep: this page is hidden\.$/);
  await until('that it left shows', async () => (await workshop.json(`${phone.url}push`)).state === 'waiting');
  await hide(false);
  await headline(/^Live: one person/);
});

test('permission, absence and a camera in use are told apart', async () => {
  const context = await browser.newContext();
  const failing = await opened(context);
  for (const [name, text] of [['NotAllowedError', /^The camera is not allowed/], ['NotFoundError', /^There is no camera\.$/], ['NotReadableError', /^The camera cannot be opened\.$/]]) {
    await failing.evaluate((error) => { navigator.mediaDevices.getUserMedia = async () => { throw new DOMException('no', error); }; }, name);
    await failing.click('#run');
    await headline(text, failing);
    assert.ok((await next(failing)).length > 20);
    await failing.click('#run');
  }
  await context.close();
});

test('a link that is opened where the page is already brings its token, which leaves the address', async () => {
  const context = await browser.newContext();
  const fresh = await opened(context, '#token=an-old-token');
  await fresh.waitForFunction(() => !document.getElementById('run').disabled);
  await fresh.evaluate((token) => { location.hash = `token=${token}`; }, encodeURIComponent(CONTROL));
  await fresh.waitForFunction((token) => document.getElementById('token').value === token && location.hash === '', CONTROL);
  await context.close();
});

test('one page at a time holds a sensor; the other waits and takes over', async () => {
  const second = await opened(page.context());
  await second.click('#run');
  await headline(/^Another program holds this sensor\.$/, second);
  assert.match(await next(second), /^".*BlazePose lite" .*One camera at a time/);
  await page.click('#run');
  await headline(/^Ready\.$/);
  await headline(/^Live: one person/, second);
  await page.close();
  page = second;
});

test('a wrong token is told once, and the right one is taken', async () => {
  await page.evaluate(() => { document.getElementById('token').value = 'wrong-wrong-wrong'; document.getElementById('token').dispatchEvent(new Event('change')); });
  await headline(/^The token is wrong\.$/);
  await picture('token');
  const before = (await workshop.get(`${phone.url}metrics`)).text.match(/^chorus_http_unauthorized_total (\d+)$/m)[1];
  await page.fill('#token', READ);
  await page.press('#token', 'Enter');
  await headline(/^The token allows only reading\.$/);
  await page.fill('#token', CONTROL);
  await page.press('#token', 'Enter');
  await headline(/^Live: one person/);
  assert.equal((await workshop.get(`${phone.url}metrics`)).text.match(/^chorus_http_unauthorized_total (\d+)$/m)[1], before, 'it guesses no more');
});

test('a sensor that ends is missed, and found again', async () => {
  phone.child.kill();
  await headline(/^The sensor does not answer\.$/);
  phone = await workshop.service('chorus-sensor', 'cam01', phone.port, bridge('cam01'));
  await headline(/^Live: one person/);
});

test('nothing was asked of anybody else, and nothing complained', () => {
  assert.deepEqual(foreign, []);
  assert.deepEqual(complaints, []);
});
