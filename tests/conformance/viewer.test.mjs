// The viewer shows the real fusion server in headless Chromium: six sensors, a person walking, no error reported.
import assert from 'node:assert/strict';
import { test } from 'node:test';

import { colorsOnCanvas, launch, openViewer } from '../viewer/browser.mjs';

const fusion = process.env.CHORUS_FUSION_URL;
assert.ok(fusion, 'CHORUS_FUSION_URL names a running fusion server');

test('the viewer shows the fused person and every raw one, live', async () => {
  const browser = await launch();
  try {
    const { page, complaints } = await openViewer(browser, `${fusion}/viewer/`);
    await page.waitForFunction(
      () => window.chorusViewer?.fusedJoints >= 20 && Object.values(window.chorusViewer.rawBones).filter((n) => n > 0).length >= 2);
    const before = await page.evaluate(() => window.chorusViewer.fusedFrames);
    await page.waitForFunction((seen) => window.chorusViewer.fusedFrames > seen + 5, before); // frames keep coming
    assert.equal(await page.evaluate(() => window.chorusViewer.sensors), 6);
    // The headline says when the walk is still being registered; after half a minute the registration is good.
    await page.waitForFunction(() => document.querySelector('#headline').textContent.startsWith('Live: one person'));
    assert.equal(await page.locator('#sensors [data-sensor]').count(), 6);
    assert.ok(await colorsOnCanvas(page) > 50, 'something is drawn');
    await page.keyboard.press('u');
    await page.waitForFunction(() => window.chorusViewer.ellipsoids >= 20); // the server states covariances
    await page.waitForFunction(() => /person \d+: seen, (\d+ cm, )?left and right \d+ % certain/.test(document.querySelector('#people li')?.textContent));
    assert.deepEqual(complaints, []);
    if (process.env.CHORUS_SCREENSHOT) await page.screenshot({ path: process.env.CHORUS_SCREENSHOT });
  } finally {
    await browser.close();
  }
});
