// What chorus-bench cockpit runs: the page with six people and ten sensors in headless Chromium (software rendering), and an empty
// three.js scene of the same size in turns with it.  Prints one JSON object.
import { fileURLToPath } from 'node:url';

import { launch } from '../../viewer/browser.mjs';
import { SENSORS, live, startFakeFusion, usualWorld } from '../../viewer/fake_fusion.mjs';

const [seconds, rounds] = process.argv.slice(2).map(Number);
const FILES = fileURLToPath(new URL('../../../services/viewer/', import.meta.url));
const SIZE = { width: 1280, height: 720 };
const PHONE = { width: 390, height: 844 };
const PEOPLE = 6;
const MANY = 10;
const SETTLE_MS = 3000;

function busyWorld() {
  const world = usualWorld();
  const ids = Array.from({ length: MANY }, (_, i) => `s${i + 1}`);
  world.people = PEOPLE;
  world.crowded = true; // every sensor sees everybody
  world.sensors = Object.fromEntries(ids.map((id) => [id, live({ bodies: PEOPLE })]));
  world.registration.reasons = [];
  world.registration.sensors = Object.fromEntries(ids.map((id, i) => {
    const turn = (2 * Math.PI * i) / MANY;
    return [id, { ...SENSORS.s1, x: -4 * Math.sin(turn), z: -4 * Math.cos(turn), qy: Math.sin(turn / 2), qw: Math.cos(turn / 2) }];
  }));
  return world;
}

/// A page with a floor and nothing on it, drawn as fast as the browser allows.
const EMPTY = `<!doctype html><html><head><script type="importmap">{"imports":{"three":"./node_modules/three/build/three.module.min.js"}}</script></head>
<body style="margin:0"><canvas id="scene" style="width:100vw;height:100vh;display:block"></canvas><script type="module">
import * as THREE from 'three';
const canvas = document.getElementById('scene');
const renderer = new THREE.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
renderer.setSize(innerWidth, innerHeight, false);
const scene = new THREE.Scene();
scene.background = new THREE.Color(0x0d1117);
scene.add(new THREE.GridHelper(12, 12));
const camera = new THREE.PerspectiveCamera(45, innerWidth / innerHeight, 0.05, 60);
camera.position.set(4, 3, 6);
camera.lookAt(0, 1, 0);
window.chorusViewer = { pictures: 0 };
renderer.setAnimationLoop(() => { renderer.render(scene, camera); window.chorusViewer.pictures += 1; });
</script></body></html>`;

const median = (values) => [...values].sort((a, b) => a - b)[Math.floor(values.length / 2)];
const percentile = (values, share) => [...values].sort((a, b) => a - b)[Math.min(values.length - 1, Math.floor(share * values.length))];

/// Pictures a second, and ages of the fused frame while they were drawn [ms].
async function measured(page) {
  return page.evaluate(async (seconds) => {
    const begun = [performance.now(), window.chorusViewer.pictures];
    const ages = [];
    while (performance.now() - begun[0] < 1000 * seconds) {
      await new Promise((resolve) => { setTimeout(resolve, 100); });
      if (Number.isFinite(window.chorusViewer.age)) ages.push(window.chorusViewer.age);
    }
    return { rate: (1000 * (window.chorusViewer.pictures - begun[1])) / (performance.now() - begun[0]), ages };
  }, seconds);
}

async function opened(browser, url, size) {
  const page = await browser.newPage({ viewport: size, deviceScaleFactor: 1, colorScheme: 'dark' });
  page.setDefaultTimeout(120000);
  await page.goto(url);
  await page.waitForFunction(() => window.chorusViewer?.pictures > 3);
  return page;
}

const world = busyWorld();
world.pages = { '/viewer/empty.html': EMPTY };
const server = await startFakeFusion(FILES, world);
const browser = await launch();
const found = { page: [], phone: [], empty: [], ages: [], skipped: [] };
for (let round = 0; round < rounds; round += 1) {
  for (const [kind, url, size] of [['empty', new URL('empty.html', server.url).href, SIZE], ['page', `${server.url}?still`, SIZE], ['phone', server.url, PHONE]]) {
    const page = await opened(browser, url, size);
    if (kind !== 'empty') {
      await page.waitForFunction((people) => window.chorusViewer.fusedJoints >= 24 * people, PEOPLE);
      if (round === 0 && kind === 'page') found.paint = await page.evaluate(() => performance.getEntriesByName('first-contentful-paint')[0]?.startTime ?? NaN);
      await page.waitForTimeout(SETTLE_MS);
    }
    const { rate, ages } = await measured(page);
    found[kind].push(rate);
    if (kind === 'page') found.ages.push(...ages);
    await page.close();
  }
}
await browser.close();
server.stop();
process.stdout.write(`${JSON.stringify({ page_hz: median(found.page), phone_hz: median(found.phone), empty_hz: median(found.empty),
  ratio: median(found.page.map((rate, i) => rate / found.empty[i])), age_p95_ms: percentile(found.ages, 0.95), first_paint_ms: found.paint,
  frame_bytes: JSON.stringify(server.current()).length })}\n`);
process.exit(0);
