// Takes images from the byte stream that the sensor sends (proto/runner.md, section 2).  Pure: bytes in, images out.

const MAX_HEADER = 4096;
const MAX_SIDE = 8192;
const LINE_FEED = 10;

const isSide = (value) => Number.isInteger(value) && value >= 1 && value <= MAX_SIDE;

/// Parses and checks the header of an image; throws what is wrong with it.
export function parseHeader(text) {
  let header;
  try {
    header = JSON.parse(text);
  } catch {
    throw new Error(`an image begins with one line of JSON, not with "${text.slice(0, 40)}"`);
  }
  if (header?.type !== 'image') throw new Error('type: must be "image"');
  if (!isSide(header.width) || !isSide(header.height)) throw new Error(`width, height: must be whole numbers from 1 to ${MAX_SIDE}`);
  if (header.format !== 'rgb24') throw new Error('format: must be "rgb24"');
  if (header.bytes !== header.width * header.height * 3) throw new Error('bytes: must be width x height x 3');
  if (typeof header.captured !== 'string' || !/^\d{1,19}$/.test(header.captured)) throw new Error('captured: must be nanoseconds, as text');
  return header;
}

export class ImageReader {
  constructor() {
    this.header = null;
    this.text = [];
    this.textLength = 0;
    this.pixels = null;
    this.filled = 0;
  }

  /// All images that this chunk completes: {header, pixels}.  Throws when the stream is not as specified; it cannot continue.
  feed(chunk) {
    const images = [];
    let rest = chunk;
    while (rest.length > 0) {
      rest = this.header ? this.#fill(rest, images) : this.#begin(rest);
    }
    return images;
  }

  #begin(bytes) {
    const end = bytes.indexOf(LINE_FEED);
    const part = end < 0 ? bytes : bytes.subarray(0, end);
    this.textLength += part.length;
    if (this.textLength > MAX_HEADER) throw new Error(`an image begins with a line of at most ${MAX_HEADER} bytes`);
    this.text.push(Buffer.from(part));
    if (end < 0) return bytes.subarray(bytes.length);
    this.header = parseHeader(Buffer.concat(this.text).toString('utf8'));
    this.text = [];
    this.textLength = 0;
    this.pixels = new Uint8Array(this.header.bytes);
    this.filled = 0;
    return bytes.subarray(end + 1);
  }

  #fill(bytes, images) {
    const part = bytes.subarray(0, this.pixels.length - this.filled);
    this.pixels.set(part, this.filled);
    this.filled += part.length;
    if (this.filled === this.pixels.length) {
      images.push({ header: this.header, pixels: this.pixels });
      this.header = null;
      this.pixels = null;
    }
    return bytes.subarray(part.length);
  }
}
