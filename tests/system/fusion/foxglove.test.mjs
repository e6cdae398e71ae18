// A viewer's own client (@foxglove/ws-protocol) reads the tracker live: the channels and schemas of our recordings.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { mkdtempSync, readFileSync, readdirSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';

import foxglove from '@foxglove/ws-protocol'; // CommonJS
import { McapIndexedReader, TempBuffer } from '@mcap/core';
import { decompress } from 'fzstd';
import WebSocket from 'ws';

const { FoxgloveClient } = foxglove;

const BIN = process.env.CHORUS_BIN;
const PATIENCE_MS = 40000;
const folder = mkdtempSync(join(tmpdir(), 'chorus-foxglove-'));
const children = [];
let fusion;

/// Starts a service on a free port and returns its URL.
async function service(name, ready, ...settings) {
  const child = spawn(`${BIN}/${name}`, ['--port', '0', '--log-format', 'json', ...settings.flatMap((one) => ['--set', one])]);
  children.push(child);
  let log = '';
  return new Promise((resolve, reject) => {
    child.on('exit', () => reject(new Error(log)));
    child.stderr.on('data', (bytes) => {
      log += bytes;
      const line = log.split('\n').find((each) => each.includes(ready) && each.endsWith('}'));
      if (line) resolve(`http://127.0.0.1:${JSON.parse(line).port ?? new URL(JSON.parse(line).url).port}`);
    });
  });
}

const json = async (path, options) => (await fetch(fusion + path, { headers: { Accept: 'application/json' }, ...options })).json();

async function soon(what, value) {
  const deadline = Date.now() + PATIENCE_MS;
  for (;;) {
    const got = await value();
    if (got) return got;
    if (Date.now() > deadline) throw new Error(`not within ${PATIENCE_MS} ms: ${what}`);
    await new Promise((resolve) => { setTimeout(resolve, 50); });
  }
}

/// A client with everything that it has been told.
function viewer(options) {
  const socket = new WebSocket(`${fusion.replace('http', 'ws')}/foxglove`, [FoxgloveClient.SUPPORTED_SUBPROTOCOL], options);
  const client = new FoxgloveClient({ ws: socket });
  const told = { client, channels: new Map(), messages: new Map(), statuses: [], info: null, error: null };
  client.on('serverInfo', (info) => { told.info = info; });
  client.on('error', (error) => { told.error = error; });
  client.on('status', (status) => told.statuses.push(status));
  client.on('advertise', (channels) => { for (const channel of channels) told.channels.set(channel.topic, channel); });
  client.on('message', ({ subscriptionId, timestamp, data }) => {
    told.messages.set(subscriptionId, [...(told.messages.get(subscriptionId) ?? []), { timestamp, value: JSON.parse(new TextDecoder().decode(data)) }]);
  });
  return told;
}

before(async () => {
  const sensor = await service('chorus-sensor', 'sensor serving', 'device.kind=simulated', 'id=s1');
  fusion = await service('chorus-fusion', 'fusion server ready', `sensors=[{"id":"s1","url":"${sensor}/"}]`, 'state_dir=""', `recording.folder=${folder}`,
    'viewer_dir=""', 'title=the hall');
  await soon('a frame', async () => (await fetch(`${fusion}/sensors/s1/frame`)).ok);
});
after(() => {
  for (const child of children) child.kill();
  rmSync(folder, { recursive: true, force: true });
});

test('it is told of every channel, and gets what it subscribes to', async () => {
  const told = viewer();
  await soon('channels', () => told.channels.has('/sensors/s1/scene'));
  assert.equal(told.info.name, 'the hall');
  assert.deepEqual([...told.channels.keys()].sort(),
    ['/frame', '/registration', '/scene', '/sensors/s1/frame', '/sensors/s1/scene', '/transforms']);
  const ids = Object.fromEntries(['/frame', '/scene', '/sensors/s1/frame', '/sensors/s1/scene', '/transforms'].map((topic) =>
    [topic, told.client.subscribe(told.channels.get(topic).id)]));
  await soon('frames', () => (told.messages.get(ids['/frame']) ?? []).length > 10);
  const frames = told.messages.get(ids['/frame']);
  for (const { timestamp, value } of frames) assert.equal(String(timestamp), value.capturedNanoseconds);
  assert.ok(frames.every((one, i) => i === 0 || one.value.sequence > frames[i - 1].value.sequence), 'each once, in order');
  const rate = (10 * 1e9) / Number(frames[10].timestamp - frames[0].timestamp);
  assert.ok(rate > 10, `live, not four times a second: ${rate} Hz`);
  const raw = (await soon('raw', () => told.messages.get(ids['/sensors/s1/frame']))).at(-1).value;
  assert.equal(raw.source, 's1');
  const scene = await soon('a body', () => told.messages.get(ids['/sensors/s1/scene'])?.find(({ value }) => value.entities.length > 0));
  assert.ok(scene.value.entities[0].lines[0].points.length > 10);
  const transforms = (await soon('transforms', () => told.messages.get(ids['/transforms'])))[0].value;
  assert.ok(transforms.transforms.some(({ child_frame_id: child }) => child === 'world'));
  told.client.unsubscribe(ids['/frame']);
  await new Promise((resolve) => { setTimeout(resolve, 300); });
  const count = told.messages.get(ids['/frame']).length;
  await soon('others go on', () => told.messages.get(ids['/scene']).length > count + 3);
  assert.equal(told.messages.get(ids['/frame']).length, count, 'nothing more of what was given up');
  told.client.subscribe(999);
  await soon('a warning', () => told.statuses.some(({ message }) => /no channel 999/.test(message)));
  assert.equal(told.error, null);
  told.client.close();
});

test('channels and schemas are those of recordings', async () => {
  const started = await json('/recordings/', { method: 'POST', body: JSON.stringify({ name: 'r', seconds: 1 }) });
  assert.ok(started);
  await soon('the recording is complete', async () => (await json('/recordings/r')).state === 'finished');
  const file = readdirSync(join(folder, 'r')).find((name) => name.endsWith('.mcap'));
  const reader = await McapIndexedReader.Initialize({ readable: new TempBuffer(readFileSync(join(folder, 'r', file))),
    decompressHandlers: { zstd: (bytes, size) => decompress(bytes, new Uint8Array(Number(size))) } });
  const told = viewer();
  await soon('channels', () => told.channels.has('/sensors/s1/scene'));
  let compared = 0;
  for (const channel of reader.channelsById.values()) {
    const live = told.channels.get(channel.topic);
    if (!live) continue; // clocks and floors are recorded only
    const schema = reader.schemasById.get(channel.schemaId);
    assert.deepEqual([live.encoding, live.schemaName, live.schemaEncoding], [channel.messageEncoding, schema.name, schema.encoding]);
    assert.equal(live.schema, new TextDecoder().decode(schema.data), channel.topic);
    compared += 1;
  }
  assert.ok(compared >= 4, `${compared} channels compared`);
  told.client.close();
});

test('a page of a foreign origin may not look', async () => {
  const told = viewer({ origin: 'http://elsewhere.example' });
  await soon('a refusal', () => told.error);
  assert.match(String(told.error.message), /403/);
});
