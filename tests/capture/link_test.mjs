// The page's connection to its sensor: tokens, a busy sensor, one that goes away, and what is never tried twice.
import assert from 'node:assert/strict';
import { afterEach, beforeEach, mock, test } from 'node:test';

import { Link, atTheDoor } from '../../services/capture/link.js';

const answers = (status, problem = {}) => async () => new Response(JSON.stringify(problem), { status });
const nobody = async () => { throw new TypeError('refused'); };
const ROOT = 'https://door.local:8081/';

class FakeSocket {
  static all = [];

  constructor(url, protocols) {
    Object.assign(this, { url, protocols, sent: [], bufferedAmount: 0 });
    FakeSocket.all.push(this);
  }

  send(text) { this.sent.push(JSON.parse(text)); }
  close() { this.onclose?.(); }
  says(message) { this.onmessage({ data: JSON.stringify(message) }); }
}
const settle = async () => { for (let i = 0; i < 10; ++i) await new Promise((resolve) => setImmediate(resolve)); };
const WELCOME = { type: 'welcome', sensor: 's7', version: 1, maxRateHz: 120, joints: [] };
const BUSY = { type: 'bye', code: 'conflict', context: 'type', detail: '"another" pushes to this sensor already' };

function opened(more = {}) {
  const heard = [];
  const complaints = [];
  const link = new Link({ root: ROOT, token: 'secret', hello: { name: 'n', layout: 'coco_17' }, changed: (state) => heard.push(state),
    complain: (text) => complaints.push(text), Socket: FakeSocket, ask: answers(400), ...more });
  links.push(link);
  return { link, heard, complaints };
}
let links = [];
const states = (heard) => heard.map(({ state }) => state);

beforeEach(() => {
  FakeSocket.all = [];
  mock.timers.reset();
  mock.timers.enable({ apis: ['setTimeout'] });
});

afterEach(async () => {
  for (const link of links) link.close();
  links = [];
  await settle();
});

test('the door tells a wrong token from a missing one, and a weak one from none in the sensor', async () => {
  const at = async (status, token) => (await atTheDoor(ROOT, token, answers(status, { detail: 'why' }))).state;
  assert.equal(await at(400, ''), 'open', 'a POST of nothing is malformed, and that is all it is');
  assert.equal(await at(401, ''), 'token');
  assert.equal(await at(401, 'abc'), 'wrong');
  assert.equal(await at(403, 'abc'), 'role');
  assert.equal(await at(403, ''), 'unset');
  assert.equal(await at(429, 'abc'), 'tries');
  assert.equal((await atTheDoor(ROOT, '', nobody)).state, 'unreachable');
  let asked;
  await atTheDoor(ROOT, 'abc', async (...words) => { asked = words; return new Response('', { status: 400 }); });
  assert.equal(asked[0], `${ROOT}push`);
  assert.deepEqual([asked[1].method, asked[1].body, asked[1].headers], ['POST', '', { Authorization: 'Bearer abc' }]);
});

test('it says hello over TLS with the token as a subprotocol, and again when the lens changes', async () => {
  const { link, heard } = opened({ token: 'it’s 100%' });
  await settle();
  const [socket] = FakeSocket.all;
  assert.equal(socket.url, 'wss://door.local:8081/push');
  assert.deepEqual(socket.protocols, ['chorus.push', 'chorus.token.it%E2%80%99s%20100%25']);
  assert.equal(link.push([], 0), false, 'nothing before the welcome');
  socket.onopen();
  socket.says(WELCOME);
  assert.deepEqual(heard.at(-1), { state: 'welcomed', detail: '', sensor: 's7' });
  assert.equal(link.push([], 0), true);
  link.say({ name: 'n', layout: 'mediapipe_33' });
  assert.deepEqual(socket.sent.map(({ type, layout }) => layout ?? type), ['coco_17', 'frame', 'mediapipe_33']);
});

test('a wrong token is tried once, never again by itself', async () => {
  const { heard } = opened({ ask: answers(401) });
  await settle();
  mock.timers.tick(60000);
  await settle();
  assert.deepEqual(states(heard), ['wrong']);
  assert.equal(FakeSocket.all.length, 0);
});

test('a busy sensor is asked again, and taken once it is free', async () => {
  const { heard } = opened();
  await settle();
  FakeSocket.all[0].says(BUSY);
  FakeSocket.all[0].close();
  assert.deepEqual(states(heard), ['busy']);
  assert.match(heard[0].detail, /"another" pushes/);
  mock.timers.tick(1000);
  await settle();
  FakeSocket.all[1].says(WELCOME);
  assert.deepEqual(states(heard), ['busy', 'welcomed']);
});

test('a sensor that goes away is unreachable, and found again', async () => {
  let ask = answers(400);
  const { heard } = opened({ ask: (...words) => ask(...words) });
  await settle();
  FakeSocket.all[0].says(WELCOME);
  ask = nobody;
  FakeSocket.all[0].close();
  mock.timers.tick(1000);
  await settle();
  assert.deepEqual(states(heard), ['welcomed', 'connecting', 'unreachable']);
  ask = answers(400);
  mock.timers.tick(1000);
  await settle();
  FakeSocket.all[1].says(WELCOME);
  assert.equal(heard.at(-1).state, 'welcomed');
});

test('connections that end without a word are told after some', async () => {
  const { heard } = opened();
  for (let i = 0; i < 4; ++i) {
    await settle();
    FakeSocket.all[i].close();
    mock.timers.tick(1000);
  }
  assert.deepEqual(states(heard), ['connecting', 'connecting', 'connecting', 'shut']);
});

test('a refused frame is a complaint, and a closed link says nothing more', async () => {
  const { link, heard, complaints } = opened();
  await settle();
  const [socket] = FakeSocket.all;
  socket.says(WELCOME);
  socket.says({ type: 'error', code: 'malformed', context: 'captured', detail: 'is in the future', unsaid: 0 });
  assert.deepEqual(complaints, ['captured: is in the future']);
  link.close();
  mock.timers.tick(60000);
  await settle();
  assert.deepEqual(states(heard), ['welcomed']);
  assert.equal(FakeSocket.all.length, 1);
});
