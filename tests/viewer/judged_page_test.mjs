// What the page shows where worn sensors judge the tracker.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { fileURLToPath } from 'node:url';

import { launch, openViewer } from './browser.mjs';
import { startFakeFusion, usualWorld } from './fake_fusion.mjs';

const SOON = {}; // as long as browser.mjs has patience
const FILES = fileURLToPath(new URL('../../services/viewer/', import.meta.url));
let browser;
const servers = [];

async function startFusion(files, world) {
  servers.push(await startFakeFusion(files, world));
  return servers.at(-1);
}

async function picture(page, name) {
  if (process.env.CHORUS_SCREENSHOTS) await page.screenshot({ path: `${process.env.CHORUS_SCREENSHOTS}/${name}.png` });
}

before(async () => { browser = await launch(); });
after(async () => {
  await browser?.close();
  for (const server of servers) server.stop();
});

test('limbs that worn sensors contradict are named, and only where somebody judges the tracker', async () => {
  const world = usualWorld();
  const limb = (name, state, comment) => ({ bodyId: 1, limb: name, state, comment });
  world.evaluation = { sequence: 1, limbs: [limb('Chest', 'good', 'chest agrees'),
    limb('ForearmLeft', 'off', 'left forearm off by 70 deg for 4 s')] };
  const server = await startFusion(FILES, world);
  const { page } = await openViewer(browser, server.url);
  await page.waitForFunction(() => document.getElementById('judged')?.textContent.includes('off by 70 deg'), null, SOON);
  assert.deepEqual(await page.$$eval('#judged li', (lines) => lines.map((line) => line.textContent)),
    ['left forearm off by 70 deg for 4 s', 'one limb agrees']);
  await page.close();
  const { page: plain } = await openViewer(browser, (await startFusion(FILES)).url);
  await plain.waitForFunction(() => window.chorusViewer.fusedFrames > 5, null, SOON);
  assert.equal(await plain.$('#judged'), null);
  await plain.close();
});

test('the axes of judged limbs are drawn when somebody wants them', async () => {
  const world = usualWorld();
  const turn = (degrees) => [Math.sin((degrees * Math.PI) / 360), Math.cos((degrees * Math.PI) / 360)];
  const limb = (name, off, extra) => {
    const [[qx, qw], [predictedQx, predictedQw]] = [turn(180), turn(180 - off)];
    return { bodyId: 1, limb: name, state: off > 45 ? 'off' : 'good', comment: name, qx, qy: 0, qz: 0, qw, predictedQx, predictedQy: 0, predictedQz: 0, predictedQw, ...extra };
  };
  world.evaluation = { sequence: 1, limbs: [limb('Chest', 5, { twistDegrees: 2 }), limb('ForearmLeft', 70), limb('ShankRight', 8, { twistDegrees: 6 }),
    { bodyId: 1, limb: 'ShankLeft', state: 'calibrating', comment: 'left shank: calibrates' }, limb('HandLeft', 5, { bodyId: 9 })] };
  const { page, complaints } = await openViewer(browser, (await startFusion(FILES, world)).url);
  await page.waitForFunction(() => document.getElementById('judged') && window.chorusViewer.fusedFrames > 5, null, SOON);
  assert.equal(await page.evaluate(() => window.chorusViewer.limbAxes), 0, 'nobody has asked for them');
  await page.keyboard.press('i');
  await page.waitForFunction(() => window.chorusViewer.limbAxes === 3, null, SOON); // not of somebody who is not in sight
  await page.getByRole('tab', { name: 'View' }).click();
  assert.equal(await page.isChecked('#show-axes'), true);
  await picture(page, 'axes');
  await page.uncheck('#show-axes');
  await page.waitForFunction(() => window.chorusViewer.limbAxes === 0, null, SOON);
  assert.deepEqual(complaints, []);
  await page.close();
});
