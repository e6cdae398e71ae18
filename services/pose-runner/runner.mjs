#!/usr/bin/env node
// Finds people in images: images come in on standard input, landmarks go out on standard output (proto/runner.md).
//   runner.mjs [--model movenet|blazepose-lite|blazepose-full|hands] [--check]
import { parseArgs } from 'node:util';

import { MODELS, warmUp } from './catalogue.js';
import { ImageReader } from './image_reader.js';
import { check, engine, load } from './models.js';

const NANOSECONDS = 1e9;

// Without these, SIGUSR1 opens node's debugger on a port, and SIGUSR2 ends the runner.
for (const signal of ['SIGUSR1', 'SIGUSR2']) process.on(signal, () => {});

function chosen() {
  const { values } = parseArgs({ options: { model: { type: 'string', default: 'movenet' }, check: { type: 'boolean', default: false } } });
  const model = MODELS[values.model];
  if (!model) throw new Error(`there is no model "${values.model}"; there are ${Object.keys(MODELS).join(', ')}`);
  return { model, checkOnly: values.check };
}

const say = (message) => process.stdout.write(`${JSON.stringify(message)}\n`);

async function answer(network, { header, pixels }) {
  const began = performance.now();
  const time = Number(header.captured) / NANOSECONDS;
  const image = { width: header.width, height: header.height, pixels };
  const bodies = await network.bodies(image, time, header.wants);
  const hands = await network.hands?.(image); // undefined is left out of the line
  say({ type: 'frame', sequence: header.sequence, captured: header.captured, bodies, hands, mask: network.mask, milliseconds: Number((performance.now() - began).toFixed(1)) });
}

async function run() {
  const { model, checkOnly } = chosen();
  await check(model.files);
  if (checkOnly) return;
  const tf = await engine();
  const network = model.make(tf, await load(tf, model.files));
  await warmUp(network);
  say({ type: 'hello', version: 1, ...model.hello });
  const reader = new ImageReader();
  for await (const chunk of process.stdin) {
    for (const image of reader.feed(chunk)) await answer(network, image);
  }
}

process.stdout.on('error', () => process.exit(0)); // the sensor has ended
run().then(() => process.exit(0), (error) => {
  process.stderr.write(`${error.message}\n`);
  process.exit(1);
});
