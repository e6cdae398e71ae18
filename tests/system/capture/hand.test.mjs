// The page that measures a hand, as a person uses it: a photo in, a skeleton or a refusal out.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';

import { CONTROL, READ, ROOT, Workshop, freePort } from './rig.mjs';

const SCAN = join(ROOT, 'tests/data/hand/scan.png'); // a drawn hand on a whole sheet of A4
const TRUTH = JSON.parse(readFileSync(join(ROOT, 'tests/data/hand/truth.json'), 'utf8'));
const GREY = Buffer.from('iVBORw0KGgoAAAANSUhEUgAAAEAAAABACAAAAACPAi4CAAAAKUlEQVR42u3MQREAAAwCIKMb3RD77SAA6VEEAoFAIBAIBAKBQCAQfA8G320AeXC6efoAAAAASUVORK5CYII=', 'base64');
let workshop;
let browser;
let sensor;
let page;
const complaints = [];

const headline = async (pattern, seconds = 90) => {
  await page.waitForFunction((source) => new RegExp(source).test(document.getElementById('headline').textContent), pattern.source, { timeout: seconds * 1000 });
  return page.textContent('#next');
};

before(async () => {
  workshop = new Workshop();
  sensor = await workshop.service('chorus-sensor', 'phone', await freePort(), { id: 'phone', device: { kind: 'bridge', bridge: { page: true } } });
  browser = await workshop.browser();
  page = await (await browser.newContext({ viewport: { width: 390, height: 844 } })).newPage();
  page.on('pageerror', (error) => complaints.push(String(error)));
  page.on('console', (message) => { if (/Content Security Policy|Uncaught/.test(message.text())) complaints.push(message.text()); });
  await page.goto(`${sensor.url}capture/hand.html#token=${encodeURIComponent(CONTROL)}`);
});
after(async () => {
  await browser?.close();
  workshop?.close();
});

test('a photo on a sheet of A4 becomes a skeleton in millimetres', async () => {
  assert.match(await headline(/^Ready/), /not kept/);
  await page.setInputFiles('#photo', SCAN);
  const next = await headline(/^A right hand, its (palm|back) seen/);
  assert.match(next, /A4/);
  const report = JSON.parse(decodeURIComponent((await page.getAttribute('#json', 'href')).split(',')[1]));
  assert.equal(report.relative, false);
  for (const [name, finger] of Object.entries(TRUTH.fingers))
    assert.ok(Math.abs(report.fingers[name].fromWebMm / finger.fromWebMm - 1) < 0.06, `${name}: ${report.fingers[name].fromWebMm} of ${finger.fromWebMm} mm`);
  const bvh = decodeURIComponent((await page.getAttribute('#bvh', 'href')).split(',')[1]);
  assert.match(bvh, /^HIERARCHY\nROOT RightHand\n/);
  assert.match(decodeURIComponent((await page.getAttribute('#htr', 'href')).split(',')[1]), /\[SegmentNames&Hierarchy\][^]*RightHandThumb1/);
  assert.equal(await page.locator('#lengths tr').count(), 5);
  const drawn = await page.evaluate(async () => { const image = document.getElementById('drawn'); await image.decode(); return image.naturalWidth; });
  assert.ok(drawn > 300, `the annotated picture is ${drawn} pixels wide`);
  if (process.env.CHORUS_SCREENSHOTS) await page.screenshot({ path: `${process.env.CHORUS_SCREENSHOTS}/hand.png`, fullPage: true });
});

test('what is no hand, or no picture, is refused in words', async () => {
  await page.setInputFiles('#photo', { name: 'grey.png', mimeType: 'image/png', buffer: GREY });
  assert.ok((await headline(/^This photo is refused/)).length > 20);
  assert.equal(await page.isHidden('#result'), true);
  await page.setInputFiles('#photo', { name: 'photo.heic', mimeType: 'image/heic', buffer: Buffer.from('no picture') });
  assert.match(await headline(/^This photo is not measured/), /JPEG/);
  await page.selectOption('#scale', 'card');
  await page.setInputFiles('#photo', SCAN);
  assert.match(await headline(/^This photo is refused/), /bank card/);
  if (process.env.CHORUS_SCREENSHOTS) await page.screenshot({ path: `${process.env.CHORUS_SCREENSHOTS}/hand-refused.png`, fullPage: true });
});

test('a token that only reads is told so', async () => {
  await page.fill('#token', READ);
  await page.dispatchEvent('#token', 'change');
  await page.setInputFiles('#photo', SCAN);
  assert.match(await headline(/allows only reading/), /control/);
  assert.deepEqual(complaints, []);
});
