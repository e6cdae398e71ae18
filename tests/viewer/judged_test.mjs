// What the cockpit makes of /evaluation, without a browser.
import assert from 'node:assert/strict';
import { test } from 'node:test';

import { COLOURS, bonesOf, judgedBones, judgedLines } from '../../services/viewer/judged.js';
import { limbAxesOf } from '../../services/viewer/limb_axes.js';

const evaluation = { limbs: [
  { bodyId: 3, limb: 'Chest', state: 'good', comment: 'chest agrees' },
  { limb: 'HandRight', state: 'waiting', comment: 'right hand: the tracker does not see this limb' },
  { bodyId: 3, limb: 'ShankRight', state: 'calibrating', comment: 'right shank: calibrates: walk' },
  { bodyId: 3, limb: 'ForearmLeft', state: 'off', comment: 'left forearm off by 70 deg for 4 s' },
  { bodyId: 3, limb: 'Pelvis', state: 'good', comment: 'pelvis agrees' },
] };

test('each limb has the bones between its joints', () => {
  assert.deepEqual(bonesOf('ForearmLeft'), ['WristLeft']);
  assert.deepEqual(bonesOf('HandRight'), ['HandRight', 'HandTipRight', 'ThumbRight']);
  assert.deepEqual(bonesOf('Pelvis'), ['SpineMid']);
  assert.deepEqual(bonesOf('Tail'), []);
  assert.deepEqual(bonesOf(undefined), []);
});

test('limbs are coloured by their state, those of whom nobody judges are not', () => {
  const bones = judgedBones(evaluation);
  assert.deepEqual([...bones.keys()], [3]);
  assert.equal(bones.get(3).WristLeft, COLOURS.off);
  assert.equal(bones.get(3).SpineMid, COLOURS.good);
  assert.equal(bones.get(3).AnkleRight, COLOURS.calibrating);
  assert.equal(bones.get(3).HandRight, undefined);
  assert.equal(judgedBones(null).size, 0);
  for (const limbs of [{}, 'x', 7, [null, 7]]) {
    assert.equal(judgedBones({ limbs }).size, 0);
    assert.deepEqual(judgedLines({ limbs }), []);
  }
});

test('what is off comes first, what is well in one line', () => {
  assert.deepEqual(judgedLines(evaluation).map(({ text }) => text), ['left forearm off by 70 deg for 4 s',
    'right shank: calibrates: walk', 'right hand: the tracker does not see this limb', '2 limbs agree']);
  assert.deepEqual(judgedLines({ limbs: [] }), []);
});

test('a judged limb has the axes of both worlds, whole or none', () => {
  const both = { bodyId: 3, limb: 'ForearmLeft', state: 'off', qx: 0, qy: 0, qz: 0, qw: 1, predictedQx: 0.6, predictedQy: 0, predictedQz: 0, predictedQw: 0.8 };
  assert.deepEqual(limbAxesOf({ limbs: [both] }), [{ bodyId: 3, bone: 'WristLeft', tracked: [0, 0, 0, 1], predicted: [0.6, 0, 0, 0.8], twistSeen: false }]);
  assert.equal(limbAxesOf({ limbs: [{ ...both, twistDegrees: 3.1 }] })[0].twistSeen, true);
  const { predictedQw, ...half } = both;
  for (const none of [half, { ...both, qw: 'x' }, { ...both, qw: 7 }, { ...both, bodyId: undefined }, { ...both, limb: 'Tail' }, { ...both, limb: 7 }, evaluation.limbs[0]])
    assert.deepEqual(limbAxesOf({ limbs: [none] }), []);
  assert.deepEqual(limbAxesOf(null), []);
});
