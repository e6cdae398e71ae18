// Hands from what the networks say.
import assert from 'node:assert/strict';
import { test } from 'node:test';

import { wholeImage } from '../../services/pose-runner/crop.js';
import { anchors, distinct, readHand, readPalms, squareOf } from '../../services/pose-runner/hands.js';

function answer(homes, at, score, palm) {
  const values = new Float32Array(homes.length * 19).fill(0);
  for (let i = 0; i < homes.length; ++i) values[i * 19] = -5;
  values.set([score, ...palm], at * 19);
  return values;
}
// Box of 64 x 64 pixels at the anchor; wrist below it, base of the middle finger above.
const UPRIGHT = [0, 0, 64, 64, 0, 40, 0, 0, 0, -40, 0, 0, 0, 0, 0, 0, 0, 0];

test('the surest answers of the palm detector are squares whose upper side is towards the fingers', () => {
  const homes = anchors();
  assert.equal(homes.length, 2944);
  const [palm, ...none] = readPalms(answer(homes, 1000, 3, UPRIGHT), homes, wholeImage(512, 512));
  assert.equal(none.length, 0);
  assert.ok(Math.abs(palm.square.angle) < 1e-6);
  assert.ok(Math.abs(palm.size - 128) < 1e-3 && Math.abs(palm.square.size - 2.6 * 128) < 1e-2);
  assert.ok(palm.square.y < palm.y);
  assert.deepEqual(readPalms(answer(homes, 1000, -1, UPRIGHT), homes, wholeImage(512, 512)), []);
});

test('a palm in a turned picture points sideways in the image', () => {
  const homes = anchors();
  const turned = { ...wholeImage(512, 512), angle: Math.PI / 2 };
  const [palm] = readPalms(answer(homes, 1000, 3, UPRIGHT), homes, turned);
  assert.ok(Math.abs(palm.square.angle - Math.PI / 2) < 1e-6);
});

test('the same palm in several turns is one, two hands are two', () => {
  const at = (x, score) => ({ x, y: 100, size: 80, score });
  assert.deepEqual(distinct([at(100, 0.7), at(110, 0.9), at(300, 0.8)]).map((palm) => palm.score), [0.9, 0.8]);
});

test('landmarks are pixels of the image, and the side is the network\'s', () => {
  const values = new Float32Array(63).map((_, i) => (i % 3 === 0 ? 112 : 56));
  const hand = readHand(values, 0.9, 0.8, { x: 100, y: 100, size: 224, angle: 0 });
  assert.deepEqual([hand.side, hand.score], ['right', 0.9]);
  assert.deepEqual(hand.pixels[0].slice(0, 2), [100, 44]);
  const left = readHand(values, 0.9, 0.1, { x: 0, y: 0, size: 224, angle: 0 });
  assert.equal(left.side, 'left');
  assert.ok(Math.abs(left.sideScore - 0.9) < 1e-9);
});

test('the square of the next look is turned as the hand is', () => {
  const pixels = Array.from({ length: 21 }, (_, i) => [100 + 10 * i, 100 + (i % 4), 0]);
  assert.ok(Math.abs(squareOf(pixels).angle - Math.PI / 2) < 0.2);
});
