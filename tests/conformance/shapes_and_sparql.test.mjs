// What a linked-data client can do with our services: n3 reads them, the served SHACL shapes hold, and one SPARQL query that starts at /
// and follows links finds the head of every fused body.
import assert from 'node:assert/strict';
import { test } from 'node:test';

import { QueryEngine } from '@comunica/query-sparql-link-traversal';
import jsonld from 'jsonld';
import { DataFactory, Parser, Store } from 'n3';
import Validator from 'rdf-validate-shacl';

import { lines } from '../support/triples.mjs';

const fusion = process.env.CHORUS_FUSION_URL;
const sensor = process.env.CHORUS_SENSOR_URL;
assert.ok(fusion && sensor, 'CHORUS_FUSION_URL and CHORUS_SENSOR_URL name running services');
const CH = 'https://w3id.org/chorus-tracking/ns#';

async function read(url, accept = 'text/turtle') {
  const answer = await fetch(url, { headers: { Accept: accept } });
  assert.equal(answer.status, 200, url);
  return answer.text();
}

/// The graph at url; live documents are read from their immutable copies, so that formats can be compared.
async function graph(url) {
  return new Store(new Parser({ baseIRI: url }).parse(await read(url)));
}

async function cited(base) {
  const answer = await fetch(`${base}/frame`);
  await answer.arrayBuffer();
  return new URL(answer.headers.get('content-location'), `${base}/`).href;
}

test('the served shapes accept what we serve and refuse what is broken', async () => {
  const validator = new Validator(await graph(`${fusion}/shapes`));
  for (const base of [fusion, sensor]) {
    for (const url of [await cited(base), `${base}/floor-plane`, `${base}/skeletons/`]) {
      const report = await validator.validate(await graph(url));
      assert.ok(report.conforms, `${url}: ${report.results.map((r) => `${r.path?.value} ${r.message}`).join('; ')}`);
    }
    const broken = await graph(await cited(base));
    broken.removeQuads(broken.getQuads(null, DataFactory.namedNode(`${CH}capturedNanoseconds`)));
    assert.equal((await validator.validate(broken)).conforms, false, 'a frame without time must be refused');
  }
});

test('JSON-LD is the graph of the Turtle', async () => {
  for (const base of [fusion, sensor]) {
    const url = await cited(base);
    const document = JSON.parse(await read(url, 'application/ld+json'));
    const documentLoader = async (context) => {
      const address = new URL(context, url).href;
      return { contextUrl: null, documentUrl: address, document: JSON.parse(await read(address, 'application/ld+json, application/json')) };
    };
    const nquads = await jsonld.toRDF(document, { base: url, format: 'application/n-quads', documentLoader });
    assert.deepEqual(lines(new Parser().parse(nquads)), lines((await graph(url)).getQuads()));
  }
});

test('many frames and living resources in one store keep one place per person and instant', async () => {
  const store = new Store();
  for (let i = 0; i < 20; ++i) {
    for (const path of ['/frame', '/skeletons/']) {
      const loaded = await graph(`${fusion}${path}`);
      store.addQuads(loaded.getQuads());
      if (path === '/frame') continue;
      for (const { object } of loaded.getQuads(null, DataFactory.namedNode('http://www.w3.org/ns/ldp#contains'))) {
        try { store.addQuads((await graph(object.value)).getQuads()); } catch { /* gone since */ }
      }
    }
    await new Promise((resolve) => { setTimeout(resolve, 20); });
  }
  const own = (name) => DataFactory.namedNode(`${CH}${name}`);
  const heads = store.getSubjects(own('jointName'), DataFactory.literal('Head'));
  assert.ok(heads.length > 10, `${heads.length} instants were read`);
  for (const head of heads) for (const axis of ['x', 'y', 'z']) {
    assert.ok(store.getObjects(head, own(axis)).length <= 1, `${head.value} has several ${axis}`);
  }
  for (const skeleton of store.getSubjects(own('bodyId'))) {
    assert.equal(store.getObjects(skeleton, own('capturedNanoseconds')).length, 1, skeleton.value);
  }
});

test('a SPARQL query from / finds the head of every fused body', async () => {
  const frame = JSON.parse(await read(await cited(fusion), 'application/json'));
  assert.ok(frame.bodies.length > 0, 'somebody is tracked');
  const rows = await new QueryEngine().queryBindings(`
    PREFIX ch: <${CH}> PREFIX ldp: <http://www.w3.org/ns/ldp#>
    SELECT DISTINCT ?body ?skeleton ?head ?x ?y ?z WHERE {
      <${fusion}/> ch:skeletons ?list .
      ?list ldp:contains ?body .
      ?skeleton ch:of ?body ; ch:joint ?head .
      ?head ch:jointName "Head" ; ch:x ?x ; ch:y ?y ; ch:z ?z .
    }`, { sources: [`${fusion}/`], lenient: true });
  const found = await rows.toArray();
  const bodies = new Set(found.map((row) => row.get('body').value));
  for (const body of frame.bodies) assert.ok(bodies.has(`${fusion}/skeletons/${body.bodyId}`), `body ${body.bodyId} is found`);
  const heads = found.map((row) => row.get('head').value);
  assert.equal(new Set(heads).size, heads.length, 'a head has one place at one instant, however many documents were read');
  for (const row of found) {
    const height = Number(row.get('y').value);
    assert.ok(height > 0.3 && height < 2.3, `a head at ${height} m`);
  }
});
