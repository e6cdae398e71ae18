// The SHACL shapes in an independent validator: they accept the valid golden files and refuse all errors that a shape can detect.
import assert from 'node:assert/strict';
import { readFileSync, readdirSync } from 'node:fs';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';

import { Parser, Store } from 'n3';
import Validator from 'rdf-validate-shacl';

const proto = fileURLToPath(new URL('../../proto/', import.meta.url));
const read = (path) => new Store(new Parser({ baseIRI: 'http://localhost/' }).parse(readFileSync(`${proto}${path}`, 'utf8')));
const validator = new Validator(read('shapes.ttl'));

for (const name of readdirSync(`${proto}golden/perfect`).filter((file) => file.endsWith('.ttl'))) {
  test(`perfect/${name} conforms`, async () => {
    const report = await validator.validate(read(`golden/perfect/${name}`));
    assert.ok(report.conforms, report.results.map((r) => `${r.focusNode?.value} ${r.path?.value}`).join('; '));
  });
}

// Wrong numbers, wrong names and missing properties, which readers refuse, are detected by shapes, too.
const visible = ['no-time', 'no-body-time', 'no-sequence', 'no-source', 'no-space', 'no-body-id', 'no-joint-name', 'no-state', 'no-position',
  'half-a-position', 'absurd-coordinate', 'nan-coordinate', 'two-positions', 'unknown-state', 'unknown-space', 'unknown-joint',
  'negative-sequence', 'negative-variance', 'string-for-a-number', 'decimal-for-an-integer', 'quaternion-of-length-two',
  'source-with-a-slash', 'too-many-bodies', 'time-as-a-string', 'share-below-zero', 'shares-as-text', 'shares-of-words', 'two-lists-of-shares', 'age-below-zero',
  'half-a-velocity', 'velocity-beyond-belief', 'method-with-a-space', 'taller-than-a-giraffe', 'orientation-covariance-below-zero',
  'hand-as-a-text', 'held-prop-without-a-place', 'held-prop-without-a-turn'];
for (const name of visible) {
  test(`bad/${name}.ttl does not conform`, async () => {
    assert.equal((await validator.validate(read(`golden/bad/${name}.ttl`))).conforms, false);
  });
}

// A judged limb has both its orientations or none; they are not in golden files, because they are no frames.
const judged = (more) => new Store(new Parser().parse(`@prefix ch: <https://w3id.org/chorus-tracking/ns#> .
  [] a ch:LimbEvaluation ; ch:inertialSensor "5" ; ch:evaluationState "good" ; ch:offFor 0.0 ; ch:errorSegments 0 ${more} .`));
const TRACKED = '; ch:qx 0.0 ; ch:qy 0.0 ; ch:qz 0.0 ; ch:qw 1.0';
const PREDICTED = '; ch:predictedQx 0.6 ; ch:predictedQy 0.0 ; ch:predictedQz 0.0 ; ch:predictedQw 0.8';
for (const [more, conforms] of [['', true], [TRACKED + PREDICTED, true], [TRACKED, false], [PREDICTED, false],
  [TRACKED + PREDICTED.replace('0.6', '6.0'), false], [TRACKED + PREDICTED.replace('; ch:predictedQw 0.8', ''), false]]) {
  test(`a judged limb with "${more}" ${conforms ? 'conforms' : 'does not conform'}`, async () => {
    assert.equal((await validator.validate(judged(more))).conforms, conforms);
  });
}
