// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The two minutes of docs/studio.md, step by step, with `thalweg studio` itself: an island is drawn on an empty sheet,
// and what comes of it is checked. THALWEG_EXE names the program; THALWEG_PICTURES a folder for pictures.
import assert from 'node:assert/strict';
import { execFileSync, spawn } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { after, before, describe, test } from 'node:test';
import { barriers, launch, moveTo, strokeOn } from './browser.mjs';

const exe = process.env.THALWEG_EXE;
const pictures = process.env.THALWEG_PICTURES;
const place = fs.mkdtempSync(path.join(os.tmpdir(), 'thalweg-tour-'));
const folder = path.join(place, 'island');
let studio;
let browser;
let page;
let complaints = [];

before(async () => {
  studio = spawn(exe, ['studio', '--blank', '-o', folder, '--no-browser', '-q'], { stdio: ['ignore', 'pipe', 'inherit'] });
  const url = await new Promise((done) => studio.stdout.once('data', (data) => done(String(data).trim())));
  browser = await launch('webgl');
  page = await browser.newPage({ viewport: { width: 1500, height: 900 } });
  page.on('console', (message) => ['error', 'warning'].includes(message.type()) && complaints.push(message.text()));
  page.on('pageerror', (error) => complaints.push(String(error)));
  await page.goto(`${url}&aa=0`);
  await settled();
});
after(async () => {
  await browser?.close();
  studio?.kill('SIGINT');
  fs.rmSync(place, { recursive: true, force: true });
});

/** Nothing is being computed, and the report is that of what is shown. */
async function settled() {
  await page.waitForFunction(() => {
    const { error, ready, busy, drawing } = window.__thalweg;
    return error || (ready && !busy && drawing?.() && document.documentElement.dataset.stale !== 'on');
  }, null, { timeout: 120000 });
  assert.equal(await page.evaluate(() => window.__thalweg.error), null);
  await page.evaluate(() => window.__thalweg.still?.());
}
const drawn = () => page.evaluate(() => window.__thalweg.drawing());
const times = () => page.evaluate(() => window.__thalweg.times);
const to = (x, y) => moveTo(page, x, y, 6);
const stroke = (places) => strokeOn(page, places, 6);
/** A line through places as a hand draws it. */
function curve(places, closed = false) {
  const out = [];
  const get = (i) => (closed ? places[(i + places.length) % places.length] : places[Math.min(Math.max(i, 0), places.length - 1)]);
  for (let i = 0; i < (closed ? places.length : places.length - 1); ++i) {
    const [a, b, c, d] = [get(i - 1), get(i), get(i + 1), get(i + 2)];
    for (let k = 0; k < 6; ++k) {
      const t = k / 6;
      out.push([0, 1].map((j) => 0.5 * (2 * b[j] + (c[j] - a[j]) * t + (2 * a[j] - 5 * b[j] + 4 * c[j] - d[j]) * t * t + (3 * b[j] - a[j] - 3 * c[j] + d[j]) * t ** 3)));
    }
  }
  out.push(closed ? out[0] : places.at(-1));
  return out;
}
async function picture(name) {
  if (!pictures) return;
  await page.mouse.move(750, 880);
  await page.waitForTimeout(400);
  await page.evaluate(() => window.__thalweg.still?.());
  await page.screenshot({ path: path.join(pictures, `${name}.png`) });
}

const coast = [[70, 250], [52, 330], [95, 400], [150, 418], [205, 462], [290, 452], [330, 415], [405, 420], [455, 350], [440, 285], [468, 210], [430, 140],
  [360, 118], [320, 62], [235, 50], [190, 82], [120, 90], [88, 160]];

describe('two minutes on an empty sheet', () => {
  test('the sheet says what to do', async () => {
    assert.equal((await drawn()).rivers.length, 0);
    assert.match(await page.textContent('#stage'), /Draw a river/);
    assert.deepEqual(await barriers(page), []);
  });

  test('a coast is drawn on the map', async () => {
    await page.click('#bmap');
    await page.keyboard.press('o');
    await stroke(curve(coast, true));
    await settled();
    const { coasts } = await drawn();
    assert.equal(coasts.length, 1);
    assert.deepEqual(coasts[0].slice(0, 2), coasts[0].slice(-2), 'it is closed');
    await picture('tour_1_coast');
  });

  test('three rivers, and the land follows', async () => {
    await page.keyboard.press('r');
    await stroke(curve([[262, 96], [250, 150], [268, 205], [240, 262], [252, 320], [228, 380], [246, 470]]));
    await settled();
    const first = await times();
    assert.equal((await drawn()).rivers.length, 1);
    assert.ok(first.first > 0 && first.full > 0, JSON.stringify(first));
    await stroke(curve([[130, 160], [168, 205], [190, 250], [238, 272]]));
    await settled();
    await stroke(curve([[408, 190], [360, 230], [345, 280], [290, 305], [252, 325]]));
    await settled();
    const { rivers, kind } = await drawn();
    assert.equal(rivers.length, 3);
    assert.equal(kind, 'drawn');
    assert.ok(rivers[0].line.at(-1) < 470, 'it ends at the coast');
    await picture('tour_2_rivers');
    console.log(`from pen-up to the first new land ${first.first} ms, in full ${first.full} ms`);
  });

  test('one that would cross another is refused where it would', async () => {
    await stroke(curve([[150, 330], [210, 345], [300, 350], [380, 345]]));
    await page.waitForTimeout(300);
    await settled();
    assert.equal((await drawn()).rivers.length, 3);
    assert.match(await page.textContent('#drawing-said'), /cross/);
    await picture('tour_3_refused');
    await page.keyboard.press('Escape');
  });

  test('one is moved', async () => {
    await page.keyboard.press('v');
    const { line } = (await drawn()).rivers[1];
    await to(line[0], line[1]);
    await page.mouse.down();
    await page.mouse.up();
    await stroke([[line[0], line[1]], [line[0] - 10, line[1] + 20], [118, 205]]);
    await settled();
    const moved = (await drawn()).rivers[1].line;
    assert.ok(Math.hypot(moved[0] - 118, moved[1] - 205) < 4, `${moved.slice(0, 2)}`);
    await picture('tour_4_moved');
  });

  test('one is cut, and joined again', async () => {
    await page.keyboard.press('k');
    const { line } = (await drawn()).rivers[2];
    const k = 2 * Math.floor(line.length / 4);
    await to(line[k], line[k + 1]);
    await page.mouse.down();
    await page.mouse.up();
    await settled();
    const cut = (await drawn()).rivers;
    assert.equal(cut.length, 4);
    await page.keyboard.press('j');
    const end = cut[3].line.slice(-2);
    const begin = cut[2].line.slice(0, 2);
    for (const p of [end, begin]) {
      await to(...p);
      await page.mouse.down();
      await page.mouse.up();
    }
    await settled();
    const joined = (await drawn()).rivers;
    assert.deepEqual(joined[3].line.slice(-2), joined[2].line.slice(0, 2));
    await page.keyboard.press('Escape');
  });

  test('a lake', async () => {
    await page.keyboard.press('a');
    await stroke(curve([[235, 335], [258, 332], [268, 352], [262, 376], [240, 384], [222, 372], [224, 350]], true));
    await settled();
    assert.equal((await drawn()).lakes.length, 1);
    await page.keyboard.press('Escape');
    await page.click('#bmap');
    await settled();
    await picture('tour_5_lake');
  });

  test('short streams are pruned', async () => {
    await page.evaluate(() => window.__thalweg.run({ set: 'network.fill_space', value: 'true' }));
    await settled();
    await page.evaluate(() => window.__thalweg.run({ set: 'network.prune', value: '10' }));
    await settled();
    assert.match(await page.evaluate(() => window.__thalweg.recipe()), /prune = 10/);
    await picture('tour_6_land');
  });

  test('the certificate holds', async () => {
    assert.match(await page.textContent('#verdict'), /hold|passed|ok/i);
  });

  test('everything is exported, and check finds it good', async () => {
    const { folder: out, files } = await page.evaluate(() => window.__thalweg.export());
    assert.ok(files.includes('network.gpkg') && files.includes('dem.tif'));
    execFileSync(exe, ['check', out, '--dem', path.join(out, 'dem.tif')], { stdio: 'ignore' });
    execFileSync(exe, ['make', path.join(folder, 'recipe.toml'), '-o', path.join(place, 'made'), '-q'], { stdio: 'ignore' });
    for (const name of ['dem.tif', 'network.gpkg', 'lakes.tif']) assert.ok(fs.readFileSync(path.join(out, name)).equals(fs.readFileSync(path.join(place, 'made', name))), name);
    const inputs = fs.readdirSync(path.join(folder, 'inputs'), { recursive: true }).filter((name) => name.endsWith('.gpkg')).map((name) => path.join(folder, 'inputs', name));
    assert.ok(inputs.length >= 6);
    const qgis = path.join(process.env.THALWEG_SOURCE_DIR, 'tests/clients/check_qgis.py');
    execFileSync('/usr/bin/python3', [qgis, out, ...inputs], { stdio: ['ignore', 'ignore', 'inherit'] });
  });

  test('undo leads back to the empty sheet', async () => {
    for (let i = 0; i < 20 && (await drawn()).coasts.length + (await drawn()).rivers.length > 0; ++i) {
      await page.evaluate(() => window.__thalweg.undo());
      await settled();
    }
    const { rivers, coasts, lakes } = await drawn();
    assert.equal(rivers.length + coasts.length + lakes.length, 0);
    assert.deepEqual(complaints, []);
  });
});
