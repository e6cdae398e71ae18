// The lock on the screen, which a browser gives when it likes.
import assert from 'node:assert/strict';
import { beforeEach, test } from 'node:test';

import { Awake } from '../../services/capture/awake.js';

let asked; // {give, refuse, lock} of each request
beforeEach(() => {
  asked = [];
  const request = (kind) => new Promise((resolve, reject) => {
    assert.equal(kind, 'screen');
    const lock = { released: false, release() { this.released = true; } };
    asked.push({ lock, give: () => resolve(lock), refuse: () => reject(new Error('no')) });
  });
  Object.defineProperty(globalThis, 'navigator', { configurable: true, value: { wakeLock: { request } } });
});

test('a lock is held until the end', async () => {
  const awake = new Awake();
  const asking = awake.ask();
  asked[0].give();
  await asking;
  assert.equal(asked[0].lock.released, false);
  awake.end();
  assert.ok(asked[0].lock.released);
});

test('a lock that comes after the end is given back', async () => {
  const awake = new Awake();
  const asking = awake.ask();
  awake.end();
  asked[0].give();
  await asking;
  assert.ok(asked[0].lock.released);
});

test('of two requests that overlap one lock is held, and none after the end', async () => {
  const awake = new Awake();
  const first = awake.ask();
  awake.end();
  const second = awake.ask();
  asked[1].give();
  await second;
  asked[0].give();
  await first;
  assert.deepEqual(asked.map(({ lock }) => lock.released).sort(), [false, true]);
  awake.end();
  assert.ok(asked.every(({ lock }) => lock.released));
});

test('who refuses, or knows no locks, is no failure', async () => {
  const awake = new Awake();
  const asking = awake.ask();
  asked[0].refuse();
  await asking;
  awake.end();
  Object.defineProperty(globalThis, 'navigator', { configurable: true, value: {} });
  await awake.ask();
  awake.end();
});
