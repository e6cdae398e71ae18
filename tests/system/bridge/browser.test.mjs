// services/capture/push.js in headless Chromium: a page of another origin, with a token, pushes landmarks in pixels.
import assert from 'node:assert';
import { spawn } from 'node:child_process';
import { readFile } from 'node:fs/promises';
import { createServer } from 'node:http';
import { test } from 'node:test';
import { PATIENCE_MS, launch } from '../../viewer/browser.mjs';

const BIN = process.env.CHORUS_BIN;
const TOKEN = "it's a (secret) / 100%";

async function sensorProcess(t, ...settings) {
  const child = spawn(`${BIN}/chorus-sensor`, ['--port', '0', '--log-format', 'json', '--device', 'bridge', ...settings.flatMap((s) => ['--set', s])]);
  t.after(() => child.kill());
  let log = '';
  return new Promise((resolve, reject) => {
    child.on('exit', () => reject(new Error(log)));
    child.stderr.on('data', (bytes) => {
      log += bytes;
      const url = log.match(/"url":"(http:[^"]+)"/);
      if (url) resolve(url[1]);
    });
  });
}

/// Serves push.js and an empty page.
async function pages(t) {
  const source = await readFile(new URL('../../../services/capture/push.js', import.meta.url));
  const server = createServer((request, response) => {
    const script = request.url === '/push.js';
    response.setHeader('Content-Type', script ? 'text/javascript' : 'text/html');
    response.end(script ? source : '<!doctype html><title>a page with a camera</title>');
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  t.after(() => server.close());
  return `http://127.0.0.1:${server.address().port}`;
}

async function asked(url) {
  return (await fetch(url, { headers: { Accept: 'application/json' } })).json();
}

async function until(what, condition) {
  const end = Date.now() + 30000;
  for (;;) {
    const value = await condition().catch(() => null);
    if (value) return value;
    assert.ok(Date.now() < end, what);
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
}

/// Pushes 30 frames a second of a person whose nose is at the right edge of the image, at mid-height.
async function pushFrom(page, url, token) {
  await page.evaluate(async ([where, secret]) => {
    const { Pusher } = await import('/push.js');
    const intrinsics = { width: 640, height: 480, fx: 500, fy: 500, cx: 320, cy: 240 };
    window.told = [];
    window.pusher = new Pusher(where, { name: 'page', layout: 'coco_17', intrinsics, pixelSigma: 4 },
      { token: secret, tell: (text) => window.told.push(text) });
    const pixels = Array.from({ length: 17 }, (_, i) => [i === 0 ? 320 + 500 : 320, 240, 0.9]);
    window.timer = setInterval(() => window.pusher.push([{ id: 1, pixels }]), 33);
  }, [url, token]);
}

test('a page of an allowed origin pushes rays with its token', async (t) => {
  const origin = await pages(t);
  const sensor = await sensorProcess(t, `http.bearer_token=${TOKEN}`, `http.allowed_origin=${origin}`);
  const browser = await launch();
  t.after(() => browser.close());
  const page = await browser.newPage();
  page.setDefaultTimeout(PATIENCE_MS);
  await page.goto(origin);
  await pushFrom(page, sensor.replace('http', 'ws') + 'push', TOKEN);
  const state = await until('frames are taken', async () => {
    const now = await asked(`${sensor}push`);
    return now.pusher?.frames > 20 && now;
  });
  assert.equal(state.state, 'live');
  assert.equal(state.pusher.refused, 0, JSON.stringify(state));
  assert.ok(Math.abs(state.pusher.clockOffsetMilliseconds) < 20, 'one computer, one clock');
  const frame = await asked(`${sensor}frame`);
  const ray = frame.bodies[0].joints.ShoulderLeft;
  assert.deepEqual([ray.rayX, ray.rayY, ray.rayZ], [0, 0, 1]);
  assert.ok(ray.cxx > 0 && !('x' in ray), 'a ray with its covariance, and no place');
  assert.deepEqual(await page.evaluate(() => window.told), []);
  await page.evaluate(() => { clearInterval(window.timer); window.pusher.close(); });
  await until('that it left shows', async () => (await asked(`${sensor}push`)).state === 'waiting');
});

test('a page that may not push gets no further', async (t) => {
  const origin = await pages(t);
  const sensor = await sensorProcess(t, 'http.bearer_token=the-right-token', `http.allowed_origin=${origin}`);
  const closed = await sensorProcess(t, 'http.bearer_token=the-right-token');
  const browser = await launch();
  t.after(() => browser.close());
  for (const [url, token] of [[sensor, 'wrong'], [sensor, ''], [closed, 'the-right-token']]) {
    const page = await browser.newPage();
    page.setDefaultTimeout(PATIENCE_MS);
    await page.goto(origin);
    await pushFrom(page, url.replace('http', 'ws') + 'push', token);
    await new Promise((resolve) => setTimeout(resolve, 1500));
    assert.equal(await page.evaluate(() => window.pusher.welcome), null);
    assert.equal((await asked(`${url}push`)).state, 'waiting');
    await page.close();
  }
});
