// Our MCAP files read by the format's own reader (npm @mcap/core), and its files read by ours.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { McapIndexedReader, McapStreamReader, McapWriter, TempBuffer } from "@mcap/core";
import { decompress } from "fzstd";

const probe = process.env.CHORUS_RECORDING_PROBE;
const folder = mkdtempSync(join(tmpdir(), "chorus-mcap-"));
after(() => rmSync(folder, { recursive: true }));

const decompressHandlers = { zstd: (bytes, size) => decompress(bytes, new Uint8Array(Number(size))) };
const text = (bytes) => new TextDecoder().decode(bytes);

const ours = join(folder, "ours.mcap");
execFileSync(probe, ["write", ours]);

test("the indexed reader finds every message, in order, with its times", async () => {
  const reader = await McapIndexedReader.Initialize({
    readable: new TempBuffer(readFileSync(ours)), decompressHandlers });
  assert.equal(reader.header.library, "chorus probe");
  assert.ok(reader.chunkIndexes.length >= 10, "ten seconds in chunks of one");
  assert.equal(reader.statistics.messageCount, 300n);
  assert.equal(reader.statistics.chunkCount, reader.chunkIndexes.length);
  const topics = new Map([...reader.channelsById.values()].map((c) => [c.topic, c]));
  assert.deepEqual([...topics.keys()], ["/frame", "/notes"]);
  assert.deepEqual([...topics.get("/frame").metadata], [["k", "v"]]);
  const schema = reader.schemasById.get(topics.get("/frame").schemaId);
  assert.deepEqual([schema.name, schema.encoding, text(schema.data)],
    ["chorus.Frame", "jsonschema", '{"type":"object"}']);
  let count = 0n;
  for await (const m of reader.readMessages({ validateCrcs: true })) {
    assert.equal(m.sequence, Number(count));
    assert.equal(m.logTime, 1700000000000000000n + 33333000n * count);
    assert.equal(m.publishTime, m.logTime - 1000000n);
    assert.equal(JSON.parse(text(m.data)).sequence, Number(count));
    count += 1n;
  }
  assert.equal(count, 300n);
});

test("the index answers for one topic and for a time range", async () => {
  const reader = await McapIndexedReader.Initialize({
    readable: new TempBuffer(readFileSync(ours)), decompressHandlers });
  const numbers = [];
  for await (const m of reader.readMessages({ topics: ["/notes"] })) numbers.push(m.sequence);
  assert.deepEqual(numbers, [99, 199, 299]);
  const from = 1700000000000000000n + 33333000n * 50n;
  numbers.length = 0;
  for await (const m of reader.readMessages({ startTime: from, endTime: from + 33333000n * 2n })) {
    numbers.push(m.sequence);
  }
  assert.deepEqual(numbers, [50, 51, 52]);
});

test("metadata is found through its index", async () => {
  const reader = await McapIndexedReader.Initialize({
    readable: new TempBuffer(readFileSync(ours)), decompressHandlers });
  const found = [];
  for await (const m of reader.readMetadata({ name: "chorus" })) found.push(Object.fromEntries(m.metadata));
  assert.deepEqual(found, [{ sensor: "s1", device: "probe" }]);
});

test("the streaming reader accepts every record, all checksums included", () => {
  const reader = new McapStreamReader({ decompressHandlers, validateCrcs: true });
  reader.append(readFileSync(ours));
  const counts = {};
  for (let record; (record = reader.nextRecord());) counts[record.type] = (counts[record.type] ?? 0) + 1;
  assert.ok(reader.done());
  assert.equal(counts.Message, 300);
  assert.equal(counts.DataEnd, 1);
  assert.equal(counts.Footer, 1);
  assert.equal(counts.SummaryOffset, 5);
});

test("a file that @mcap/core wrote is read by us", async () => {
  const buffer = new TempBuffer();
  const writer = new McapWriter({ writable: buffer, useChunks: true });
  await writer.start({ profile: "", library: "@mcap/core" });
  const schemaId = await writer.registerSchema({ name: "A", encoding: "jsonschema",
    data: new TextEncoder().encode("{}") });
  const channelId = await writer.registerChannel({ schemaId, topic: "/frame",
    messageEncoding: "json", metadata: new Map() });
  await writer.addAttachment({ name: "a", mediaType: "text/plain", logTime: 1n, createTime: 1n,
    data: new Uint8Array([1, 2, 3]) });
  await writer.addMetadata({ name: "chorus", metadata: new Map([["sensor", "s9"]]) });
  for (let i = 5; i > 0; --i) {
    await writer.addMessage({ channelId, sequence: i, logTime: BigInt(i), publishTime: 0n,
      data: new TextEncoder().encode(`{"i":${i}}`) });
  }
  await writer.end();
  const path = join(folder, "theirs.mcap");
  writeFileSync(path, buffer.get());
  const read = JSON.parse(execFileSync(probe, ["read", path]));
  assert.equal(read.truncated, false);
  assert.deepEqual(read.notes, []);
  assert.deepEqual(read.metadata, { chorus: { sensor: "s9" } });
  assert.deepEqual(read.messages.map((m) => m.text), [1, 2, 3, 4, 5].map((i) => `{"i":${i}}`));
});
