// Real services with certificates of our own authority, and Chromium with a film as its camera.
import { execFileSync, spawn } from 'node:child_process';
import { X509Certificate, createHash } from 'node:crypto';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { request } from 'node:https';
import { createServer } from 'node:net';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

import { chromium } from 'playwright-core';

export const ROOT = fileURLToPath(new URL('../../../', import.meta.url));
export const VIDEOS = join(ROOT, 'tests/data/pose2sim_videos/four');
export const READ = 'reader-0123456789';
export const CONTROL = "control (0123456789) / it's 100%";
const BIN = process.env.CHORUS_BIN;

/// A configuration of deploy or of the videos: JSON with comments of whole lines.
export const settingsOf = (file) => JSON.parse(readFileSync(file, 'utf8').replace(/^\s*\/\/.*$/gm, ''));

export async function freePort() {
  const server = createServer();
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  const { port } = server.address();
  await new Promise((resolve) => server.close(resolve));
  return port;
}

export async function until(what, condition, seconds = 60) {
  const end = Date.now() + seconds * 1000;
  for (;;) {
    const value = await Promise.resolve().then(condition).catch(() => null);
    if (value) return value;
    if (Date.now() > end) throw new Error(`not within ${seconds} s: ${what}`);
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
}

export class Workshop {
  constructor() {
    this.folder = mkdtempSync(join(tmpdir(), 'chorus-capture-'));
    this.children = [];
    execFileSync(`${BIN}/chorus-host`, ['init', 'ca', '--out', join(this.folder, 'ca')], { stdio: 'pipe' });
    execFileSync(`${BIN}/chorus-host`, ['init', 'certificate', 'localhost', '127.0.0.1', '--authority', join(this.folder, 'ca'),
      '--out', join(this.folder, 'tls'), '--days', '30'], { stdio: 'pipe' });
    this.ca = readFileSync(join(this.folder, 'ca/ca.crt'));
    this.tls = { certificate: join(this.folder, 'tls/host.crt'), key: join(this.folder, 'tls/host.key') };
  }

  /// One picture of a video, as a film.
  still(camera, number) {
    const film = join(this.folder, `${camera}.y4m`);
    execFileSync(process.env.CHORUS_MAKE_STILL, [join(VIDEOS, `${camera}.mp4`), String(number), film], { stdio: 'pipe' });
    return film;
  }

  /// Starts a service; {url, port, child, log()} once it answers.
  async service(program, name, port, settings) {
    const file = join(this.folder, `${name}.json`);
    const tokens = [{ token: READ, role: 'read' }, { token: CONTROL, role: 'control' }];
    writeFileSync(file, JSON.stringify({ http: { port, tls: this.tls, tokens }, ...settings }));
    const child = spawn(`${BIN}/${program}`, ['--config', file], { cwd: ROOT, env: { ...process.env, XDG_STATE_HOME: this.folder } });
    this.children.push(child);
    let log = '';
    child.stderr.on('data', (bytes) => { log += bytes; });
    const service = { url: `https://localhost:${port}/`, port, child, log: () => log };
    await until(`${name} answers`, () => {
      if (child.exitCode !== null) throw new Error(log);
      return this.get(`${service.url}clock`);
    });
    return service;
  }

  /// {status, headers, json()} of a GET with the reader's token, or without one.
  get(url, { token = READ, method = 'GET' } = {}) {
    const headers = { Accept: 'application/json, */*;q=0.5', ...(token && { Authorization: `Bearer ${token}` }) };
    return new Promise((resolve, reject) => {
      const asked = request(url, { ca: this.ca, headers, method, family: 4 }, (answer) => {
        const parts = [];
        answer.on('data', (part) => parts.push(part));
        answer.on('end', () => {
          const text = Buffer.concat(parts).toString();
          resolve({ status: answer.statusCode, headers: answer.headers, text, json: () => JSON.parse(text) });
        });
      });
      asked.on('error', reject);
      asked.end();
    });
  }

  async json(url) { return (await this.get(url)).json(); }

  /// The certificate is taken by its key, because Chromium asks no file for authorities.  No graphics: imitating a card would cost more than
  /// everything else, and the page draws without.
  browser(film) {
    const certificate = new X509Certificate(readFileSync(this.tls.certificate));
    const key = createHash('sha256').update(certificate.publicKey.export({ type: 'spki', format: 'der' })).digest('base64');
    return chromium.launch({
      executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
      args: ['--no-sandbox', '--disable-background-networking', '--disable-component-update', '--disable-sync', '--disable-quic',
        '--disable-gpu', `--ignore-certificate-errors-spki-list=${key}`,
        '--use-fake-device-for-media-stream', ...(film ? [`--use-file-for-fake-video-capture=${film}`] : [])],
    });
  }

  close() {
    for (const child of this.children) child.kill('SIGKILL');
    rmSync(this.folder, { recursive: true, force: true });
  }
}
