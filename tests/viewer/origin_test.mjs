// Where a person shows the origin: the rules of `chorus origin --here` in the viewer.
import assert from 'node:assert/strict';
import test from 'node:test';

import { stanceIn, steady } from '../../services/viewer/origin.js';

/// A person at (x, z) who faces `yaw` [deg]; left relates to front as +x to +z.
function body(x, z, yaw, about = { sidesConfidence: 0.99 }) {
  const angle = (Math.PI * yaw) / 180;
  const at = (left) => ({ x: x + left * Math.cos(angle), y: 1, z: z - left * Math.sin(angle) });
  const joints = { SpineBase: at(0), HipLeft: at(0.1), HipRight: at(-0.1), ShoulderLeft: at(0.2), ShoulderRight: at(-0.2) };
  return { ...about, joints };
}
const frame = (...bodies) => ({ bodies });

test('a stance is where pelvis and front are', () => {
  for (const yaw of [0, 30, 90, 179, -120]) {
    const stance = stanceIn(frame(body(1.5, -2, yaw)));
    assert.ok(Math.abs(stance.x - 1.5) < 1e-9 && Math.abs(stance.z + 2) < 1e-9);
    assert.ok(Math.abs(stance.yaw - yaw) < 1e-9, `${yaw}: ${stance.yaw}`);
  }
});

test('a stance is of one person whose front is known', () => {
  assert.match(stanceIn(frame()).problem, /nobody/);
  assert.match(stanceIn(null).problem, /nobody/);
  assert.match(stanceIn(frame(body(0, 0, 0), body(1, 0, 0))).problem, /more than one/);
  assert.match(stanceIn(frame(body(0, 0, 0, { sidesConfidence: 0.6 }))).problem, /uncertain/);
  const half = body(0, 0, 0);
  delete half.joints.HipLeft;
  assert.match(stanceIn(frame(half)).problem, /not seen/);
});

test('who stands still gives the mean, also across the turn', () => {
  const seen = [178, -178, 178, -178, 178, -178].map((yaw, i) => ({ x: 0.01 * i, z: 1, yaw }));
  const mean = steady(seen);
  assert.ok(Math.abs(mean.x - 0.025) < 1e-9);
  assert.ok(Math.abs(Math.abs(mean.yawDegrees) - 180) < 1e-6);
});

test('who moves or turns gives none', () => {
  const still = Array.from({ length: 6 }, () => ({ x: 1, z: 1, yaw: 0 }));
  assert.ok(!steady(still).problem);
  assert.match(steady(still.slice(0, 4)).problem, /too few/);
  assert.match(steady([...still, { x: 1.2, z: 1, yaw: 0 }]).problem, /moved/);
  assert.match(steady([...still, { x: 1, z: 1, yaw: 20 }]).problem, /moved/);
});
