// An independent JSON-LD processor and an independent Turtle parser find that perfect/x.jsonld is the graph of perfect/x.ttl, and so is
// perfect/x.json with the Link header's context applied: only its decimals are spelt differently.
import assert from 'node:assert/strict';
import { readdirSync, readFileSync } from 'node:fs';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';

import jsonld from 'jsonld';
import { Parser, Writer } from 'n3';

import { lines } from '../support/triples.mjs';

const proto = fileURLToPath(new URL('../../proto/', import.meta.url));
const base = 'http://localhost/frame';
const context = JSON.parse(readFileSync(`${proto}context.jsonld`, 'utf8'));

async function documentLoader(url) {
  assert.equal(url, 'http://localhost/context.jsonld', 'the only document to be loaded is our context');
  return { contextUrl: null, documentUrl: url, document: context };
}

async function fromJsonLd(document) {
  const nquads = await jsonld.toRDF(document, { base, format: 'application/n-quads', documentLoader });
  return lines(new Parser({ format: 'application/n-quads' }).parse(nquads));
}

const names = readdirSync(`${proto}golden/perfect`).filter((name) => name.endsWith('.jsonld')).map((name) => name.slice(0, -7));

test('there is something to compare', () => assert.ok(names.length >= 3));

/// Stable names, as withLivingNames() gives them, in triples.
function livingLines(triples) {
  return triples.filter((line) => !line.includes('ns#of ')).map((line) => line.split(' ').map((term) => term
    .replace(/\/frames\/\d+#(\d+)-(\w+)$/, '/skeletons/$1#$2').replace(/\/frames\/\d+#(\d+)$/, '/skeletons/$1')
    .replace(/\/frames\/\d+#prop-/, '/frame#prop-').replace(/\/frames\/\d+$/, '/frame')).join(' ')).sort();
}

for (const name of names) {
  const read = (extension) => readFileSync(`${proto}golden/perfect/${name}.${extension}`, 'utf8');
  test(`${name}: JSON-LD is the graph of the Turtle`, async () => {
    const turtle = lines(new Parser({ baseIRI: base }).parse(read('ttl')));
    assert.deepEqual(await fromJsonLd(JSON.parse(read('jsonld'))), turtle);
  });

  test(`${name}: N-Triples is the graph of the Turtle`, () => {
    const triples = new Parser({ format: 'N-Triples' }).parse(read('nt'));
    assert.deepEqual(lines(triples), lines(new Parser({ baseIRI: base }).parse(read('ttl'))));
  });

  /// JSON only gives names to what outlives a frame; JSON-LD names frame, bodies and joints by the frame, which is checked here.
  const withLivingNames = (frame) => {
    assert.equal(frame['@id'], `frames/${frame.sequence}`);
    for (const body of frame.bodies) {
      assert.equal(body['@id'], `${frame['@id']}#${body.bodyId}`);
      for (const [joint, value] of Object.entries(body.joints)) {
        assert.equal(value['@id'], `${body['@id']}-${joint}`);
        value['@id'] = `${body.of}#${joint}`;
      }
      body['@id'] = body.of;
      delete body.of;
    }
    for (const prop of frame.heldProps ?? []) {
      assert.equal(prop['@id'], `${frame['@id']}#prop-${prop.propName}`);
      prop['@id'] = `frame#prop-${prop.propName}`;
    }
    return { ...frame, '@id': 'frame' };
  };

  test(`${name}: the JSON holds the same as the JSON-LD`, () => {
    const strip = (_, value) => (typeof value === 'string' && /^-?\d+\.\d+$/.test(value) ? Number(value) : value);
    const { '@context': _, ...linked } = JSON.parse(read('jsonld'), strip);
    assert.deepEqual(JSON.parse(read('json')), withLivingNames(linked));
  });
}

/// Decimals as numbers rounded to a hundred thousandth: JSON's numbers arrive in scientific notation, and jsonld.js treats those that
/// JavaScript writes as 4e-8 as integers.
function numbers(quads) {
  const decimal = /^"([^"]*)"\^\^http:\/\/www\.w3\.org\/2001\/XMLSchema#decimal$/;
  return quads.map((line) => line.split(' ').map((term) => term.replace(decimal, (_, text) => `decimal ${Math.round(Number(text) * 1e5) + 0}`)).join(' ')).sort();
}

for (const name of names) {
  test(`${name}: JSON with the context of its Link header has every triple of the Turtle`, async () => {
    const read = (extension) => readFileSync(`${proto}golden/perfect/${name}.${extension}`, 'utf8');
    const linked = { '@context': context['@context'], ...JSON.parse(read('json')) };
    const turtle = lines(new Parser({ baseIRI: base }).parse(read('ttl')));
    assert.deepEqual(numbers(await fromJsonLd(linked)), numbers(livingLines(turtle)));
  });
}

// A document with all that nodes can contain: blank nodes, a list, an indexed container, terms with a type-dependent meaning.
test('documents/registration: JSON-LD is the graph of the Turtle', async () => {
  const read = (extension) => readFileSync(`${proto}golden/documents/registration.${extension}`, 'utf8');
  const options = { base: 'http://localhost/registration', documentLoader };
  const nquads = await jsonld.toRDF(JSON.parse(read('jsonld')), { ...options, format: 'application/n-quads' });
  const turtle = await new Promise((resolve, reject) => {
    const writer = new Writer({ format: 'N-Quads' });
    writer.addQuads(new Parser({ baseIRI: options.base }).parse(read('ttl')));
    writer.end((error, text) => (error ? reject(error) : resolve(text)));
  });
  const canonical = (text) => jsonld.canonize(text, { algorithm: 'URDNA2015', inputFormat: 'application/n-quads' });
  assert.equal(await canonical(nquads), await canonical(turtle));
});
