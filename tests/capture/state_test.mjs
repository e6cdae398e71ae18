// One sentence for each state of the capture page; what it remembers; when a picture was taken.
import assert from 'node:assert/strict';
import { test } from 'node:test';

import { capturedAt } from '../../services/capture/camera.js';
import { bonesOf, fitted } from '../../services/capture/overlay.js';
import { adoptLens, fromLink, load, loadToken, save, saveToken } from '../../services/capture/settings.js';
import { Pace, cameraStateOf, stateOf } from '../../services/capture/state.js';

const known = (changes) => ({
  running: true, hidden: false, slept: 0, camera: { state: 'on' }, model: { state: 'ready', detail: '' }, link: { state: 'welcomed', detail: '' },
  lens: '', people: 1, rate: 8.24, complaint: '', ...changes,
});
const said = (changes) => { const { tone, sentence } = stateOf(known(changes)); return `${tone}: ${sentence}`; };

test('good is only what is seen, taken and pushed', () => {
  assert.equal(said({}), 'good: Live: one person, 8.2 Hz.');
  assert.equal(said({ people: 3 }), 'good: Live: 3 people, 8.2 Hz.');
  assert.equal(said({ people: 0 }), 'calm: Live: nobody is in sight.');
  assert.equal(said({ running: false }), 'calm: Ready.');
  assert.equal(said({ people: null }), 'warn: Looking at the first picture …');
  assert.equal(said({ complaint: 'captured: is in the future' }), 'warn: The sensor refuses frames.');
});

test('each trouble has its sentence, and something to do', () => {
  const cameras = ['insecure', 'denied', 'none', 'absent', 'busy', 'lost', 'silent'].map((state) => known({ camera: { state } }));
  const links = ['unreachable', 'token', 'wrong', 'role', 'unset', 'tries', 'shut'].map((state) => known({ link: { state, detail: '' } }));
  const all = [...cameras, ...links, known({ link: { state: 'bye', detail: 'nothing has come for 30 s' } }), known({ model: { state: 'failed', detail: 'x' } }), known({ lens: 'x' })];
  for (const one of all) assert.equal(stateOf(one).tone, 'bad');
  for (const one of all) assert.ok(stateOf(one).next.length > 0, stateOf(one).sentence);
  assert.equal(new Set(all.map((one) => stateOf(one).sentence)).size, all.length, 'no two alike');
  assert.equal(said({ link: { state: 'busy', detail: '"x" pushes to this sensor already' } }), 'warn: Another program holds this sensor.');
  assert.match(stateOf(known({ link: { state: 'busy', detail: '"x" pushes already' } })).next, /"x" pushes already\. One camera at a time/);
});

test('what a person must do comes before what only takes time', () => {
  assert.equal(said({ camera: { state: 'denied' }, link: { state: 'wrong' } }), 'bad: The camera is not allowed for this page.');
  assert.equal(said({ model: { state: 'loading', detail: '' }, link: { state: 'wrong' } }), 'bad: The token is wrong.');
  assert.equal(said({ model: { state: 'loading', detail: '40 %' }, link: { state: 'connecting' } }), 'warn: Loading the model …');
  assert.equal(said({ hidden: true, link: { state: 'connecting' } }), 'warn: Asleep: this page is hidden.');
  assert.equal(said({ hidden: true, camera: { state: 'off' } }), 'warn: Asleep: this page is hidden, its camera closed.');
  assert.match(stateOf(known({ slept: 41.2 })).next, /asleep for 41 s/);
});

test('why there is no camera', () => {
  assert.equal(cameraStateOf({ name: 'NotAllowedError' }), 'denied');
  assert.equal(cameraStateOf({ name: 'NotFoundError' }), 'none');
  assert.equal(cameraStateOf({ name: 'NotReadableError' }), 'busy');
  assert.equal(cameraStateOf(undefined), 'busy');
});

test('a picture was taken when the browser says so, or a usual delay ago', () => {
  assert.equal(capturedAt(5000, 4950), 4950);
  for (const nonsense of [undefined, NaN, 5001, 3000]) assert.equal(capturedAt(5000, nonsense), 4940);
});

test('the rate is that of the last seconds, and the age of the middle picture', () => {
  const pace = new Pace(4000);
  assert.equal(pace.at(0).rate, 0);
  for (let now = 0; now <= 10000; now += 100) pace.note(now, now === 9900 ? 900 : 80);
  const { rate, age } = pace.at(10000);
  assert.ok(Math.abs(rate - 10) < 0.01);
  assert.equal(age, 80);
  assert.equal(pace.at(20000).rate, 0);
});

function storage(values = new Map()) {
  return () => ({ getItem: (key) => values.get(key) ?? null, setItem: (key, value) => values.set(key, value) });
}

test('settings are remembered, and a browser that keeps nothing is no error', () => {
  const store = storage();
  assert.deepEqual(load(store), { camera: '', model: 'movenet', rate: 30, lenses: {} });
  save({ ...load(store), model: 'blazepose-lite', lenses: { c1: { fov: 70, sigma: 2 } } }, store);
  assert.deepEqual(load(store), { camera: '', model: 'blazepose-lite', rate: 30, lenses: { c1: { fov: 70, sigma: 2 } } });
  saveToken('abc', store);
  assert.equal(loadToken(store), 'abc');
  const forbidden = () => { throw new DOMException('no', 'SecurityError'); };
  save({}, forbidden);
  assert.equal(load(forbidden).model, 'movenet');
  assert.equal(loadToken(forbidden), '');
  assert.equal(load(storage(new Map([['chorus.capture', '{broken']]))).rate, 30);
});

test('a lens that no camera has yet is that of the first one that opens, and of no other', () => {
  const [told, old] = [{ calibration: { fx: 900 } }, { fov: 70, sigma: 2 }];
  const lenses = { '': told, c1: old, c2: old };
  assert.equal(adoptLens(lenses, ''), false, 'a browser that tells no id');
  assert.equal(adoptLens(lenses, 'c1'), true);
  assert.equal(adoptLens(lenses, 'c2'), false);
  assert.deepEqual(lenses, { c1: told, c2: old });
});

test('a link brings a token and no more than it says', () => {
  assert.deepEqual(fromLink(''), { start: false });
  assert.deepEqual(fromLink('#token=a%2Bb&start&rate=5&model=movenet'), { token: 'a+b', model: 'movenet', rate: 5, start: true });
  assert.deepEqual(fromLink('#rate=-1'), { start: false });
});

test('the overlay lies where the picture is', () => {
  assert.deepEqual(fitted({ width: 400, height: 400 }, { width: 200, height: 100 }), { scale: 2, x: 0, y: 100 });
  assert.deepEqual(fitted({ width: 400, height: 100 }, { width: 100, height: 100 }), { scale: 1, x: 150, y: 0 });
  for (const [layout, count] of [['coco_17', 17], ['mediapipe_33', 33]]) {
    assert.ok(bonesOf(layout).length > 10 && bonesOf(layout).flat().every((index) => index < count));
  }
});
