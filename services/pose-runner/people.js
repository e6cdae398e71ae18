// Numbers people from image to image, so that each keeps a number.  Deliberately simple: the person nearest
// in place and size keeps it; a person unseen for a second gets a new one on return.

const FORGET_AFTER_S = 1.0;
const FARTHEST = 0.6; // as a multiple of the person's height

const confident = (pixels, least) => pixels.filter((pixel) => pixel && pixel[2] >= least);

/// The middle of the visible part of a person, and its size [px].
export function placeOf(pixels, least = 0.2) {
  const seen = confident(pixels, least);
  if (seen.length === 0) return null;
  const across = (axis) => seen.map((pixel) => pixel[axis]);
  const [left, right] = [Math.min(...across(0)), Math.max(...across(0))];
  const [top, bottom] = [Math.min(...across(1)), Math.max(...across(1))];
  return { x: (left + right) / 2, y: (top + bottom) / 2, left, right, top, bottom, size: Math.max(right - left, bottom - top, 1) };
}

const distance = (a, b) => Math.hypot(a.x - b.x, a.y - b.y) / Math.max(a.size, b.size);

/// How much two places overlap, 0 to 1: intersection over union.
export function overlap(a, b) {
  const width = Math.min(a.right, b.right) - Math.max(a.left, b.left);
  const height = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
  if (width <= 0 || height <= 0) return 0;
  const area = (place) => (place.right - place.left) * (place.bottom - place.top);
  return (width * height) / (area(a) + area(b) - width * height);
}

export class People {
  constructor() {
    this.known = [];
    this.last = 0;
  }

  /// The numbers of the people at these places, as seen at this time [s].
  numbers(places, time) {
    this.known = this.known.filter((person) => Math.abs(time - person.time) <= FORGET_AFTER_S);
    const pairs = this.known.flatMap((person) => places.map((place, index) => ({ person, index, far: distance(person.place, place) })));
    pairs.sort((a, b) => a.far - b.far);
    const numbers = places.map(() => 0);
    const taken = new Set();
    for (const { person, index, far } of pairs) {
      if (far > FARTHEST || numbers[index] !== 0 || taken.has(person)) continue;
      taken.add(person);
      numbers[index] = person.number;
      [person.place, person.time] = [places[index], time];
    }
    return numbers.map((number, index) => number || this.#begin(places[index], time));
  }

  #begin(place, time) {
    this.last += 1;
    this.known.push({ number: this.last, place, time });
    return this.last;
  }
}
