// The viewer alone, against made-up JSON: it draws, names states, survives a server that goes away.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { fileURLToPath } from 'node:url';

import { colorsOnCanvas, launch, openViewer } from './browser.mjs';
import { startFakeFusion } from './fake_fusion.mjs';

const FILES = fileURLToPath(new URL('../../services/viewer/', import.meta.url));
let browser;
let fusion;

before(async () => {
  browser = await launch();
  fusion = await startFakeFusion(FILES);
});
after(async () => {
  await browser?.close();
  fusion?.stop();
});

test('draws the fused body, the raw one of the live sensor, and both sensors', async () => {
  const { page, complaints } = await openViewer(browser, `http://127.0.0.1:${fusion.port}/viewer/`);
  await page.waitForFunction(() => window.chorusViewer?.fusedFrames > 20 && window.chorusViewer.rawBones.s1 > 0, null, { timeout: 30000 });
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

test('says so when the server goes away', async () => {
  const doomed = await startFakeFusion(FILES);
  const { page } = await openViewer(browser, `http://127.0.0.1:${doomed.port}/viewer/`);
  await page.waitForFunction(() => window.chorusViewer?.fusedFrames > 2, null, { timeout: 30000 });
  doomed.stop();
  await page.waitForFunction(() => document.getElementById('headline').textContent.startsWith('no answer'), null, { timeout: 15000 });
  await page.close();
});
