// BlazePose: one person, with MediaPipe's 33 landmarks and their places in metres.  A detector finds the person; from
// then on, each image shows where to look in the next one.
import { cropped, toImage, wholeImage } from './crop.js';
import { People, placeOf } from './people.js';

const DETECTOR_SIDE = 224;
const SIDE = 256;
const LANDMARKS = 33;
const VALUES = 5; // x, y, z, visibility, presence
const DETECTION = 13; // logit, box, four key points
const LEAST_PERSON = 0.5;
const MARGIN = 1.25;
const MASK_SIDE = 256; // of the longer side of a mask; the network's own is no finer
const LEAST_COVER = 0.5; // of a pixel, to be the person's
const MIDDLE = 33; // the two auxiliary landmarks: middle of the hips, and a point on the circle around the person
const RIM = 34;

export const FILES = { lite: ['blazepose-detector', 'blazepose-lite'], full: ['blazepose-detector', 'blazepose-full'] };
export const HELLO = { layout: 'mediapipe_33', pixelSigma: 4, image: { maxSide: 640 }, gives: ['masks'] };

const sigmoid = (x) => 1 / (1 + Math.exp(-x));
const round = (value, digits) => Number(value.toFixed(digits));

/// The places that the detector's answers are relative to: centres of cells, 0 to 1.
export function anchors() {
  const list = [];
  for (const [cells, each] of [[28, 2], [14, 2], [7, 6]]) {
    for (let y = 0; y < cells; ++y) {
      for (let x = 0; x < cells; ++x) {
        for (let i = 0; i < each; ++i) list.push([(x + 0.5) / cells, (y + 0.5) / cells]);
      }
    }
  }
  return list;
}

/// The square around a person, from the middle of the hips and a point of the circle; the feet are towards its bottom.
export function squareAround([x, y], [rimX, rimY]) {
  const [dx, dy] = [rimX - x, rimY - y];
  return { x, y, size: 2 * Math.hypot(dx, dy) * MARGIN, angle: Math.atan2(dx, -dy) };
}

/// The square around the most certain person in the detector's answer, or null.
export function detected(values, homes, square) {
  let best = -1;
  for (let i = 0; i < homes.length; ++i) {
    if (best < 0 || values[i * DETECTION] > values[best * DETECTION]) best = i;
  }
  if (best < 0 || sigmoid(values[best * DETECTION]) < LEAST_PERSON) return null;
  const point = (i) => {
    const at = best * DETECTION + 5 + 2 * i;
    return toImage(square, values[at] / DETECTOR_SIDE + homes[best][0], values[at + 1] / DETECTOR_SIDE + homes[best][1]);
  };
  return squareAround(point(0), point(1));
}

/// Landmarks in pixels of the image, and in metres from the middle of the hips: right, down, ahead of the camera.
export function readLandmarks(values, world, square) {
  const [cos, sin] = [Math.cos(square.angle), Math.sin(square.angle)];
  const place = (i) => toImage(square, values[i * VALUES] / SIDE, values[i * VALUES + 1] / SIDE);
  const pixels = [];
  const metres = [];
  for (let i = 0; i < LANDMARKS; ++i) {
    const sure = Math.min(sigmoid(values[i * VALUES + 3]), sigmoid(values[i * VALUES + 4]));
    pixels.push([...place(i).map((c) => round(c, 2)), round(sure, 3)]);
    const [x, y, z] = [world[3 * i], world[3 * i + 1], world[3 * i + 2]];
    metres.push([x * cos - y * sin, x * sin + y * cos, z].map((c) => round(c, 4)));
  }
  return { pixels, metres, next: squareAround(place(MIDDLE), place(RIM)) };
}

/// Which pixels of the image are the person's, as lengths of runs from the upper left corner, row by row: background first
/// (proto/runner.md, section 6).  `cover`: how much of each cell of the square is the person, 0 to 1.
export function maskOf(cover, square, { width, height }) {
  const scale = Math.min(1, MASK_SIDE / Math.max(width, height));
  const [columns, rows] = [Math.max(1, Math.round(width * scale)), Math.max(1, Math.round(height * scale))];
  const [cos, sin] = [Math.cos(square.angle), Math.sin(square.angle)];
  const runs = [0];
  let inside = false;
  for (let row = 0; row < rows; ++row) {
    const dy = ((row + 0.5) * height) / rows - square.y;
    for (let column = 0; column < columns; ++column) {
      const dx = ((column + 0.5) * width) / columns - square.x;
      const u = Math.floor(((dx * cos + dy * sin) / square.size + 0.5) * SIDE);
      const v = Math.floor(((dy * cos - dx * sin) / square.size + 0.5) * SIDE);
      const person = u >= 0 && v >= 0 && u < SIDE && v < SIDE && cover[v * SIDE + u] >= LEAST_COVER;
      if (person !== inside) runs.push(0);
      inside = person;
      runs[runs.length - 1] += 1;
    }
  }
  return { width: columns, height: rows, runs };
}

export class BlazePose {
  constructor(tf, models, size) {
    this.tf = tf;
    this.detector = models['blazepose-detector'];
    this.network = models[`blazepose-${size}`];
    this.homes = anchors();
    this.people = new People();
    this.square = null;
    this.mask = undefined; // of the last image, if it was wanted and shows somebody
  }

  /// The bodies of a frame (proto/bridge.md, section 3).  `time`: its capture time [s].
  async bodies(image, time, wants = []) {
    const masks = wants.includes('mask');
    const before = this.square;
    let found = before && (await this.#landmarks(image, before, masks));
    if (!found) {
      const square = await this.#detect(image);
      found = square && (await this.#landmarks(image, square, masks));
    }
    this.square = found ? found.next : null;
    this.mask = found?.mask;
    const where = found && placeOf(found.pixels, 0);
    if (!where) return [];
    const [id] = this.people.numbers([where], time);
    return [{ id, pixels: found.pixels, world: found.metres }];
  }

  async #detect(image) {
    const square = wholeImage(image.width, image.height);
    const input = this.tf.tensor4d(cropped(image, square, DETECTOR_SIDE), [1, DETECTOR_SIDE, DETECTOR_SIDE, 3]);
    const output = this.detector.execute(input);
    const values = await output.data();
    this.tf.dispose([input, output]);
    return detected(values, this.homes, square);
  }

  async #landmarks(image, square, masks) {
    const input = this.tf.tensor4d(cropped(image, square, SIDE), [1, SIDE, SIDE, 3]);
    const names = ['ld_3d', 'world_3d', 'output_poseflag', ...(masks ? ['activation_segmentation'] : [])];
    const outputs = this.network.execute(input, names);
    const [values, world, [sure], cover] = await Promise.all(outputs.map((output) => output.data()));
    this.tf.dispose([input, ...outputs]);
    if (sure < LEAST_PERSON) return null;
    return { ...readLandmarks(values, world, square), mask: cover && maskOf(cover, square, image) };
  }
}
