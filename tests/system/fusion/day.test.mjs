// A whole day on the page with the real programs, by the keyboard alone, by roles and names only: a server without sensors, a walk to
// Good, the world turned, a person named, something recorded, played, marked, cut and downloaded, one sensor more, one that dies.
// It takes minutes, so it runs at night (tests/run.sh --nightly).
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { mkdirSync, mkdtempSync, readFileSync, rmSync, statSync } from 'node:fs';
import { createServer } from 'node:net';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { fileURLToPath } from 'node:url';

import { PATIENCE_MS, launch, openViewer } from '../../viewer/browser.mjs';

const BIN = process.env.CHORUS_BIN;
const VIEWER = fileURLToPath(new URL('../../../services/viewer', import.meta.url));
const MOST_TABS = 150;
const folder = mkdtempSync(join(tmpdir(), 'chorus-day-'));
const children = [];
let browser;

async function freePort() {
  const server = createServer();
  await new Promise((resolve) => { server.listen(0, '127.0.0.1', resolve); });
  const { port } = server.address();
  await new Promise((resolve) => { server.close(resolve); });
  return port;
}

/// Starts a program and waits until it is ready; resolves to the child.
function started(program, port, ready, settings) {
  const child = spawn(`${BIN}/${program}`, ['--port', String(port), '--log-format', 'json', ...settings.flatMap((one) => ['--set', one])]);
  children.push(child);
  return new Promise((resolve, reject) => {
    let log = '';
    child.on('exit', () => reject(new Error(log)));
    child.stderr.on('data', (bytes) => {
      log += bytes;
      if (log.includes(ready)) resolve(child);
    });
  });
}

const sensors = {};
async function startSensor(id) {
  const port = sensors[id]?.port ?? await freePort();
  sensors[id] = { port, child: await started('chorus-sensor', port, 'sensor serving', [`id=${id}`, 'device.kind=simulated', 'images=true']) };
}

before(async () => {
  browser = await launch();
  if (process.env.CHORUS_SCREENSHOTS) mkdirSync(process.env.CHORUS_SCREENSHOTS, { recursive: true });
});
after(async () => {
  await browser?.close();
  for (const child of children) child.kill();
  rmSync(folder, { recursive: true, force: true });
});

/// The keyboard, and nothing else.
class Keyboard {
  constructor(page) { this.page = page; }

  /// Goes from control to control until the wanted one has the focus.
  async reach(role, name) {
    const wanted = this.page.getByRole(role, { name, exact: typeof name === 'string' });
    for (let tabs = 0; tabs < MOST_TABS; tabs += 1) {
      await wanted.waitFor();
      if (await wanted.evaluate((element) => element === document.activeElement && !element.disabled)) return;
      await this.page.keyboard.press('Tab');
    }
    throw new Error(`the keyboard does not reach ${role} "${name}"`);
  }
  async press(role, name, key = 'Enter') {
    await this.reach(role, name);
    await this.page.keyboard.press(key);
  }
  async type(name, text) {
    await this.reach('textbox', name);
    await this.page.keyboard.press('ControlOrMeta+A');
    await this.page.keyboard.type(text);
  }
  says(text) { return this.page.waitForFunction((wanted) => new RegExp(wanted).test(document.body.innerText), text); }
}

async function addSensor(keys, id) {
  await keys.type('address', `127.0.0.1:${sensors[id].port}`);
  await keys.press('button', 'Try');
  await keys.says(`Sensor ${id} is there and sees`);
  await keys.press('button', 'Take it');
  await keys.page.getByRole('button', { name: `leave ${id} out` }).waitFor();
}

async function picture(page, name) {
  if (process.env.CHORUS_SCREENSHOTS) await page.screenshot({ path: join(process.env.CHORUS_SCREENSHOTS, `day-${name}.png`) });
}

test('a whole day by the keyboard', async () => {
  for (const id of ['s1', 's2', 's3', 's4']) await startSensor(id);
  const port = await freePort();
  await started('chorus-fusion', port, 'fusion server ready', [`viewer_dir=${VIEWER}`, `state_dir=${join(folder, 'state')}`, `recording.folder=${join(folder, 'recordings')}`]);
  const { page, complaints } = await openViewer(browser, `http://127.0.0.1:${port}/viewer/`);
  const keys = new Keyboard(page);

  await keys.says('No sensors are configured'); // first run
  await keys.type('address', '127.0.0.1:9');
  await keys.press('button', 'Try');
  await keys.says('At 127.0.0.1:9 no program listens');
  for (const id of ['s1', 's2', 's3']) await addSensor(keys, id);
  await keys.says('sensors.json will hold');
  await picture(page, 'add-sensors');
  await keys.press('button', 'Save and follow these 3');
  await keys.says('Registering: \\d+ of \\d+ s'); // the walk begins by itself
  await picture(page, 'walk');
  await page.waitForFunction(() => document.getElementById('verdict').textContent === 'Good', null, { timeout: PATIENCE_MS });
  const stored = JSON.parse(readFileSync(join(folder, 'state/sensors.json')));
  assert.deepEqual(stored.sensors.map(({ id }) => id), ['s1', 's2', 's3']);

  await page.getByRole('tabpanel').getByText('facing its front').waitFor(); // the next step has opened
  await keys.press('button', 'Turn by 90°');
  await keys.press('button', 'Done');

  await keys.press('button', /^name person/);
  await keys.type('name', 'Anna');
  await keys.press('button', 'Save');
  await keys.says('Anna, person');

  await keys.press('tab', 'Record');
  await keys.type('name', 'day');
  await keys.reach('spinbutton', 'seconds');
  await page.keyboard.type('4');
  await keys.press('button', 'Record');
  await page.getByRole('cell', { name: 'finished' }).waitFor();
  await keys.reach('link', 'download');
  const [download] = await Promise.all([page.waitForEvent('download'), page.keyboard.press('Enter')]);
  assert.ok(statSync(await download.path()).size > 10000, 'the recording is downloaded');

  await keys.press('tab', 'Look at a recording');
  await keys.press('button', 'look at day');
  await keys.says('A recording is shown: day');
  await keys.press('button', 'Play');
  await page.waitForFunction(() => window.chorusViewer.fusedJoints > 20); // at 0:00.0 nobody has been seen yet
  await page.waitForFunction(() => /0:0[1-9]/.test(document.getElementById('instant').textContent));
  await keys.type(/^mark/, 'halfway');
  await keys.press('button', 'Mark');
  await page.getByRole('button', { name: 'remove the mark halfway' }).waitFor();
  await keys.type('as', 'part');
  await keys.press('button', 'Cut');
  await picture(page, 'recording');
  await keys.press('button', 'Back to the room as it is now');
  await page.getByRole('button', { name: 'look at part' }).waitFor();

  await keys.press('tab', /Register/);
  await keys.press('button', 'Undo');
  await keys.press('tab', 'Sensors');
  await addSensor(keys, 's4');
  await keys.press('button', 'Save and follow it');
  await page.locator('[data-sensor=s4]').getByText('live').waitFor();
  await keys.press('button', 'picture of s4');
  await page.getByRole('img', { name: 'what s4 sees' }).waitFor();

  sensors.s2.child.removeAllListeners('exit');
  sensors.s2.child.kill();
  await keys.says('s2 delivers nothing|s2: ');
  await page.locator('[data-sensor=s2]').getByText('lost').waitFor();
  await keys.press('button', 'more of s2');
  await keys.press('button', 'silence s2');
  await page.locator('[data-sensor=s2]').getByText('silenced').waitFor();
  await picture(page, 'silenced');
  await startSensor('s2');
  await keys.press('button', 'hear s2 again');
  await page.locator('[data-sensor=s2]').getByText('live').waitFor();
  const unexpected = complaints.filter((line) => !/503|404/.test(line)); // a picture that is not there yet
  assert.deepEqual(unexpected, []);
  await page.close();
});
