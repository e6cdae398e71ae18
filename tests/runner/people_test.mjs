// Numbers given to people, and people computed from the output of the networks.
import assert from 'node:assert/strict';
import { test } from 'node:test';

import { anchors, detected, maskOf, readLandmarks, squareAround } from '../../services/pose-runner/blazepose.js';
import { cropped, toImage, wholeImage } from '../../services/pose-runner/crop.js';
import { readPeople } from '../../services/pose-runner/movenet.js';
import { People, placeOf } from '../../services/pose-runner/people.js';

const at = (x, y = 100) => ({ x, y, left: x - 20, right: x + 20, top: y - 50, bottom: y + 50, size: 100 });

test('a person keeps his number while he walks, and two who pass keep theirs', () => {
  const people = new People();
  assert.deepEqual(people.numbers([at(100), at(300)], 0), [1, 2]);
  assert.deepEqual(people.numbers([at(310), at(90)], 0.1), [2, 1]);
  assert.deepEqual(people.numbers([at(300)], 0.2), [2]);
  assert.deepEqual(people.numbers([at(95), at(305)], 0.3), [1, 2]);
});

test('who comes back late or far away gets a new number', () => {
  const people = new People();
  people.numbers([at(100)], 0);
  assert.deepEqual(people.numbers([at(300)], 0.1), [2]);
  assert.deepEqual(people.numbers([at(300)], 1.2), [3]);
});

function row(x, y, score, pointScore = 0.9) {
  const points = Array.from({ length: 17 }, (_, i) => [y + i * 0.02, x + (i % 3) * 0.03, pointScore]).flat();
  return [...points, 0, 0, 0, 0, score];
}
const rows = (...some) => Float32Array.from([...some, ...Array(6 - some.length).fill(row(0, 0, 0))].flat());

test('MoveNet: pixels of the image, nobody twice, nobody who is hardly there', () => {
  const square = wholeImage(256, 128); // a wide image lies at mid-height of the square
  const people = readPeople(rows(row(0.25, 0.25, 0.8), row(0.252, 0.25, 0.6), row(0.7, 0.4, 0.3), row(0.5, 0.3, 0.2), row(0.1, 0.3, 0.9, 0.1)), square);
  assert.deepEqual(people.map((person) => person.score.toFixed(1)), ['0.8', '0.3']);
  const [u, v, sure] = people[0].pixels[0];
  assert.ok(Math.abs(u - 64) < 1e-3 && Math.abs(v) < 1e-3 && Math.abs(sure - 0.9) < 1e-6);
});

test('BlazePose: an upright person gives a square that is not turned, one who lies a turned one', () => {
  assert.deepEqual(squareAround([100, 200], [100, 120]), { x: 100, y: 200, size: 200, angle: 0 });
  assert.equal(squareAround([100, 200], [180, 200]).angle, Math.PI / 2);
});

test('BlazePose: the surest answer of the detector is where it looks', () => {
  const homes = anchors();
  assert.equal(homes.length, 2254);
  const values = new Float32Array(homes.length * 13).fill(0);
  for (let i = 0; i < homes.length; ++i) values[i * 13] = -5;
  assert.equal(detected(values, homes, wholeImage(224, 224)), null);
  const cell = 2 * (28 * 14 + 14);
  values[cell * 13] = 4;
  values[cell * 13 + 8] = -56; // its second key point is a quarter of the image above the first
  const square = detected(values, homes, wholeImage(224, 224));
  assert.deepEqual([square.x, square.y, square.size, Math.abs(square.angle)].map(Math.round), [116, 116, 140, 0]);
});

test('BlazePose: landmarks leave the turned square, metres turn with it', () => {
  const values = new Float32Array(195);
  const world = new Float32Array(117);
  [values[0], values[1], values[3], values[4]] = [256, 128, 9, 9]; // the middle of the right edge
  [world[0], world[1], world[2]] = [1, 0, 0.5];
  const { pixels, metres } = readLandmarks(values, world, { x: 50, y: 50, size: 20, angle: Math.PI / 2 });
  assert.deepEqual(pixels[0], [50, 60, 1]);
  assert.deepEqual(metres[0].map((c) => Math.abs(c)), [0, 1, 0.5]);
  assert.equal(metres[0][1], 1);
});

test('a crop shows the place it is asked for, and black outside', () => {
  const [width, height] = [8, 4];
  const pixels = new Uint8Array(width * height * 3);
  for (let i = 0; i < width * height; ++i) pixels[3 * i] = (i % width) * 10;
  const whole = cropped({ width, height, pixels }, wholeImage(width, height), 8, Int32Array, 1);
  const red = (x, y) => whole[(y * 8 + x) * 3];
  assert.deepEqual([red(0, 2), red(5, 2), red(7, 5), red(5, 1), red(5, 6)], [0, 50, 70, 0, 0]);
  assert.deepEqual(toImage(wholeImage(width, height), 0, 0), [0, -2]);
});

test('a place spans what is seen', () => {
  assert.equal(placeOf([null, [1, 2, 0.1]]), null);
  assert.deepEqual(placeOf([[0, 0, 1], [10, 40, 1], [900, 900, 0.1]]).size, 40);
});

test('BlazePose: a mask is what the network says of its square, in cells of the whole image', () => {
  const cover = new Float32Array(256 * 256);
  for (let v = 128; v < 256; ++v) cover.fill(0.9, v * 256, v * 256 + 256); // the lower half of the square
  const image = { width: 8, height: 4 };
  assert.deepEqual(maskOf(cover, { x: 4, y: 2, size: 4, angle: 0 }, image), { width: 8, height: 4, runs: [18, 4, 4, 4, 2] });
  // Turned by a quarter, the lower half of the square lies to the left in the image.
  assert.deepEqual(maskOf(cover, { x: 4, y: 2, size: 4, angle: Math.PI / 2 }, image).runs, [2, 2, 6, 2, 6, 2, 6, 2, 4]);
  const large = maskOf(cover, { x: 320, y: 180, size: 100, angle: 0 }, { width: 640, height: 360 });
  assert.deepEqual([large.width, large.height, large.runs.reduce((sum, n) => sum + n)], [256, 144, 256 * 144]);
});
