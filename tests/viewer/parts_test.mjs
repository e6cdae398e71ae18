// The pure parts behind drawers: recordings by instant, the first steps, the hall from above.
import assert from 'node:assert/strict';
import { test } from 'node:test';

import { Playback, latest, nextStretch, timeText } from '../../services/viewer/playback.js';
import { boxOf, cellsOf, connectionOf, peopleOf, trailsAfter, wordsOf } from '../../services/viewer/hall.js';
import { addressOf, freeId, stepOf, wishOf } from '../../services/viewer/setup.js';

const at = (seconds, topic = '/frame') => ({ seconds, topic, message: { seconds } });

test('the newest message of each stream is shown, unless it is long past; places hold', () => {
  const messages = [at(0, '/registration'), at(1), at(1, '/sensors/s1/frame'), at(1.5), at(3, '/sensors/s2/frame')];
  assert.deepEqual(latest(messages, 1.6), { '/registration': { seconds: 0 }, '/frame': { seconds: 1.5 }, '/sensors/s1/frame': { seconds: 1 } });
  assert.deepEqual(latest(messages, 2.9), { '/registration': { seconds: 0 } });
  assert.deepEqual(latest(messages, 3), { '/registration': { seconds: 0 }, '/sensors/s2/frame': { seconds: 3 } });
  assert.deepEqual(latest([], 3), {});
});

test('what is fetched begins a second before, goes on ahead, and ends with the recording', () => {
  const usual = { speed: 1, length: 60 };
  assert.deepEqual(nextStretch(null, 10, usual), { from: 9, to: 10, every: 0 });
  assert.deepEqual(nextStretch([9, 10], 10, usual), { from: 10, to: 11, every: 0 });
  assert.equal(nextStretch([9, 12], 10, usual), null, 'two seconds lie ahead');
  assert.deepEqual(nextStretch([9, 10], 30, usual), { from: 29, to: 30, every: 0 }, 'elsewhere');
  assert.equal(nextStretch([50, 60], 59.5, usual), null, 'the end');
  assert.deepEqual(nextStretch([0, 1], 1, { speed: 4, length: 60 }), { from: 1, to: 5, every: 4 / 30 }, 'fewer frames when fast');
  assert.deepEqual(nextStretch([0, 1], 1, { speed: 8, length: 60 }), { from: 1, to: 6, every: 8 / 30 }, 'never more than the server allows');
});

const settled = () => new Promise((resolve) => { setImmediate(resolve); });

/// A server that has a frame each tenth of a second.
function played(length, clock) {
  const asked = [];
  const playback = new Playback({ seconds: length }, async ({ from, to }) => {
    asked.push([from, to]);
    const messages = [];
    for (let i = Math.max(0, Math.ceil(10 * from - 1e-9)); i <= 10 * to + 1e-9; i += 1) messages.push(at(i / 10 + 0));
    return { from, to, messages };
  }, () => clock.now);
  return { playback, asked };
}

test('time goes on at the chosen speed, stops at the end, and no message is shown twice', async () => {
  const clock = { now: 0 };
  const { playback } = played(5, clock);
  playback.seek(0);
  for (let i = 0; i < 4; i += 1) { playback.tick(); await settled(); }
  assert.equal(playback.at, 0, 'it does not play by itself');
  playback.toggle();
  for (clock.now = 100; clock.now <= 2000; clock.now += 100) { playback.tick(); await settled(); }
  assert.ok(Math.abs(playback.at - 2) < 0.05, `${playback.at}`);
  assert.deepEqual(playback.tick()['/frame'].seconds, Math.floor(10 * playback.at + 1e-9) / 10);
  const seconds = playback.messages.map((message) => message.seconds);
  assert.deepEqual(seconds, [...new Set(seconds)].sort((a, b) => a - b), 'in order, each once');
  playback.setSpeed(0.5);
  const before = playback.at;
  for (let i = 0; i < 10; i += 1) { clock.now += 100; playback.tick(); await settled(); }
  assert.ok(Math.abs(playback.at - before - 0.5) < 0.01);
  playback.seek(4.9);
  await settled();
  for (let i = 0; i < 10; i += 1) { clock.now += 100; playback.tick(); await settled(); }
  assert.equal(playback.at, 5);
  assert.equal(playback.playing, false);
  playback.toggle();
  assert.equal(playback.at, 0, 'from the beginning again');
});

test('it waits for the server, and says what is wrong with it', async () => {
  const clock = { now: 0 };
  const playback = new Playback({ seconds: 5 }, async () => { throw new Error('answered 503'); }, () => clock.now);
  playback.seek(1);
  playback.toggle();
  await settled();
  clock.now = 500;
  playback.tick();
  assert.equal(playback.at, 1, 'nothing is there to be shown');
  assert.equal(playback.waiting, true);
  assert.equal(playback.problem, 'answered 503');
});

test('instants are written as people read them', () => {
  assert.deepEqual([0, 62.44, 3599.97, NaN].map(timeText), ['0:00.0', '1:02.4', '60:00.0', '–']);
});

test('the first steps follow one another', () => {
  const here = { s1: {} };
  assert.equal(stepOf({ sensors: null }), 'sensors');
  assert.equal(stepOf({ sensors: here, registration: { verdict: 'Provisional' } }), 'register');
  assert.equal(stepOf({ sensors: here, registration: { verdict: 'Good', session: { state: 'collecting' } } }), 'register', 'the walk goes on');
  assert.equal(stepOf({ sensors: here, registration: { verdict: 'Good' } }), 'world');
  assert.equal(stepOf({ sensors: here, registration: { verdict: 'Good' }, originShown: true }), null);
});

test('an address is understood as people type it, and an id is one that is free', () => {
  assert.equal(addressOf('10.0.0.3'), 'http://10.0.0.3:8081/');
  assert.equal(addressOf(' kitchen:9000 '), 'http://kitchen:9000/');
  assert.equal(addressOf('https://kitchen.local/s/'), 'https://kitchen.local/s/');
  assert.equal(addressOf(''), '');
  assert.equal(freeId('s1', []), 's1');
  assert.equal(freeId('s1', ['s1', 's1-2']), 's1-3');
  assert.equal(freeId('', ['sensor-1']), 'sensor-2');
  assert.deepEqual(wishOf([{ id: 'a', url: 'u', token: '' }, { id: 'b', url: 'v', token: 't' }]),
    { sensors: [{ id: 'a', url: 'u' }, { id: 'b', url: 'v', token: 't' }] });
});

test('a hall has its cells with what they need, its people with where they went, and room around them', () => {
  const told = { siteName: 'hall-1', cell: 'A', connected: true, siteCells: { A: { state: 'own', people: 1, x: 0, z: 0 }, B: { state: 'heard', placed: false, people: 2 } } };
  assert.deepEqual(cellsOf(told).map(({ id }) => id), ['A', 'B']);
  assert.deepEqual(cellsOf({ siteCells: [{ cellId: '#A' }] }).map(({ id }) => id), ['A']);
  assert.match(wordsOf(cellsOf(told)[1], 'A'), /^2 people; nobody has walked from A to B yet/);
  assert.equal(wordsOf(cellsOf(told)[0], 'A'), '1 person');
  assert.equal(connectionOf(told).words, 'hall-1: 2 cells.');
  assert.match(connectionOf({ connected: false, trouble: 'wrong password' }).words, /wrong password.*goes on alone/);
  assert.deepEqual(boxOf([]), [-5, -5, 10, 10]);
  assert.deepEqual(boxOf([{ x: 0, z: 0 }, { x: 6, z: 1 }, { x: NaN, z: 0 }]), [-4.5, -4.5, 15, 10]);
  const people = peopleOf({ sitePeople: { 'A-3': { x: 1, z: 2 } } });
  let trails = trailsAfter(new Map(), people, 0);
  trails = trailsAfter(trails, people, 9000);
  assert.equal(trails.get('A-3').length, 2);
  assert.equal(trailsAfter(trails, people, 11000).get('A-3').length, 2, 'the first one is too old');
  assert.equal(trailsAfter(trails, [], 11000).size, 0);
});
