// The pure parts behind drawers: recordings by instant, the first steps, the hall from above.
import assert from 'node:assert/strict';
import { mock, test } from 'node:test';

import { History, linesOf, stripOf } from '../../services/viewer/curves.js';
import { drawerOfKey, drawersOf } from '../../services/viewer/drawers.js';
import { Playback, latest, nextStretch, placesAt, timeText } from '../../services/viewer/playback.js';
import { Player } from '../../services/viewer/player.js';
import { Resource, ServerClock } from '../../services/viewer/poll.js';
import { fetched, requested } from '../../services/viewer/request.js';
import { boxOf, cellsOf, connectionOf, pageOf, peopleOf, trailsAfter, wordsOf } from '../../services/viewer/hall.js';
import { frameOf, freshness, registrationOf, sensorsOf, stateOf } from '../../services/viewer/state.js';
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
  assert.deepEqual(nextStretch([9, 9.4], 10, usual), { from: 9.4, to: 10.4, every: 0 }, 'the server gave less than was asked for');
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

test('a server that gives a tenth of a second at once is asked on, and what was asked before a jump is forgotten', async () => {
  const clock = { now: 0 };
  const playback = new Playback({ seconds: 60 }, async ({ from, to }) => ({ from, to: Math.min(to, from + 0.1), messages: [at(from)] }), () => clock.now);
  playback.seek(0); // the answer to this comes after the jump
  playback.seek(30);
  for (let i = 0; i < 15; i += 1) { await settled(); playback.tick(); }
  assert.equal(playback.waiting, false);
  assert.ok(playback.held[0] >= 29 && playback.held[1] >= 30, `${playback.held}`);
  assert.ok(playback.messages.every(({ seconds }) => seconds >= 29), 'of the stretch that is held');
});

test('sensors stand where they stood at that instant', () => {
  const all = [{ seconds: 0.5, registration: 'a' }, { seconds: 6, registration: 'b' }];
  assert.deepEqual([0, 0.5, 5.9, 6, 60].map((seconds) => placesAt(all, seconds)), ['a', 'a', 'a', 'b', 'b']);
  assert.equal(placesAt([], 3), undefined);
  assert.equal(placesAt(undefined, 3), undefined);
});

/// A player of a server whose answers wait until they are let go; `log`: what it showed.
function watched() {
  mock.timers.enable({ apis: ['setInterval'] });
  const log = { fetched: [], failed: [], shown: [], placed: [], raw: [] };
  const waiting = [];
  const room = { sensors: new Map([['s1', {}], ['s9', {}]]), trails: { clear() {} }, place: ({ sensors }) => log.placed.push(sensors) };
  const player = new Player(room, {
    fetchJson: (path) => {
      log.fetched.push(path);
      if (/stretch/.test(path)) return Promise.resolve({ from: 0, to: 10, messages: [] });
      return new Promise((resolve, reject) => { waiting.push({ path, resolve, reject }); });
    },
    onShown: (playback) => log.shown.push(playback?.name ?? null), onFailed: (words) => log.failed.push(words), onFrame: () => {}, onRaw: (id) => log.raw.push(id),
  });
  mock.timers.reset();
  const answer = async (path, outline) => {
    const one = waiting.find((each) => each.path.includes(path));
    waiting.splice(waiting.indexOf(one), 1);
    if (outline instanceof Error) one.reject(outline);
    else one.resolve({ seconds: 10, sensors: ['s1'], ...outline });
    await settled();
  };
  return { player, log, answer };
}

test('a recording that is refused, overtaken or closed leaves the one that is shown as it is', async () => {
  const { player, log, answer } = watched();
  player.open('a');
  await answer('/a/outline', { registrations: [{ seconds: 0, registration: { sensors: 1 } }, { seconds: 6, registration: { sensors: 2 } }] });
  assert.deepEqual(log.shown, ['a']);
  assert.deepEqual(log.raw, ['s1', 's9'], 'what other sensors saw last is taken away too');
  player.playback.seek(7);
  player.step();
  player.playback.seek(3);
  player.step();
  assert.deepEqual(log.placed, [1, 2, 1], 'places of the instant, forwards and backwards');
  player.open('refused');
  await answer('/refused/outline', new Error('none'));
  assert.match(log.failed.join(), /refused cannot be opened: none/);
  [player.playback.held, log.fetched.length] = [null, 0];
  player.step();
  assert.match(log.fetched.join(), /^recordings\/a\/stretch/, 'its own stretches, under its own name');
  player.open('slow');
  player.open('b');
  await answer('/b/outline');
  await answer('/slow/outline');
  assert.equal(log.shown.at(-1), 'b');
  player.outlineAgain();
  player.open('late');
  player.close();
  await answer('/b/outline');
  await answer('/late/outline');
  assert.equal(log.shown.at(-1), null);
  assert.equal(player.playback, null);
});

test('keys open what has a tab, and nothing else', () => {
  const names = (known, only) => drawersOf(known, only).map(([name]) => name);
  assert.deepEqual(names({}, true), ['playback', 'view']);
  assert.ok(!names({}, false).includes('hall') && names({ site: 'hall-1' }, false).includes('hall'));
  assert.deepEqual([...'srwepglv'].map((key) => drawerOfKey(key, { site: null }, true)), [null, null, null, null, null, null, 'playback', 'view']);
  assert.equal(drawerOfKey('g', { site: null }, false), null);
  assert.equal(drawerOfKey('g', { site: 'hall-1' }, false), 'hall');
  assert.equal(drawerOfKey('x', {}, false), null);
});

test('a picture that breaks off is a problem, not an end', async () => {
  mock.method(globalThis, 'fetch', async () => ({ ok: true, blob: async () => { throw new TypeError('network error'); } }));
  assert.deepEqual(await fetched('x'), { problem: 'the answer broke off' });
  mock.restoreAll();
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
  assert.match(connectionOf(told, 'answered 503').words, /tells nothing of the hall: answered 503/);
  assert.equal(pageOf({ state: 'heard', address: 'http://b:8080/' }), 'http://b:8080/viewer/');
  assert.deepEqual(['http://', 'https://b:port/', 'javascript:x', undefined].map((address) => pageOf({ state: 'heard', address })), [null, null, null, null]);
  assert.equal(pageOf({ state: 'own', address: 'http://b:8080/' }), null);
  assert.deepEqual(boxOf([]), [-5, -5, 10, 10]);
  assert.deepEqual(boxOf([{ x: 0, z: 0 }, { x: 6, z: 1 }, { x: NaN, z: 0 }]), [-4.5, -4.5, 15, 10]);
  const people = peopleOf({ sitePeople: { 'A-3': { x: 1, z: 2 } } });
  let trails = trailsAfter(new Map(), people, 0);
  trails = trailsAfter(trails, people, 9000);
  assert.equal(trails.get('A-3').length, 2);
  assert.equal(trailsAfter(trails, people, 11000).get('A-3').length, 2, 'the first one is too old');
  assert.equal(trailsAfter(trails, [], 11000).size, 0);
});

test('the last minute as lines: heights and speeds by person, rates and ages by source, limbs with what they are allowed', () => {
  const history = new History();
  const moment = (i, more = {}) => ({ rate: 30, age: 20 + i, sensors: { s1: { state: 'live', rateHz: 29, ageMilliseconds: 12 }, s2: { state: 'lost', rateHz: 30, ageMilliseconds: 9000 } },
    frame: { captured: new Date(1e12 + 100 * i).toISOString(), bodies: [{ bodyId: 4, joints: { Head: { x: 0.05 * i, y: 1.7, z: 0 }, Neck: { state: 'NotTracked' } } }] }, ...more });
  for (let i = 0; i < 700; i += 1) {
    history.take(moment(i), 100 * i);
    history.take(moment(i), 100 * i + 20); // too early
  }
  assert.equal(history.samples.length, 601, 'a minute, ten times a second');
  const speed = linesOf(history, 'speed', 'Head', 70000);
  assert.deepEqual([speed.seconds[0], speed.seconds.at(-1)], [-60.1, -0.1]);
  assert.deepEqual(speed.lines.map(({ name }) => name), ['person 4']);
  assert.equal(speed.lines[0].values[0], null, 'nothing before it');
  assert.ok(Math.abs(speed.lines[0].values.at(-1) - 0.5) < 1e-4, '50 mm in 100 ms');
  assert.equal(linesOf(history, 'height', 'Head', 70000).lines[0].values.at(-1), 1.7, 'as it was served');
  assert.deepEqual(linesOf(history, 'height', 'Neck', 70000).lines[0].values.at(-1), null);
  const newest = (kind) => Object.fromEntries(linesOf(history, kind, '', 70000).lines.map(({ name, values }) => [name, values.at(-1)]));
  assert.deepEqual(newest('rate'), { fused: 30, s1: 29, s2: null });
  assert.deepEqual(newest('age'), { fused: 719, s1: 12, s2: null }, 'a lost sensor has no line that stands still');
  assert.deepEqual(linesOf(new History(), 'speed', 'Head', 0), { seconds: [], lines: [], leftOut: 0, limit: null });

  history.take(moment(800), 80000); // after ten seconds of nothing
  assert.equal(linesOf(history, 'height', 'Head', 80000).lines[0].values.at(-1), null, 'a gap');
  history.take(moment(801, { frame: { captured: 'x', bodies: Array.from({ length: 20 }, (_, i) => ({ bodyId: i, joints: {} })) } }), 80100);
  assert.equal(linesOf(history, 'height', 'Head', 80100).leftOut, 20 - 12);
});

test('of more names than lines, those that the newest sample has are drawn, each in the colour that it had', () => {
  const history = new History();
  const twenty = Array.from({ length: 20 }, (_, i) => [`s${i}`, { state: 'live', rateHz: i }]);
  const body = (bodyId) => ({ bodyId, joints: { Head: { x: 0, y: 1.7, z: 0 } } });
  history.take({ sensors: Object.fromEntries(twenty), frame: { bodies: twenty.map((_, i) => body(i)) } }, 0);
  const before = linesOf(history, 'rate', '', 0).lines;
  assert.deepEqual(before.slice(0, 3).map(({ name }) => name), ['fused', 's0', 's1']);
  history.take({ sensors: Object.fromEntries([twenty[19], twenty[2]]), frame: { bodies: [body(18), body(3)] } }, 100);
  const rates = linesOf(history, 'rate', '', 100);
  assert.deepEqual([rates.lines.length, rates.leftOut], [12, 9]);
  assert.deepEqual(rates.lines.slice(0, 4).map(({ name, values }) => [name, values.at(-1)]), [['fused', null], ['s2', 2], ['s19', 19], ['s0', null]]);
  for (const { name, colour } of before) assert.equal(rates.lines.find((line) => line.name === name)?.colour ?? colour, colour, name);
  assert.deepEqual(linesOf(history, 'height', 'Head', 100).lines.slice(0, 3).map(({ name, values }) => [name, values.at(-1)]), [['person 3', 1.7], ['person 18', 1.7], ['person 0', null]]);

  history.take({ age: NaN, sensors: null }, 200); // the server is gone
  for (const kind of ['height', 'rate', 'age']) assert.ok(linesOf(history, kind, 'Head', 200).lines.every(({ values }) => values.at(-1) === null), kind);
});

test('judgements that are none are left out of the curves', () => {
  for (const limbs of [{}, 'x', 7, null, [null, 7, 'x']]) {
    const history = new History();
    history.take({ evaluation: { limbs }, rate: 30 }, 0);
    assert.deepEqual(stripOf(history, 0), [], JSON.stringify(limbs));
    assert.equal(linesOf(history, 'rate', '', 0).lines[0].values[0], 30);
  }
});

test('how limbs were judged in the last minute', () => {
  const history = new History();
  const judged = (state, angleDegrees) => ({ evaluation: { limbs: [{ bodyId: 1, limb: 'ForearmLeft', state, angleDegrees, thresholdDegrees: '45.0' }] } });
  [['calibrating'], ['good', '9.5'], ['good', '12.0'], ['off', '70.2']].forEach((one, i) => history.take(judged(...one), 100 * i));
  history.take({}, 400);
  history.take(judged('good', '8.0'), 9000);
  const [{ limb, runs }] = stripOf(history, 9000);
  assert.equal(limb, 'ForearmLeft, person 1');
  assert.deepEqual(runs.map(({ state, from, to }) => [state, from, to]),
    [['calibrating', -9, -8.9], ['good', -8.9, -8.7], ['off', -8.7, -8.6], ['waiting', -8.6, -8.6], ['good', 0, 0]]);
  const { lines, limit } = linesOf(history, 'limbs', '', 9000);
  assert.deepEqual(lines.map(({ name, values }) => [name, values]), [['ForearmLeft, person 1', [null, 9.5, 12, 70.2, null, null]]]);
  assert.equal(limit, 45);
});

test('what cannot be read is asked for again, and its reason is kept until something can be', async () => {
  const asked = [];
  const replies = [];
  mock.method(globalThis, 'fetch', async (url, { headers }) => { asked.push(headers['If-None-Match'] ?? ''); return replies.shift(); });
  const reply = (status, text) => replies.push(new Response(status === 304 ? null : text, { status, headers: { ETag: '"7"' } }));
  const resource = new Resource('http://x/registration', 0, registrationOf);
  const problem = async () => { await resource.next().catch(() => {}); return [resource.problem?.message ?? '', resource.failures]; };
  reply(200, '{"verdict":');
  assert.deepEqual(await problem(), ['its answer cannot be read', 1]);
  reply(200, '{"reasons":"none"}');
  assert.deepEqual(await problem(), ['what it says cannot be read', 2]);
  reply(503, '{"detail":"too many"}');
  assert.deepEqual(await problem(), ['it answered 503: too many', 3]);
  reply(401, 'null');
  assert.deepEqual(await problem(), ['it asks for a token', 4]);
  assert.equal(resource.problem.status, 401);
  reply(200, '{"verdict":"Good"}');
  assert.deepEqual(await resource.next(), { verdict: 'Good' });
  reply(304, '');
  assert.equal(await resource.next(), null);
  assert.deepEqual([resource.problem, resource.failures], [null, 0]);
  assert.deepEqual(asked, ['', '', '', '', '', '"7"'], 'no ETag of what could not be read');
  mock.restoreAll();
});

test('a clock that is set back is believed at once, a late answer is not', () => {
  const ticking = { now: 0 };
  const clock = new ServerClock(() => ticking.now);
  const tells = (ms) => clock.observe(`0 ${ms}000000`);
  tells(9_000_000);
  ticking.now = 9000;
  tells(9_001_000); // eight seconds on its way
  assert.equal(clock.now(), 9_009_000);
  tells(9_009_000 - 3_600_000);
  assert.equal(clock.now(), 9_009_000 - 3_600_000);
});

test('a frame is a frame: without what is no body, no joint, or too many', () => {
  const times = { sequence: 1, captured: '2026-11-27T10:00:00Z', capturedNanoseconds: '1' };
  for (const none of [null, [], 42, 'x', {}, { ...times, sequence: 'x' }, { ...times, captured: 'now' }, { ...times, capturedNanoseconds: '1.5' }]) assert.throws(() => frameOf(none), /is none/);
  assert.deepEqual(frameOf({ ...times, bodies: 7 }).bodies, []);
  const frame = frameOf({ ...times, bodies: [null, { bodyId: 1 }, { bodyId: 2, joints: { Head: null, Neck: { x: 1 } } }, ...Array.from({ length: 70 }, () => ({ joints: {} }))] });
  assert.deepEqual(frame.bodies[0], { bodyId: 2, joints: { Neck: { x: 1 } } });
  assert.deepEqual([frame.bodies.length, frame.leftOut], [64, 7]);
  assert.deepEqual(sensorsOf({ sensors: { a: null, b: { state: 'live' } } }).sensors, { b: { state: 'live' } });
  for (const none of [null, [], { sensors: 'x' }]) assert.throws(() => sensorsOf(none));
  for (const none of [null, { alarms: {} }, { sensors: [] }]) assert.throws(() => registrationOf(none));
});

test('a server that refuses is named with its reason, and so is what it says nothing of', () => {
  const problem = Object.assign(new Error('it asks for a token'), { status: 401 });
  const link = { error: null, silent: 10 };
  const refused = { link, frame: null, frameAge: NaN, frameProblem: problem };
  assert.deepEqual(stateOf(refused), { tone: 'bad', sentence: 'The fusion server gives no frames: it asks for a token.', next: 'Load this page again, and give the token as the password.' });
  assert.equal(freshness(refused), 'gone');
  const told = { link, frame: { bodies: [] }, frameAge: 20, frameProblem: problem, sensors: { a: { state: 'live' } }, registration: { verdict: 'Good', sensors: { a: {} } } };
  assert.equal(stateOf(told).sentence, 'Nobody is in sight.', 'one answer among good ones is not worth a sentence');
  const unread = stateOf({ ...told, unread: [['the sensors', new Error('it answered 500')]] });
  assert.deepEqual([unread.tone, unread.sentence], ['warn', 'The fusion server says nothing of the sensors: it answered 500.']);
});

test('an action that is lost says so', async () => {
  mock.method(globalThis, 'fetch', async () => { throw new TypeError('Failed to fetch'); });
  assert.deepEqual(await requested('http://x/'), { problem: 'the server does not answer', body: null });
  mock.restoreAll();
});
