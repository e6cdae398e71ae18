// A recording of a whole cell read by the format's own reader (npm @mcap/core): index, checksums, schemas, metadata, and what
// viewers draw.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { McapIndexedReader, McapStreamReader, TempBuffer } from "@mcap/core";
import { decompress } from "fzstd";

const folder = mkdtempSync(join(tmpdir(), "chorus-session-"));
after(() => rmSync(folder, { recursive: true }));
const file = join(folder, "cell.mcap");
execFileSync(process.env.CHORUS_RECORDING_PROBE, ["session", file]);

const decompressHandlers = { zstd: (bytes, size) => decompress(bytes, new Uint8Array(Number(size))) };
const json = (bytes) => JSON.parse(new TextDecoder().decode(bytes));
const open = () => McapIndexedReader.Initialize({ readable: new TempBuffer(readFileSync(file)), decompressHandlers });
const TOPICS = { "/frame": "chorus.Frame", "/scene": "foxglove.SceneUpdate", "/registration": "chorus.Registration",
  "/transforms": "foxglove.FrameTransforms" };
for (const id of ["s1", "s2"]) {
  TOPICS[`/sensors/${id}/frame`] = "chorus.Frame";
  TOPICS[`/sensors/${id}/floor-plane`] = "chorus.FloorPlane";
  TOPICS[`/sensors/${id}/clock`] = "chorus.ClockModel";
  TOPICS[`/sensors/${id}/scene`] = "foxglove.SceneUpdate";
}

/** Checks with the part of JSON Schema that our schemas use; returns what is wrong, or nothing. */
function misfit(value, schema, at = "") {
  const types = { object: (v) => v !== null && typeof v === "object" && !Array.isArray(v), array: Array.isArray,
    string: (v) => typeof v === "string", number: (v) => typeof v === "number", integer: Number.isInteger,
    boolean: (v) => typeof v === "boolean" };
  if (schema.type && !types[schema.type](value)) return `${at} is no ${schema.type}`;
  if (schema.enum && !schema.enum.includes(value)) return `${at} is ${value}`;
  for (const key of schema.required ?? []) if (!(key in value)) return `${at} lacks ${key}`;
  for (const item of Array.isArray(value) ? value : []) {
    const wrong = misfit(item, schema.items ?? {}, `${at}[]`);
    if (wrong) return wrong;
  }
  if (types.object(value)) {
    for (const [key, inner] of Object.entries(value)) {
      const wrong = misfit(inner, schema.properties?.[key] ?? schema.additionalProperties ?? {}, `${at}.${key}`);
      if (wrong) return wrong;
    }
  }
  return undefined;
}

test("every channel has its schema, and every message fits it", async () => {
  const reader = await open();
  const schemaOf = new Map([...reader.channelsById.values()].map((c) => [c.id, reader.schemasById.get(c.schemaId)]));
  const found = Object.fromEntries([...reader.channelsById.values()].map((c) => [c.topic, schemaOf.get(c.id).name]));
  assert.deepEqual(found, TOPICS);
  const parsed = new Map([...reader.schemasById.values()].map((s) => [s.id, json(s.data)]));
  let count = 0;
  for await (const message of reader.readMessages({ validateCrcs: true })) {
    const schema = schemaOf.get(message.channelId);
    assert.equal(schema.encoding, "jsonschema");
    assert.equal(misfit(json(message.data), parsed.get(schema.id)), undefined, schema.name);
    ++count;
  }
  assert.equal(BigInt(count), reader.statistics.messageCount);
  assert.ok(count > 6 * 60, "two seconds of two sensors and the fused stream, each with its scene");
});

/** The first key of a document that its schema does not describe; those of JSON-LD (@id) aside. */
function undescribed(value, schema, at = "") {
  for (const [key, inner] of Object.entries(typeof value === "object" ? value : {})) {
    const known = Array.isArray(value) ? schema.items : schema.properties?.[key] ?? schema.additionalProperties;
    if (!known && !key.startsWith("@")) return `${at}.${key}`;
    const missing = known && undescribed(inner, known, `${at}.${key}`);
    if (missing) return missing;
  }
  return undefined;
}

test("the schema describes all that frames may say: rays, covariances, contributors, who is carried", async () => {
  const schemas = [...(await open()).schemasById.values()].filter((schema) => schema.name === "chorus.Frame");
  const schema = json(schemas[0].data);
  for (const name of ["fused", "rays"]) {
    const golden = JSON.parse(readFileSync(new URL(`../../../proto/golden/perfect/${name}.json`, import.meta.url)));
    assert.equal(misfit(golden, schema), undefined);
    assert.equal(undescribed(golden, schema), undefined, name);
  }
});

test("checksums hold in the data section, and metadata is indexed", async () => {
  const stream = new McapStreamReader({ decompressHandlers, validateCrcs: true });
  stream.append(readFileSync(file));
  while (stream.nextRecord());
  assert.ok(stream.done());
  for await (const record of (await open()).readMetadata({ name: "chorus" })) {
    assert.equal(record.metadata.get("title"), "probe");
    return;
  }
  assert.fail("no metadata");
});

test("a viewer finds every drawn frame in the transforms, bones within the points, and bodies of human size", async () => {
  const reader = await open();
  const frames = new Set(["map"]);
  for await (const message of reader.readMessages({ topics: ["/transforms"] })) {
    for (const t of json(message.data).transforms) {
      assert.ok(frames.has(t.parent_frame_id), "parents come first");
      frames.add(t.child_frame_id);
      assert.ok(Math.abs(Math.hypot(...Object.values(t.rotation)) - 1) < 1e-4);
    }
  }
  let lines = 0;
  for await (const message of reader.readMessages({ topics: Object.keys(TOPICS).filter((t) => t.endsWith("scene")) })) {
    for (const entity of json(message.data).entities) {
      assert.ok(frames.has(entity.frame_id), entity.frame_id);
      for (const line of entity.lines) {
        ++lines;
        assert.equal(line.indices.length % 2, 0);
        assert.ok(Math.max(...line.indices) < line.points.length);
        for (let i = 0; i < line.indices.length; i += 2) {
          const [a, b] = [line.points[line.indices[i]], line.points[line.indices[i + 1]]];
          const bone = Math.hypot(a.x - b.x, a.y - b.y, a.z - b.z);
          assert.ok(bone > 0.01 && bone < 0.7, `a bone of ${bone} m`);
        }
      }
    }
  }
  assert.ok(lines >= 180);
});
