// Finds people in pictures, beside the page: the networks of the runner (services/pose-runner) on WebAssembly.  A classic worker, because
// the engine's files are classic scripts and module workers know no import map.
//
// In: {type: 'load', model}, then {type: 'image', width, height, pixels (red, green, blue, opacity), time [s]}, one at a time.
// Out: {type: 'progress', detail}, {type: 'ready', hello} or {type: 'failed', detail}, then {type: 'bodies', bodies, milliseconds}.
importScripts('engine/tf-core.min.js', 'engine/tf-converter.min.js', 'engine/tf-backend-wasm.min.js');

let network = null;

async function fileAt(path) {
  const answer = await fetch(path);
  if (!answer.ok) throw new Error(`${path} is missing on the sensor’s host (${answer.status}): apt install chorus-camera, or npm ci --prefix services/pose-runner.`);
  return new Uint8Array(await answer.arrayBuffer());
}

async function startEngine() {
  tf.wasm.setWasmPaths(new URL('engine/', location.href).href);
  tf.env().set('WASM_HAS_MULTITHREAD_SUPPORT', false);
  await tf.setBackend('wasm');
  await tf.ready();
}

async function load(name) {
  const [{ MODELS, warmUp }, { checkBytes, networks }] = await Promise.all([import('./runner/catalogue.js'), import('./runner/networks.js')]);
  const known = JSON.parse(new TextDecoder().decode(await fileAt('runner/models.json')));
  const model = MODELS[name];
  await startEngine();
  const total = model.files.flatMap((file) => [`${file}.json`, `${file}.bin`]).reduce((sum, file) => sum + known[file].bytes, 0);
  let loaded = 0;
  const read = async (file) => {
    const bytes = await fileAt(`models/${file}`);
    await checkBytes(file, bytes, known, crypto.subtle);
    loaded += bytes.length;
    postMessage({ type: 'progress', detail: `${Math.round((100 * loaded) / total)} % of ${Math.round(total / 1e6)} MB; it is kept for the next time.` });
    return bytes;
  };
  network = model.make(tf, await networks(tf, tf.loadGraphModel, model.files, read));
  await warmUp(network);
  return model.hello;
}

function withoutOpacity(bytes) {
  const pixels = new Uint8Array((bytes.length / 4) * 3);
  for (let from = 0, to = 0; from < bytes.length; from += 4, to += 3) {
    pixels[to] = bytes[from];
    pixels[to + 1] = bytes[from + 1];
    pixels[to + 2] = bytes[from + 2];
  }
  return pixels;
}

async function look({ width, height, pixels, time }) {
  const began = performance.now();
  const bodies = await network.bodies({ width, height, pixels: withoutOpacity(pixels) }, time);
  postMessage({ type: 'bodies', bodies: bodies.map(({ id, pixels: seen }) => ({ id, pixels: seen })), milliseconds: performance.now() - began });
}

onmessage = async ({ data }) => {
  try {
    if (data.type === 'load') postMessage({ type: 'ready', hello: await load(data.model) });
    if (data.type === 'image') await look(data);
  } catch (error) {
    postMessage({ type: 'failed', detail: String(error?.message ?? error) });
  }
};
