// Reads exported files with programs of others: three.js' BVHLoader and GLTFLoader, and the
// Khronos glTF validator. The real four-camera recording is fused, exported and read back.
import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { validateBytes } from "gltf-validator";
import { AnimationMixer, Group, Vector3 } from "three";
import { BVHLoader } from "three/addons/loaders/BVHLoader.js";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";

const chorus = join(process.env.CHORUS_BIN ?? "build/dev/bin", "chorus");
const CAMERAS = "tests/data/pose2sim_mediapipe";
const folder = mkdtempSync(join(tmpdir(), "chorus-export-"));
after(() => rmSync(folder, { recursive: true }));
const at = (name) => join(folder, name);

execFileSync(chorus, ["import", "pose2sim", CAMERAS, "--out", at("rec")]);
execFileSync(chorus, ["fuse", at("rec"), "--config", `${CAMERAS}/fusion.json`, "--registration",
  at("rec/registration.json"), "--out", at("fused.ndjson")], { stdio: "ignore" });
const fused = readFileSync(at("fused.ndjson"), "utf8").trim().split("\n").map((line) => JSON.parse(line))
  .filter((frame) => frame.bodies.length > 0);

/** Exports and returns { files, remarks, ... } from the report. */
function exported(format, file, ...more) {
  const source = more.includes("--from") ? more.splice(more.indexOf("--from"), 2)[1] : at("fused.ndjson");
  const done = spawnSync(chorus, ["export", source, "--format", format, "--out", at(file), "--json", ...more],
    { encoding: "utf8" });
  assert.equal(done.status, 0, done.stderr);
  return JSON.parse(done.stderr);
}

/** "at most 56.2 mm": the error that the export itself reports for bones of constant length. */
const promisedMetres = (report) => Number(/at most ([\d.]+) mm/.exec(report.remarks[0])[1]) / 1000;

/** Largest distance between bones of three.js by joint name and the fused joints of a frame [m]. */
function largestDistance(bones, frame, metresPerUnit) {
  let largest = 0;
  let compared = 0;
  for (const [name, joint] of Object.entries(frame.bodies[0].joints)) {
    if (!("x" in joint)) continue;
    const place = bones.get(name).getWorldPosition(new Vector3()).multiplyScalar(metresPerUnit);
    largest = Math.max(largest, place.distanceTo(new Vector3(joint.x, joint.y, joint.z)));
    compared += 1;
  }
  assert.ok(compared >= 20, `${compared} joints`);
  return largest;
}

function compareAnimation(root, clip, names, report, metresPerUnit) {
  const mixer = new AnimationMixer(root);
  mixer.clipAction(clip).play();
  for (const index of [0, 1, 7, 20, fused.length - 2]) {
    mixer.setTime(index / report.rateHz);
    root.updateMatrixWorld(true);
    const distance = largestDistance(names, fused[index], metresPerUnit);
    assert.ok(distance <= promisedMetres(report) + 0.001, `frame ${index}: ${distance} m`);
  }
}

for (const [unit, metresPerUnit] of [["cm", 0.01], ["m", 1]]) {
  test(`BVHLoader finds the fused joints, in ${unit}`, () => {
    const report = exported("bvh", `walk-${unit}.bvh`, "--unit", unit);
    assert.equal(report.frames, fused.length);
    assert.equal(report.rateHz, 30);
    const { skeleton, clip } = new BVHLoader().parse(readFileSync(at(`walk-${unit}.bvh`), "utf8"));
    const root = new Group();
    root.add(skeleton.bones[0]);
    const names = new Map(skeleton.bones.map((bone) => [bone.name, bone]));
    assert.equal(names.get("HandTipLeft").parent.name, "HandLeft");
    compareAnimation(root, clip, names, report, metresPerUnit);
  });
}

test("GLTFLoader finds the fused joints", async () => {
  const report = exported("gltf", "walk.glb");
  const bytes = readFileSync(at("walk.glb"));
  const gltf = await new Promise((resolve, reject) => new GLTFLoader().parse(
    bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength), "", resolve, reject));
  assert.equal(gltf.animations.length, 1);
  const names = new Map();
  let skinned = 0;
  gltf.scene.traverse((node) => {
    names.set(node.name, node);
    if (node.isSkinnedMesh) skinned += 1;
  });
  assert.equal(skinned, 1);
  compareAnimation(gltf.scene, gltf.animations[0], names, report, 1);
});

test("the Khronos validator has nothing to say, of one person and of two", async () => {
  exported("gltf", "one.glb");
  const two = fused.map((frame) => {
    const other = structuredClone(frame.bodies[0]);
    Object.assign(other, { bodyId: 7, slot: 1, "@id": "skeletons/7" });
    for (const [name, joint] of Object.entries(other.joints)) {
      joint["@id"] = `skeletons/7#${name}`;
      if ("x" in joint) joint.x += 1.5;
    }
    return JSON.stringify({ ...frame, bodies: [...frame.bodies, other] });
  });
  writeFileSync(at("two.ndjson"), two.join("\n"));
  const report = exported("gltf", "two.glb", "--from", at("two.ndjson"));
  assert.deepEqual(report.persons, [fused[0].bodies[0].bodyId, 7]);
  for (const file of ["one.glb", "two.glb"]) {
    const judged = await validateBytes(new Uint8Array(readFileSync(at(file))));
    assert.deepEqual(judged.issues.messages, [], file);
    assert.equal(judged.info.hasSkins, true);
    assert.equal(judged.info.animationCount, 1);
  }
  assert.deepEqual(exported("bvh", "two.bvh", "--from", at("two.ndjson")).files,
    [fused[0].bodies[0].bodyId, 7].map((id) => at(`two-p${id}.bvh`)));
});
