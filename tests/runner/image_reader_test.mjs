// Reads images from a byte stream, no matter how it is split into chunks.
import assert from 'node:assert/strict';
import { test } from 'node:test';

import { ImageReader, parseHeader } from '../../services/pose-runner/image_reader.js';

const HEADER = { type: 'image', sequence: 7, captured: '1795246200000000000', width: 2, height: 1, format: 'rgb24', bytes: 6 };
const image = (changes = {}, pixels = [1, 10, 3, 4, 5, 6]) => Buffer.concat([Buffer.from(`${JSON.stringify({ ...HEADER, ...changes })}\n`), Buffer.from(pixels)]);

test('images come out whole, whatever the chunks', () => {
  const stream = Buffer.concat([image(), image({ sequence: 8 }, [9, 9, 9, 9, 9, 10])]);
  for (const step of [1, 2, 7, 50, stream.length]) {
    const reader = new ImageReader();
    const images = [];
    for (let at = 0; at < stream.length; at += step) images.push(...reader.feed(stream.subarray(at, at + step)));
    assert.deepEqual(images.map(({ header, pixels }) => [header.sequence, [...pixels]]), [[7, [1, 10, 3, 4, 5, 6]], [8, [9, 9, 9, 9, 9, 10]]]);
  }
});

test('what is no image is refused with its place', () => {
  const refused = (text, why) => assert.throws(() => parseHeader(text), why);
  refused('hello', /one line of JSON/);
  refused('{"type":"frame"}', /type: /);
  refused(JSON.stringify({ ...HEADER, width: 0 }), /width, height: /);
  refused(JSON.stringify({ ...HEADER, format: 'jpeg' }), /format: /);
  refused(JSON.stringify({ ...HEADER, bytes: 7 }), /bytes: /);
  refused(JSON.stringify({ ...HEADER, captured: 5 }), /captured: /);
  assert.throws(() => new ImageReader().feed(Buffer.alloc(5000, 'x')), /at most 4096 bytes/);
});
