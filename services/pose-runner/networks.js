// Networks from the bytes of their files, which are checked first: the same in Node and in a browser.

const hex = (buffer) => Array.from(new Uint8Array(buffer), (byte) => byte.toString(16).padStart(2, '0')).join('');

/// Throws unless these bytes are what the list `known` (models.json) says of that file.  `subtle`: the Web Crypto API's.
export async function checkBytes(name, bytes, known, subtle) {
  const hash = hex(await subtle.digest('SHA-256', bytes));
  if (known[name]?.sha256 !== hash) throw new Error(`the model ${name} is not the one that models.json lists`);
}

/// Loads the networks with these names.  `read(file)` returns the checked bytes of a file as Uint8Array.
export async function networks(tf, loadGraphModel, names, read) {
  const models = {};
  for (const name of names) {
    const description = JSON.parse(new TextDecoder().decode(await read(`${name}.json`)));
    const weights = await read(`${name}.bin`);
    const artifacts = {
      modelTopology: description.modelTopology,
      signature: description.signature,
      weightSpecs: description.weightsManifest.flatMap((group) => group.weights),
      weightData: weights.buffer.slice(weights.byteOffset, weights.byteOffset + weights.byteLength),
    };
    models[name] = await loadGraphModel(tf.io.fromMemory(artifacts));
  }
  return models;
}
