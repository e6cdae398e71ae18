// The lens that the capture page states: from a field of view, and from the file of a calibration.
import assert from 'node:assert/strict';
import { test } from 'node:test';

import { lensOfCalibration, lensOfView, readCalibration, sentSize, viewOf } from '../../services/capture/lens.js';

const near = (a, b, by = 1e-9) => assert.ok(Math.abs(a - b) <= by, `${a} is not ${b}`);
const degrees = (radians) => (radians * 180) / Math.PI;
const FILE = { width: 1280, height: 720, fx: 905, fy: 904, cx: 639.5, cy: 359.5, distortion: [0.04, -0.1, 0, 0, 0] };

test('a picture is sent no larger than the model uses it, in its own shape', () => {
  assert.deepEqual(sentSize({ width: 1280, height: 720 }, 256), { width: 256, height: 144 });
  assert.deepEqual(sentSize({ width: 720, height: 1280 }, 640), { width: 360, height: 640 });
  assert.deepEqual(sentSize({ width: 320, height: 240 }, 640), { width: 320, height: 240 });
});

test('the field of view is that of the longer side, upright or not', () => {
  for (const sent of [{ width: 640, height: 360 }, { width: 360, height: 640 }]) {
    const { intrinsics } = lensOfView({ fov: 65, sigma: 6 }, sent);
    near(degrees(2 * Math.atan(320 / intrinsics.fx)), 65, 1e-6);
    assert.equal(intrinsics.fx, intrinsics.fy);
    assert.deepEqual([intrinsics.cx, intrinsics.cy], [sent.width / 2, sent.height / 2]);
  }
});

test('what is uncertain of the field of view is what the focal length would change by', () => {
  const sent = { width: 640, height: 360 };
  const [here, there] = [65, 65.1].map((fov) => lensOfView({ fov, sigma: 0.1 }, sent));
  near(here.focalSigma, Math.log(here.intrinsics.fx / there.intrinsics.fx), 1e-5);
});

test('a calibration is scaled from pixel centres to the corners of the picture as sent', () => {
  const { intrinsics, focalSigma } = lensOfCalibration(FILE, { width: 1920, height: 1080 }, { width: 640, height: 360 });
  assert.equal(focalSigma, 0);
  assert.deepEqual(intrinsics, { width: 640, height: 360, fx: 452.5, fy: 452, cx: 320, cy: 180, distortion: FILE.distortion });
  assert.throws(() => lensOfCalibration(FILE, { width: 720, height: 1280 }, { width: 360, height: 640 }), /for pictures of 1280 x 720, and the camera gives 720 x 1280/);
});

test('a calibration is read alone or in a sensor’s configuration, and refused with words', () => {
  assert.deepEqual(readCalibration(JSON.stringify(FILE)), FILE);
  assert.deepEqual(readCalibration(JSON.stringify({ device: { camera: { intrinsics: FILE } } })), FILE);
  assert.deepEqual(readCalibration(JSON.stringify({ intrinsics: FILE, error: 0.3 })), FILE);
  const unsure = readCalibration(JSON.stringify({ ...FILE, focal_sigma_percent: 0.2 }));
  assert.equal(lensOfCalibration(unsure, FILE, { width: 640, height: 360 }).focalSigma, 0.002);
  assert.throws(() => readCalibration(JSON.stringify({ ...FILE, focal_sigma_percent: -1 })), /0 to 50 percent/);
  assert.throws(() => readCalibration('a picture'), /no JSON/);
  assert.throws(() => readCalibration('null'), /has no width, height/);
  assert.throws(() => readCalibration(JSON.stringify({ ...FILE, fy: '904' })), /has no fy/);
  assert.throws(() => readCalibration(JSON.stringify({ ...FILE, fy: 0 })), /at least one pixel/);
  assert.throws(() => readCalibration(JSON.stringify({ ...FILE, distortion: [1, 2] })), /five numbers/);
});

test('the view is told in degrees', () => assert.equal(viewOf(FILE), '71 x 43 degrees'));
