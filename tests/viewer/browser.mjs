// Headless Chromium with software WebGL, for tests that look at the viewer.
import { chromium } from 'playwright-core';

export const PATIENCE_MS = 120000; // for anything to be shown, on whatever machine; a test that passes never waits so long

export function launch() {
  return chromium.launch({
    executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
    args: ['--no-sandbox', '--disable-background-networking', '--disable-component-update', '--disable-sync', '--disable-quic',
      '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
  });
}

/// Opens the viewer and collects all errors that it reports.
export async function openViewer(browser, url, size = { width: 1280, height: 800 }) {
  const page = await browser.newPage({ viewport: size, colorScheme: 'dark' });
  page.setDefaultTimeout(PATIENCE_MS);
  const complaints = [];
  page.on('pageerror', (error) => complaints.push(String(error)));
  page.on('console', (message) => {
    // Software WebGL reports that it is slow; that is no error of the page.
    if (message.type() === 'error' && !/GPU stall|swiftshader/i.test(message.text())) complaints.push(message.text());
  });
  await page.goto(url);
  return { page, complaints };
}

/// Number of distinct colours on the canvas: an empty scene has a handful, a drawn one hundreds.
export function colorsOnCanvas(page) {
  return page.evaluate(async () => {
    await new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve)));
    const shot = document.createElement('canvas');
    [shot.width, shot.height] = [320, 200];
    const source = document.getElementById('scene');
    const bitmap = await new Promise((resolve) => requestAnimationFrame(() => resolve(createImageBitmap(source))));
    shot.getContext('2d').drawImage(await bitmap, 0, 0, 320, 200);
    const pixels = shot.getContext('2d').getImageData(0, 0, 320, 200).data;
    const colors = new Set();
    for (let i = 0; i < pixels.length; i += 4) colors.add((pixels[i] << 16) | (pixels[i + 1] << 8) | pixels[i + 2]);
    return colors.size;
  });
}
