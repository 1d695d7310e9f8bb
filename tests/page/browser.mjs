// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Debian's Chromium without a screen, and what the tests ask of a page in it.
import assert from 'node:assert/strict';
import { createRequire } from 'node:module';
import path from 'node:path';
import { pathToFileURL } from 'node:url';

export const web = path.resolve(import.meta.dirname ?? path.dirname(new URL(import.meta.url).pathname), '../../web');
const require = createRequire(path.join(web, 'package.json'));
const { chromium } = require('playwright-core');
export const axe = require('axe-core').source;

const quiet = ['--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync'];
const software = ['--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'];

/** kind: 'webgl' (software) or 'no3d'. */
export function launch(kind) {
  return chromium.launch({ executablePath: '/usr/bin/chromium', args: quiet.concat(kind === 'no3d' ? ['--disable-3d-apis'] : software) });
}

/** Opens a page, a file or an http address, and waits until it is ready. Gives {page, complaints, requests, seconds, failed}. */
export async function open(browser, file, { query = '', ...context } = {}) {
  const page = await browser.newPage({ viewport: { width: 1280, height: 800 }, ...context });
  const complaints = [];
  const requests = [];
  page.on('console', (message) => ['error', 'warning'].includes(message.type()) && complaints.push(message.text()));
  page.on('pageerror', (error) => complaints.push(String(error)));
  page.on('request', (request) => requests.push(request.url()));
  const begin = Date.now();
  await page.goto((file.startsWith('http:') ? file : pathToFileURL(file).href) + query);
  await page.waitForFunction(() => window.__thalweg?.ready || window.__thalweg?.error, null, { timeout: 60000 });
  return { page, complaints, requests, seconds: (Date.now() - begin) / 1000, failed: await page.evaluate(() => window.__thalweg.error) };
}

/** What the view shows: distinct colours, and pixels that are clearly blue. */
export function look(page) {
  return page.evaluate(async () => {
    await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
    await window.__thalweg.still?.();
    const shown = document.querySelector('#view canvas');
    const copy = new OffscreenCanvas(shown.width, shown.height).getContext('2d');
    copy.drawImage(shown, 0, 0);
    const { data } = copy.getImageData(0, 0, shown.width, shown.height);
    const colours = new Set();
    let rivers = 0;
    let hash = 0;
    for (let i = 0; i < data.length; i += 4) {
      const [r, g, b] = [data[i], data[i + 1], data[i + 2]];
      colours.add((r << 16) | (g << 8) | b);
      rivers += b - r >= 60 && b - g >= 25;
      hash = (Math.imul(hash, 31) + r + 7 * g + 13 * b) | 0;
    }
    return { colours: colours.size, rivers, hash };
  });
}

export async function set(page, id, value) {
  await page.$eval(`#${id}`, (input, v) => {
    input.value = v;
    input.dispatchEvent(new Event('input', { bubbles: true }));
  }, String(value));
}

export function pickCentre(page) {
  return page.evaluate(() => {
    const { clientWidth, clientHeight } = document.querySelector('#view canvas');
    return window.__thalweg.pick(clientWidth / 2, clientHeight / 2);
  });
}

/** Where a place of the grid is on the screen; null: out of sight. */
export const placeOn = (page, x, y) => page.evaluate(([px, py]) => {
  const frame = document.querySelector('#view canvas').getBoundingClientRect();
  const p = window.__thalweg.project(px, py);
  return p && { x: p.x + frame.left, y: p.y + frame.top };
}, [x, y]);

/** Moves the mouse to a place of the grid. */
export async function moveTo(page, x, y, steps = 4) {
  const p = await placeOn(page, x, y);
  assert.ok(p, `(${x}, ${y}) is in sight`);
  await page.mouse.move(p.x, p.y, { steps });
}

/** Draws with the mouse from place to place. */
export async function strokeOn(page, places, steps) {
  await moveTo(page, ...places[0], steps);
  await page.mouse.down();
  for (const p of places.slice(1)) await moveTo(page, ...p, steps);
  await page.mouse.up();
}

/** Faults that axe calls serious or critical. */
export async function barriers(page) {
  await page.evaluate(axe);
  const { violations } = await page.evaluate(() => window.axe.run());
  return violations.filter((v) => ['serious', 'critical'].includes(v.impact))
    .map((v) => `${v.id}: ${v.nodes.map((n) => n.target.join(' ')).join(', ')}`);
}
