// MoveNet MultiPose: up to six people with 17 COCO key points each, in one pass over the whole image.
import { cropped, toImage, wholeImage } from './crop.js';
import { People, overlap, placeOf } from './people.js';

const SIDE = 256;
const PEOPLE = 6;
const KEY_POINTS = 17;
const ROW = 56; // 17 x (y, x, score), the box, its score
const LEAST_PERSON = 0.25;
const LEAST_LANDMARK = 0.2;
const LEAST_LANDMARKS = 5;
const SAME_PERSON = 0.65; // two answers that overlap more are one person

export const HELLO = {
  name: 'MoveNet MultiPose', layout: 'coco_17', trackedFrom: 0.35, inferredFrom: LEAST_LANDMARK, pixelSigma: 2, image: { maxSide: SIDE },
};
export const FILES = ['movenet-multipose'];

/// People from the network's output: [{score, pixels: [[u, v, score], ...]}], most certain first, nobody twice.
export function readPeople(values, square) {
  const people = [];
  for (let row = 0; row < PEOPLE; ++row) {
    const at = row * ROW;
    const score = values[at + ROW - 1];
    if (!(score >= LEAST_PERSON)) continue;
    const pixels = [];
    for (let i = 0; i < KEY_POINTS; ++i) {
      const [v, u, sure] = [values[at + 3 * i], values[at + 3 * i + 1], values[at + 3 * i + 2]];
      pixels.push([...toImage(square, u, v), sure]);
    }
    const place = placeOf(pixels, LEAST_LANDMARK);
    const many = pixels.filter((pixel) => pixel[2] >= LEAST_LANDMARK).length >= LEAST_LANDMARKS;
    if (place && many) people.push({ score, pixels, place });
  }
  people.sort((a, b) => b.score - a.score);
  return people.filter((one, i) => people.slice(0, i).every((other) => overlap(one.place, other.place) < SAME_PERSON));
}

export class MoveNet {
  constructor(tf, models) {
    this.tf = tf;
    this.network = models['movenet-multipose'];
    this.people = new People();
  }

  /// The bodies of a frame (proto/bridge.md, section 3).  `time`: its capture time [s].
  async bodies(image, time) {
    const square = wholeImage(image.width, image.height);
    const input = this.tf.tensor4d(cropped(image, square, SIDE, Int32Array, 1), [1, SIDE, SIDE, 3], 'int32');
    const output = this.network.execute(input);
    const people = readPeople(await output.data(), square);
    this.tf.dispose([input, output]);
    const numbers = this.people.numbers(people.map((person) => person.place), time);
    return people.map(({ pixels }, i) => ({ id: numbers[i], pixels: pixels.map(seen) }));
  }
}

const round = (value, digits) => Number(value.toFixed(digits));
const seen = ([u, v, sure]) => (sure >= LEAST_LANDMARK ? [round(u, 2), round(v, 2), round(Math.min(1, sure), 3)] : null);
