// Hands: a palm detector looks at the whole image in four turns, because scans lie as they were put
// on the glass; then each palm is looked at closely for 21 landmarks and its side.
import { cropped, toImage, wholeImage } from './crop.js';

const DETECTOR_SIDE = 256;
const SIDE = 224;
const LANDMARKS = 21;
const DETECTION = 19; // logit, box, seven key points
const TURNS = 4;
const LEAST_PALM = 0.5;
const LEAST_HAND = 0.5;
const MOST_PALMS = 4;
const SAME_PALM = 0.5; // two palms nearer than this share of the larger one's side are one
const LOOKS = 2; // the second look is centred by what the first one found
const WRIST = 0; // of the detector's key points
const MIDDLE_BASE = 2;
// From MediaPipe's hand graph: the square around a palm reaches to the finger tips.
const PALM_SHIFT = 0.5;
const PALM_SCALE = 2.6;
const HAND_SHIFT = 0.1;
const HAND_SCALE = 2;
const STEADY = [0, 1, 2, 3, 5, 6, 9, 10, 13, 14, 17, 18]; // landmarks that move little when fingers bend

export const FILES = ['handdetect', 'handlandmark-full'];
export const HELLO = { version: 2, name: 'MediaPipe Hands full', layout: 'hand_21', gives: ['hands'], pixelSigma: 4, image: { maxSide: 1024 } };

const sigmoid = (x) => 1 / (1 + Math.exp(-x));
const round = (value, digits) => Number(value.toFixed(digits));
const mean = (numbers) => numbers.reduce((sum, each) => sum + each, 0) / numbers.length;

/// The places that the detector's answers are relative to: centres of cells, 0 to 1.
export function anchors() {
  const list = [];
  for (const [cells, each] of [[32, 2], [16, 2], [8, 6]]) {
    for (let y = 0; y < cells; ++y) {
      for (let x = 0; x < cells; ++x) {
        for (let i = 0; i < each; ++i) list.push([(x + 0.5) / cells, (y + 0.5) / cells]);
      }
    }
  }
  return list;
}

/// A square of this size, moved by `shift` of its size towards the fingers; those point upwards in it.
function handSquare([x, y], [towardsX, towardsY], size, shift, scale) {
  const length = Math.hypot(towardsX, towardsY) || 1;
  const [ux, uy] = [towardsX / length, towardsY / length];
  return { x: x + ux * shift * size, y: y + uy * shift * size, size: size * scale, angle: Math.atan2(ux, -uy) };
}

/// The palms in the detector's answer about `square`: [{score, x, y, size, square}].
export function readPalms(values, homes, square) {
  const palms = [];
  for (let i = 0; i < homes.length; ++i) {
    const at = i * DETECTION;
    const score = sigmoid(values[at]);
    if (!(score >= LEAST_PALM)) continue;
    const place = (offset) => toImage(square, values[at + offset] / DETECTOR_SIDE + homes[i][0], values[at + offset + 1] / DETECTOR_SIDE + homes[i][1]);
    const [x, y] = place(1);
    const size = (Math.max(values[at + 3], values[at + 4]) / DETECTOR_SIDE) * square.size;
    const [wrist, middle] = [place(5 + 2 * WRIST), place(5 + 2 * MIDDLE_BASE)];
    palms.push({ score, x, y, size, square: handSquare([x, y], [middle[0] - wrist[0], middle[1] - wrist[1]], size, PALM_SHIFT, PALM_SCALE) });
  }
  return palms;
}

/// The surest first, each place once.
export function distinct(found) {
  const sorted = [...found].sort((a, b) => b.score - a.score);
  const near = (a, b) => Math.hypot(a.x - b.x, a.y - b.y) < SAME_PALM * Math.max(a.size, b.size);
  return sorted.filter((one, i) => sorted.slice(0, i).every((other) => !near(one, other)));
}

/// The square for the next look: around the landmarks that say where the hand is.
export function squareOf(pixels) {
  const towards = [mean([5, 9, 13].map((i) => pixels[i][0])) - pixels[0][0], mean([5, 9, 13].map((i) => pixels[i][1])) - pixels[0][1]];
  const angle = Math.atan2(towards[0], -towards[1]);
  const [cos, sin] = [Math.cos(angle), Math.sin(angle)];
  const turned = STEADY.map((i) => [pixels[i][0] * cos + pixels[i][1] * sin, -pixels[i][0] * sin + pixels[i][1] * cos]);
  const range = (axis) => [Math.min(...turned.map((p) => p[axis])), Math.max(...turned.map((p) => p[axis]))];
  const [[left, right], [top, bottom]] = [range(0), range(1)];
  const [u, v] = [(left + right) / 2, (top + bottom) / 2];
  return handSquare([u * cos - v * sin, u * sin + v * cos], towards, Math.max(right - left, bottom - top), HAND_SHIFT, HAND_SCALE);
}

/// A hand in pixels of the image.  `right`: how sure the network is that it is a right one, palm or back; the picture is not mirrored.
export function readHand(values, sure, right, square) {
  const pixels = [];
  for (let i = 0; i < LANDMARKS; ++i) {
    const [u, v] = toImage(square, values[3 * i] / SIDE, values[3 * i + 1] / SIDE);
    pixels.push([round(u, 2), round(v, 2), round((values[3 * i + 2] / SIDE) * square.size, 2)]);
  }
  const isLeft = right < 0.5;
  const [x, y] = [mean(pixels.map((p) => p[0])), mean(pixels.map((p) => p[1]))];
  const size = square.size / HAND_SCALE;
  return { score: sure, side: isLeft ? 'left' : 'right', sideScore: isLeft ? 1 - right : right, pixels, x, y, size };
}

export class Hands {
  constructor(tf, models) {
    this.tf = tf;
    this.detector = models.handdetect;
    this.network = models['handlandmark-full'];
    this.homes = anchors();
  }

  /// No bodies: this model finds hands alone.
  async bodies() {
    return [];
  }

  /// The hands of a frame (proto/runner.md, section 5), the surest first.
  async hands(image) {
    const palms = [];
    for (let turn = 0; turn < TURNS; ++turn) palms.push(...(await this.#detect(image, (turn * Math.PI) / 2)));
    const hands = [];
    for (const palm of distinct(palms).slice(0, MOST_PALMS)) {
      const hand = await this.#lookClosely(image, palm.square);
      if (hand) hands.push(hand);
    }
    return distinct(hands).map(({ score, side, sideScore, pixels }) => ({ score: round(score, 3), side, sideScore: round(sideScore, 3), pixels }));
  }

  async #detect(image, angle) {
    const square = { ...wholeImage(image.width, image.height), angle };
    const pixels = cropped(image, square, DETECTOR_SIDE, Float32Array, 1 / 127.5).map((value) => value - 1); // -1 to 1
    const input = this.tf.tensor4d(pixels, [1, DETECTOR_SIDE, DETECTOR_SIDE, 3]);
    const output = this.detector.execute(input);
    const values = await output.data();
    this.tf.dispose([input, output]);
    return readPalms(values, this.homes, square);
  }

  async #lookClosely(image, first) {
    let hand = null;
    for (let look = 0, square = first; look < LOOKS; ++look, square = squareOf(hand.pixels)) {
      const seen = await this.#landmarks(image, square);
      if (seen.score < LEAST_HAND) return hand;
      hand = seen;
    }
    return hand;
  }

  async #landmarks(image, square) {
    const input = this.tf.tensor4d(cropped(image, square, SIDE), [1, SIDE, SIDE, 3]);
    const outputs = this.network.execute(input, ['Identity', 'Identity_1', 'Identity_2']);
    const [values, [sure], [right]] = await Promise.all(outputs.map((output) => output.data()));
    this.tf.dispose([input, ...outputs]);
    return readHand(values, sure, right, square);
  }
}
