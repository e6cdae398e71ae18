// The examples of docs/guide/clients.md that need a browser or a SPARQL engine, against the running system.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { resolve } from 'node:path';
import { test } from 'node:test';
import { pathToFileURL } from 'node:url';

import { QueryEngine } from '@comunica/query-sparql-link-traversal';

import { PATIENCE_MS, launch } from '../viewer/browser.mjs';

const fusion = process.env.CHORUS_FUSION_URL;
assert.ok(fusion, 'CHORUS_FUSION_URL names a running fusion server');
const examples = resolve('docs/guide/examples');

test('the web page shows who is tracked, live, opened as a file', async () => {
  const browser = await launch();
  try {
    const page = await browser.newPage();
    page.setDefaultTimeout(PATIENCE_MS);
    const complaints = [];
    page.on('pageerror', (error) => complaints.push(String(error)));
    await page.goto(`${pathToFileURL(`${examples}/live_page.html`)}?service=${fusion}`);
    await page.waitForFunction(() => window.framesShown > 30);
    assert.match(await page.textContent('#state'), /^1 tracked at \d{4}-/);
    const drawn = await page.evaluate(() => {
      const floor = document.getElementById('floor');
      const { data } = floor.getContext('2d').getImageData(0, 0, floor.width, floor.height);
      return data.filter((value, i) => i % 4 === 3 && value > 0).length;
    });
    assert.ok(drawn > 100, `${drawn} pixels of the person are drawn`);
    assert.deepEqual(complaints, []);
    if (process.env.CHORUS_SCREENSHOT) await page.screenshot({ path: process.env.CHORUS_SCREENSHOT });
  } finally {
    await browser.close();
  }
});

test('the SPARQL query finds the heads by following links', async () => {
  const query = await readFile(`${examples}/heads.rq`, 'utf8');
  const rows = await (await new QueryEngine().queryBindings(query, { sources: [`${fusion}/`], lenient: true })).toArray();
  assert.ok(rows.length > 0, 'somebody is found');
  for (const row of rows) {
    const height = Number(row.get('y').value);
    assert.ok(height > 0.3 && height < 2.3, `a head at ${height} m`);
  }
});
