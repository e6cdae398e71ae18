// No foreign page may show ours in a frame, where a hidden click could move the origin; ours run with what their policy allows them.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { createServer } from 'node:http';
import { after, before, test } from 'node:test';
import { fileURLToPath } from 'node:url';

import { PATIENCE_MS, launch, openViewer } from '../../viewer/browser.mjs';

const BIN = process.env.CHORUS_BIN;
const VIEWER = fileURLToPath(new URL('../../../services/viewer', import.meta.url));
const children = [];
let browser;
let fusion;
let sensor;

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

before(async () => {
  browser = await launch();
  fusion = await service('chorus-fusion', 'fusion server ready', `viewer_dir=${VIEWER}`, 'state_dir=""');
  sensor = await service('chorus-sensor', 'sensor serving', 'device.kind=simulated');
});
after(async () => {
  await browser?.close();
  for (const child of children) child.kill();
});

/// A page of another origin that shows a page in a frame.
async function framing(url) {
  const server = createServer((_, response) => response.setHeader('Content-Type', 'text/html').end(`<!doctype html><iframe src="${url}"></iframe>`));
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  return { server, url: `http://localhost:${server.address().port}/` };
}

/// What a page of another origin gets to see of a page in its frame, and what the browser says about it.
async function seenInAFrame(url, selector) {
  const foreign = await framing(url);
  const page = await browser.newPage();
  page.setDefaultTimeout(PATIENCE_MS);
  const said = [];
  page.on('console', (message) => said.push(message.text()));
  await page.goto(foreign.url, { waitUntil: 'load' }); // the frame's own load included
  const frame = page.frames().find((each) => each !== page.mainFrame());
  const count = await frame.locator(selector).count();
  await page.close();
  foreign.server.close();
  return { count, said: said.join('\n') };
}

test('a foreign page shows none of ours in a frame', async () => {
  const harmless = createServer((_, response) => response.setHeader('Content-Type', 'text/html').end('<table></table>'));
  await new Promise((resolve) => harmless.listen(0, '127.0.0.1', resolve));
  const usual = await seenInAFrame(`http://127.0.0.1:${harmless.address().port}/`, 'table');
  harmless.close();
  assert.equal(usual.count, 1, 'a page that says nothing can be framed: the test sees it');
  for (const [own, found] of [[`${fusion}/viewer/`, '#scene'], [`${fusion}/`, 'table'], [`${sensor}/`, 'table']]) {
    const { count, said } = await seenInAFrame(own, found);
    assert.equal(count, 0, own);
    assert.match(said, /frame-ancestors/, own);
    const direct = await browser.newPage();
    direct.setDefaultTimeout(PATIENCE_MS);
    await direct.goto(own);
    assert.ok(await direct.locator(found).count() > 0, `${own} by itself`);
    await direct.close();
  }
});

test('the viewer runs under its own policy, and no script that somebody puts into it', async () => {
  const { page, complaints } = await openViewer(browser, `${fusion}/viewer/`);
  await page.waitForFunction(() => window.chorusViewer !== undefined);
  await page.waitForFunction(() => /sensors/.test(document.getElementById('headline').textContent));
  assert.deepEqual(complaints.filter((each) => /Content Security Policy|Refused/.test(each)), []);
  await page.evaluate(() => {
    const script = document.createElement('script');
    script.textContent = 'window.injected = true';
    document.body.append(script);
  });
  assert.equal(await page.evaluate(() => window.injected), undefined);
  await page.close();
});
