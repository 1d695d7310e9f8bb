// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What `thalweg export --for web` leaves, in Debian's Chromium: index.html from a web server and terrain.html from disk, offline.
// THALWEG_EXE and THALWEG_SOURCE_DIR name the program and the sources; with THALWEG_PICTURES screenshots are kept there.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import http from 'node:http';
import os from 'node:os';
import path from 'node:path';
import { after, before, describe, test } from 'node:test';
import { barriers, launch, open } from './browser.mjs';

const exe = process.env.THALWEG_EXE;
const place = fs.mkdtempSync(path.join(os.tmpdir(), 'thalweg-web-'));
const web = path.join(place, 'web');
const dem = path.join(place, 'made/dem.tif');
const kinds = { '.html': 'text/html', '.png': 'image/png', '.geojson': 'application/geo+json' };
let data;
let points;
let server;
let browser;

/** Serves a folder as `python3 -m http.server` does. */
function serve(folder) {
  return new Promise((done) => {
    const listening = http.createServer((request, answer) => {
      const name = decodeURIComponent(new URL(request.url, 'http://localhost').pathname);
      const file = path.join(folder, name === '/' ? 'index.html' : name);
      if (!fs.existsSync(file)) return answer.writeHead(404).end();
      answer.writeHead(200, { 'content-type': kinds[path.extname(file)] ?? 'application/octet-stream' });
      return fs.createReadStream(file).pipe(answer);
    }).listen(0, '127.0.0.1', () => done(listening));
  });
}

const heightAt = ([lng, lat]) => Number(execFileSync('gdallocationinfo', ['-valonly', '-wgs84', dem, String(lng), String(lat)]));

before(async () => {
  execFileSync(exe, ['make', '--set', 'grid.width=420', '--set', 'grid.height=300', '--set', 'network.dla.particles=9000', '-o',
    path.join(place, 'made'), '-q']);
  execFileSync(exe, ['export', path.join(place, 'made'), '--for', 'web', '-o', web]);
  data = JSON.parse(fs.readFileSync(path.join(web, 'index.html'), 'utf8').match(/id="data">(.*?)<\/script>/s)[1]);
  const [west, south, east, north] = data.bounds;
  points = [[0.3, 0.4], [0.5, 0.5], [0.62, 0.7]].map(([x, y]) => [west + x * (east - west), south + y * (north - south)]);
  [server, browser] = await Promise.all([serve(web), launch('webgl')]);
});
after(async () => {
  await browser?.close();
  server?.close();
  fs.rmSync(place, { recursive: true, force: true });
});

/** How many colours a screenshot has. */
async function coloursOf(page, name) {
  const picture = await page.screenshot();
  if (process.env.THALWEG_PICTURES) fs.writeFileSync(path.join(process.env.THALWEG_PICTURES, `${name}.png`), picture);
  return page.evaluate(async (text) => {
    const image = new Image();
    image.src = `data:image/png;base64,${text}`;
    await image.decode();
    const copy = new OffscreenCanvas(image.width, image.height).getContext('2d');
    copy.drawImage(image, 0, 0);
    const shown = copy.getImageData(0.2 * image.width, 0.3 * image.height, 0.6 * image.width, 0.6 * image.height).data;
    return new Set(new Uint32Array(shown.buffer)).size;
  }, picture.toString('base64'));
}

const idle = (page) => page.evaluate(async () => {
  const { map } = window.__thalweg;
  const done = new Promise((resolve) => map.once('idle', resolve));
  map.triggerRepaint();
  await done;
});

for (const [name, address, own] of [
  ['index.html from a web server', () => `http://127.0.0.1:${server.address().port}/`, (url) => url.startsWith(`http://127.0.0.1:${server.address().port}/`)],
  ['terrain.html from disk', () => path.join(web, 'terrain.html'), (url) => url.startsWith('file://') && url.endsWith('/terrain.html')],
]) {
  describe(name, () => {
    let seen;
    let page;
    const short = name.split('.')[0];
    before(async () => {
      seen = await open(browser, address());
      page = seen.page;
    });
    after(() => page?.close());

    test('is ready without a word of complaint and without a request elsewhere', () => {
      assert.equal(seen.failed, null);
      assert.deepEqual(seen.complaints, []);
      assert.deepEqual(seen.requests.filter((url) => !/^(blob|data):/.test(url) && !own(url)), []);
    });

    test('shows the terrain', async () => {
      assert.ok(await coloursOf(page, `web_${short}`) > 3000);
    });

    test('has the heights of the DEM', async () => {
      for (const point of points) {
        const z = await page.evaluate(([at, factor]) => window.__thalweg.map.queryTerrainElevation(at) / factor, [point, data.exaggeration]);
        const real = heightAt(point);
        console.log(`# ${z} m for ${real} m`);
        assert.ok(Math.abs(z - real) < 0.02 * (data.max_m - data.min_m), `${z} m for ${real} m`);
      }
    });

    test('says the height under the pointer', async () => {
      const at = await page.evaluate((point) => window.__thalweg.map.project(point), points[1]);
      await page.mouse.move(at.x, at.y);
      const said = await page.textContent('#height');
      assert.match(said, /^-?[\d,.]+ m$/);
      assert.ok(Math.abs(Number(said.replace(/[ m,]/g, '')) - heightAt(points[1])) < 0.1 * (data.max_m - data.min_m), said);
    });

    test('is worked by keys', async () => {
      await page.focus('.maplibregl-canvas');
      const before = await page.evaluate(() => window.__thalweg.map.getCenter().lng);
      await page.keyboard.press('ArrowRight');
      await page.waitForFunction((lng) => window.__thalweg.map.getCenter().lng !== lng && !window.__thalweg.map.isMoving(), before);
      assert.match(await page.textContent('#height'), /^middle: /);
      await page.focus('#exaggeration');
      await page.keyboard.press('End');
      assert.equal(await page.evaluate(() => window.__thalweg.map.getTerrain().exaggeration), 5);
      await page.focus('#show-rivers');
      await page.keyboard.press('Space');
      assert.equal(await page.evaluate(() => window.__thalweg.map.getLayoutProperty('rivers', 'visibility')), 'none');
      await idle(page);
      await coloursOf(page, `web_${short}_keys`);
    });

    test('has no barriers, and nothing went wrong', async () => {
      assert.deepEqual(await barriers(page), []);
      assert.deepEqual(seen.complaints, []);
      assert.equal(await page.evaluate(() => window.__thalweg.error), null);
    });
  });
}

test('index.html from disk says what to do', async () => {
  const { page, failed } = await open(browser, path.join(web, 'index.html'));
  assert.ok(failed);
  assert.match(await page.textContent('#message'), /Open terrain\.html/);
  await page.close();
});
