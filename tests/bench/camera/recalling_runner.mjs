#!/usr/bin/env node
// A runner (proto/runner.md) that looks at each different picture once and keeps the answer in a file.  When the same pictures are played
// again it answers from there at once, as a runner on a graphics card would: the chain around the runner can be measured at full speed on a
// computer that is too slow, or too busy, for the networks.
//   recalling_runner.mjs FILE --model NAME
import { createHash } from 'node:crypto';
import { appendFileSync, existsSync, readFileSync } from 'node:fs';
import { parseArgs } from 'node:util';

import { MODELS, warmUp } from '../../../services/pose-runner/catalogue.js';
import { ImageReader } from '../../../services/pose-runner/image_reader.js';
import { engine, load } from '../../../services/pose-runner/models.js';

const { values, positionals } = parseArgs({ options: { model: { type: 'string' } }, allowPositionals: true });
const [file] = positionals;
const model = MODELS[values.model];
const known = new Map(existsSync(file) ? readFileSync(file, 'utf8').trim().split('\n').filter(Boolean).map((line) => JSON.parse(line)) : []);
let network = null;

async function start() {
  const tf = await engine();
  network = model.make(tf, await load(tf, model.files));
  await warmUp(network);
}

async function look(header, pixels) {
  if (!network) await start();
  return network.bodies({ width: header.width, height: header.height, pixels }, Number(header.captured) / 1e9);
}

async function answer({ header, pixels }) {
  const began = performance.now();
  const key = createHash('sha1').update(`${header.width} `).update(pixels).digest('hex');
  if (!known.has(key)) {
    known.set(key, await look(header, pixels));
    appendFileSync(file, `${JSON.stringify([key, known.get(key)])}\n`);
  }
  const frame = { type: 'frame', sequence: header.sequence, captured: header.captured, bodies: known.get(key), milliseconds: performance.now() - began };
  process.stdout.write(`${JSON.stringify(frame)}\n`);
}

process.stdout.on('error', () => process.exit(0));
if (known.size === 0) await start(); // the sensor has more patience before the hello than after it
process.stdout.write(`${JSON.stringify({ type: 'hello', version: 1, ...model.hello })}\n`);
const reader = new ImageReader();
for await (const chunk of process.stdin) {
  for (const image of reader.feed(chunk)) await answer(image);
}
process.exit(0);
