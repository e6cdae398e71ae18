// The viewer shows one sentence for each state of the tracker, in a matching colour, and follows the server's clock.
import assert from 'node:assert/strict';
import { test } from 'node:test';

import { Link, ServerClock } from '../../services/viewer/poll.js';
import { REACH, axesOf, covarianceOf, jointLines, personLine, rootOf, sharesOf } from '../../services/viewer/certainty.js';
import { accuracyLine, lineOf, mapOf } from '../../services/viewer/coverage.js';
import { framing, roomOf } from '../../services/viewer/framing.js';
import { OutputRate, OwnDelay, ageText, freshness, sidesOf, stateOf } from '../../services/viewer/state.js';
import { ergonomicsBase, scoreText, stanceText } from '../../services/viewer/work.js';

const LIVE = { state: 'live' };
const GOOD = { verdict: 'Good', reasons: [], awaits: [], session: { state: 'idle' }, sensors: { s1: {}, s2: {} } };
const known = (changes) => ({
  link: { error: null, silent: 20 }, frame: { bodies: [{}] }, frameAge: 40, sensors: { s1: LIVE, s2: LIVE }, registration: GOOD, ...changes,
});
const said = (changes) => { const { tone, sentence } = stateOf(known(changes)); return `${tone}: ${sentence}`; };

test('good is only what is live, registered and seen', () => {
  assert.equal(said({}), 'good: Live: one person, 2 sensors.');
  assert.equal(said({ frame: { bodies: [{}, {}] } }), 'good: Live: 2 people, 2 sensors.');
  assert.equal(said({ frame: { bodies: [{}, { carriedFor: 0.4 }] } }), 'good: Live: 2 people (1 out of sight), 2 sensors.');
  assert.equal(said({ frame: { bodies: [] } }), 'calm: Nobody is in sight.');
  assert.equal(said({ registration: { ...GOOD, verdict: 'Provisional', reasons: ['short'] } }), 'warn: Live: one person. The places are provisional.');
  assert.equal(said({ registration: { ...GOOD, proposal: { changes: [] } } }), 'warn: New places wait for your decision.');
  assert.equal(said({ registration: { ...GOOD, unplaced: { s5: { reasons: ['coat stand'] } } } }), 'warn: Live: one person. s5 has no place.');
});

test('dead sensors are told, with the reason as the next step', () => {
  const dead = { state: 'lost', lastError: 'connection refused' };
  assert.equal(said({ sensors: {} }), 'bad: No sensors are configured.');
  assert.equal(said({ sensors: { s1: dead, s2: dead } }), 'bad: None of the 2 sensors delivers anything.');
  const one = stateOf(known({ sensors: { s1: LIVE, s2: dead } }));
  assert.deepEqual(one, { tone: 'warn', sentence: 'Live: one person. s2 delivers nothing.', next: 's2: connection refused' });
});

test('registering says how far it is and what it awaits', () => {
  const walking = { ...GOOD, session: { state: 'collecting', elapsedSeconds: 11.6, targetSeconds: 30 }, awaits: ['keep walking: 18 s more'] };
  assert.deepEqual(stateOf(known({ registration: walking })), { tone: 'warn', sentence: 'Registering: 12 of 30 s of the walk seen.', next: 'keep walking: 18 s more' });
  const none = { verdict: 'None', sensors: {}, awaits: ['nobody is in sight'], session: { state: 'idle' } };
  assert.equal(stateOf(known({ registration: none })).next, 'nobody is in sight');
  assert.equal(said({ registration: none }), 'warn: It is not known yet where the sensors stand.');
});

test('a server that is gone or stands still is never good', () => {
  const gone = { error: 'TypeError', silent: 61000 };
  assert.equal(said({ link: gone }), 'bad: The fusion server has not answered for 61 s.');
  assert.equal(said({ link: { error: 'TypeError', silent: NaN }, frame: null }), 'bad: The fusion server does not answer.');
  assert.equal(said({ frameAge: 7000 }), 'bad: The fused output has stood still for 7 s.');
  assert.equal(freshness(known({})), 'live');
  assert.equal(freshness(known({ frameAge: 2000 })), 'stale');
  assert.equal(freshness(known({ link: { error: 'x', silent: 500 } })), 'stale');
  assert.equal(freshness(known({ link: gone })), 'gone');
  assert.equal(freshness(known({ frame: null })), 'gone');
});

test('the rate is that of the tracker, not of the page', () => {
  const frame = (sequence, seconds) => ({ sequence, capturedNanoseconds: String(BigInt(Math.round(seconds * 1e6)) * 1000n) });
  const rate = new OutputRate();
  assert.ok(Number.isNaN(rate.after(frame(1000, 5))));
  for (let i = 10; i <= 300; i += 10) assert.ok(Math.abs(rate.after(frame(1000 + i, 5 + i / 30)) - 30) < 1e-3); // every tenth arrives
  assert.ok(Number.isNaN(rate.after(frame(900000, 16)))); // another run of the server
  assert.ok(Math.abs(rate.after(frame(900015, 17)) - 15) < 1e-3);
  assert.ok(Number.isNaN(rate.after(frame(7, 18))));
});

test('ages are in the unit that people read', () => {
  assert.deepEqual([NaN, 41.6, 9999, 40412].map(ageText), ['–', '42 ms', '9999 ms', '40 s']);
});

test('a page that was itself held up does not blame the server', () => {
  let ticks = 0;
  const delay = new OwnDelay(200, () => ticks);
  const after = (ms) => { ticks += ms; return delay.late(); };
  assert.equal(after(200), false);
  assert.equal(after(600), false, 'a hiccup');
  assert.equal(after(5000), true, 'nothing of this page ran for 5 s');
  assert.equal(said({ frameAge: 5000, held: true }), 'warn: This page was held up, and catches up.');
  assert.equal(freshness(known({ frameAge: 5000, held: true })), 'stale', 'nothing is wiped out');
  assert.equal(said({ frameAge: 40, held: true }), 'good: Live: one person, 2 sensors.', 'it has caught up');
  assert.equal(after(200), true, 'frames may still be on their way');
  for (let i = 0; i < 7; ++i) after(200);
  assert.equal(delay.late(), false);
  assert.equal(said({ frameAge: 7000, held: false }), 'bad: The fused output has stood still for 7 s.');
});

test('a walk that contradicted the places leaves them in doubt', () => {
  const reason = 'the sensors that have a place do not stand as the last walk showed them: if one was moved, register all anew';
  assert.deepEqual(stateOf(known({ registration: { ...GOOD, reasons: [reason] } })),
    { tone: 'warn', sentence: 'Live: one person. The places are in doubt.', next: reason });
  const coat = { ...GOOD, reasons: ['coat stand'], unplaced: { s5: { reasons: ['coat stand'] } } };
  assert.equal(said({ registration: coat }), 'warn: Live: one person. s5 has no place.');
  const others = { ...GOOD, sensors: { cam1: { polled: false } }, awaits: ['the stored places are of another setup'] };
  assert.equal(said({ registration: others }), 'warn: It is not known yet where the sensors stand.');
});

test('the server’s clock is read from the quickest answers and ticks by itself', () => {
  let ticks = 1000;
  const clock = new ServerClock(() => ticks);
  assert.ok(Number.isNaN(clock.now()));
  clock.observe(`${5_000_000_000n} ${5_000_000_000n}`); // 5000 ms
  ticks += 300; // an answer that took 200 ms to arrive
  clock.observe(`${5_100_000_000n} ${5_100_000_000n}`);
  assert.equal(clock.now(), 5300);
  clock.observe('nonsense');
  clock.observe(null);
  ticks += 10;
  assert.equal(clock.now(), 5310);
});

test('an error status is an answer, no answer is none', () => {
  let ticks = 0;
  const link = new Link(() => ticks);
  assert.ok(Number.isNaN(link.state().silent));
  link.up();
  ticks = 700;
  link.down(new Error('refused'));
  assert.deepEqual(link.state(), { error: 'refused', silent: 700 });
  link.up();
  assert.deepEqual(link.state(), { error: null, silent: 0 });
});

test('left and right are as certain as those of the least certain person', () => {
  assert.equal(sidesOf({ bodies: [{ sidesConfidence: 0.9987 }, { sidesConfidence: 0.516 }, {}] }), '51 % certain');
  assert.equal(sidesOf({ bodies: [{ sidesConfidence: 0.9999 }] }), '99 % certain', 'never rounded to certainty');
  assert.equal(sidesOf({ bodies: [{}] }), '–');
  assert.equal(sidesOf(null), '–');
});

test('a sensor that was moved comes before the verdict, and says what to do', () => {
  const registration = { verdict: 'Good', sensors: { s1: {}, s2: {} }, alarms: ['s3 was moved by about 60 mm 12 s ago; it is being placed anew: walk where it and others see you'] };
  const told = stateOf(known({ registration }));
  assert.equal(told.tone, 'bad');
  assert.equal(told.sentence, 's3 was moved by about 60 mm 12 s ago.');
  assert.equal(told.next, 'it is being placed anew: walk where it and others see you');
});

test('the map of a walk has its cells, its sensors, and the pairs that are linked', () => {
  const session = { floorCells: [{ x: 0.25, z: 1.75, seenBy: 5 }], coverage: [
    { target: 's1', source: 's2', sightings: 900, spread: 0.8, expectedRadius: 0.041 },
    { target: 's1', source: 's3', sightings: 3, spread: 0.1, expectedRadius: 4.2 }] };
  const { cells, sensors, links } = mapOf(session, { s1: { x: 0, z: 0 }, s2: { x: 2, z: 1 } });
  assert.deepEqual(cells, [{ x: 0.25, z: 1.75, level: 3 }]);
  assert.deepEqual(sensors.map(({ id }) => id), ['s1', 's2']);
  assert.equal(links[0].good, true);
  assert.equal(links[1].good, false);
  assert.equal(links[1].to, undefined, 's3 has no place yet');
  assert.equal(lineOf(links[0]), 's1 – s2: 900 common sightings, ±41 mm expected');
  assert.match(lineOf(links[1]), /more than 1 m expected$/);
  assert.deepEqual(mapOf(null), { cells: [], sensors: [], links: [], accuracy: [] });
});

test('what the walk tells of each sensor so far, the worst first', () => {
  const { accuracy } = mapOf({ targetRadius: 0.03, accuracy: [
    { sensorId: 's1', expectedRadius: 0.012 }, { sensorId: 's2', expectedRadius: 0.041 }, { sensorId: 's3' }] });
  assert.deepEqual(accuracy.map(accuracyLine),
    ['s3: no place yet', 's2: ±41 mm so far, ±30 wanted', 's1: ±12 mm so far, ±30 wanted']);
  assert.deepEqual(accuracy.map(({ good }) => good), [false, false, true]);
});

/// R diag(variances) R^T of a turn about z, then about x.
function turned([a, b, c], z, x) {
  const [cz, sz, cx, sx] = [Math.cos(z), Math.sin(z), Math.cos(x), Math.sin(x)];
  const rows = [[cz, -sz, 0], [cx * sz, cx * cz, -sx], [sx * sz, sx * cz, cx]];
  const term = (i, j) => a * rows[i][0] * rows[j][0] + b * rows[i][1] * rows[j][1] + c * rows[i][2] * rows[j][2];
  return [term(0, 0), term(0, 1), term(0, 2), term(1, 1), term(1, 2), term(2, 2)];
}

test('an ellipsoid has the axes and the shape of its covariance', () => {
  const variances = [9e-4, 4e-4, 1e-4];
  for (const [z, x] of [[0, 0], [0.4, 1.1], [2, -0.7], [Math.PI / 2, 0]]) {
    const covariance = turned(variances, z, x);
    axesOf(covariance).forEach((sigma, i) => assert.ok(Math.abs(sigma - [0.03, 0.02, 0.01][i]) < 1e-9, `${sigma}`));
    const [a, b, c, d, e, f] = rootOf(covariance);
    const product = [a * a, a * b, a * d, b * b + c * c, b * d + c * e, d * d + e * e + f * f];
    product.forEach((term, i) => assert.ok(Math.abs(term - covariance[i]) < 1e-12, `L L^T, term ${i}`));
  }
  assert.deepEqual(axesOf([4e-4, 0, 0, 4e-4, 0, 4e-4]), [0.02, 0.02, 0.02], 'a ball');
  assert.deepEqual(rootOf([0, 0, 0, 0, 0, 0]), [0, 0, 0, 0, 0, 0], 'a point');
  assert.ok(rootOf([1e-4, 0, 0, 0, 0, 1e-4]).every(Number.isFinite), 'a flat one');
  assert.ok(Math.abs(REACH - 2.7955) < 1e-4);
});

test('a joint is told with its size, its sensors and its age; what is not stated is not made up', () => {
  const joint = { state: 'Inferred', x: 0, y: 1, z: 0, cxx: 1e-4, cxy: 0, cxz: 0, cyy: 1e-4, cyz: 0, czz: 1e-4, contributors: ['s10', 's2'], shares: [0.04, 0.96] };
  const body = { bodyId: 7, sidesConfidence: 0.999, joints: { Head: joint, Neck: { state: 'Tracked', x: 0, y: 1, z: 0 } } };
  assert.deepEqual(jointLines(body, 'Head', 41.4),
    ['Head (inferred), person 7', '95 % within ±28 × 28 × 28 mm', 'from s2 96 %, s10 4 %', 'seen, 41 ms old']);
  assert.deepEqual(jointLines({ ...body, carriedFor: 0.44 }, 'Neck', 41.4),
    ['Neck, person 7', 'how sure: not stated', 'from no sensor: where it is expected', 'out of sight for 0.4 s']);
  assert.equal(jointLines({ bodyId: 7, joints: { Hand: { state: 'Inferred', contributors: [], age: 0.25 } } }, 'Hand', 41.4)[3],
    'seen, 291 ms old', 'a joint that nobody sees is older than the frame');
  assert.deepEqual(sharesOf({ contributors: ['s2', 's1'], shares: [0.3, 0.7] }), [{ id: 's2', share: 0.7 }, { id: 's1', share: 0.3 }],
    'shares are in the order of the ids, whatever that of the contributors');
  assert.deepEqual(sharesOf({ contributors: ['s2'] }), [{ id: 's2', share: 1 }], 'one sensor has all');
  assert.deepEqual(sharesOf({ contributors: ['s1', 's2'] }), [{ id: 's1', share: NaN }, { id: 's2', share: NaN }], 'not known');
  assert.equal(covarianceOf({ cxx: 1, cxy: 0 }), null, 'half a covariance is none');
  assert.equal(personLine(body), 'person 7: seen, left and right 99 % certain', 'never rounded up to certainty');
  assert.equal(personLine({ bodyId: 8 }), 'person 8: seen, left and right not looked at');
});

test('the room is drawn in the part of the window that the panel leaves free', () => {
  const across = ({ fov }, height, pixels) => (2 * Math.atan((Math.tan((fov * Math.PI) / 360) * pixels) / height) * 180) / Math.PI;
  const wide = framing(1280, 800, { left: 360 });
  assert.deepEqual({ ...wide, fov: Math.round(wide.fov) }, { fov: 45, left: 180, top: 0 });
  const below = framing(420, 800, { top: 360 });
  assert.deepEqual([below.left, below.top], [0, 180], 'below the panel');
  assert.ok(Math.abs(across(below, 800, 420) - 45) < 0.1, 'as much of the room as a wide window shows');
  const between = framing(1280, 800, { left: 260, right: 260, bottom: 200 });
  assert.deepEqual([between.left, between.top], [0, -100], 'between the panels, above the drawer');
  assert.ok(framing(1, 1).fov <= 120 && framing(0, 0).fov > 0, 'whatever a window may be');
});

test('the room is what sensors look at, not only where they stand', () => {
  const ahead = { x: 0, y: 1.6, z: 0, qx: 0, qy: 0, qz: 0, qw: 1 };
  const { centre, reach } = roomOf([ahead, { ...ahead, x: -2.6, z: 1.5, qy: Math.SQRT1_2, qw: Math.SQRT1_2 }]); // looks along +x
  assert.ok(Math.abs(centre.x + 0.675) < 0.01 && Math.abs(centre.z - 1.375) < 0.01, JSON.stringify(centre));
  assert.ok(reach >= 2.2);
  assert.deepEqual(roomOf([]), { centre: { x: 0, z: 0 }, reach: 2.2 });
});

test('an alarm has its advice as the next step', () => {
  const alarms = ['s4 has seen somebody where no other sensor does for 12 s; if it was moved, run chorus register'];
  const { tone, sentence, next } = stateOf(known({ registration: { ...GOOD, alarms } }));
  assert.deepEqual([tone, sentence], ['bad', 's4 has seen somebody where no other sensor does for 12 s.']);
  assert.ok(next.startsWith('if it was moved'));
});

test('work says scores with their set, what is wrong with a stance, and where it looked', () => {
  assert.equal(scoreText({ method: 'reba', scoreHigh: 6, setFrom: 5, setTo: 7, shownScore: 6 }), 'reba: 6 (5 to 7)');
  assert.equal(scoreText({ method: 'owas', scoreHigh: 2, setFrom: 2, setTo: 2, shownScore: 0 }), 'owas: 2 (2)');
  assert.equal(scoreText({ method: 'rula' }), 'rula: –');
  assert.match(stanceText({ ownStance: 'missing', stanceTrouble: 'the left knee is bent' }), /left knee/);
  assert.match(stanceText({ ownStance: 'asked' }), /two seconds/);
  assert.equal(ergonomicsBase('http://a:8080/viewer/', 'http://a:8080/'), 'http://a:8093/');
  assert.equal(ergonomicsBase('http://a:8080/viewer/?ergonomics=http://b:9', 'http://a:8080/'), 'http://b:9/');
});
