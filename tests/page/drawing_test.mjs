// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Drawing on the studio's page, with a server that only speaks as `thalweg studio` does. THALWEG_EXE names the program,
// which makes the land.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { after, afterEach, before, describe, test } from 'node:test';
import { barriers, launch } from './browser.mjs';
import { fakeStudio, keysOf, landOf, valuesOf } from './fake_studio.mjs';
import { river, sheet } from './fake_drawing.mjs';

const exe = process.env.THALWEG_EXE;
const place = fs.mkdtempSync(path.join(os.tmpdir(), 'thalweg-drawing-'));
let gl;
let flat;
let lands;
let keys;
let values;
before(async () => {
  const folder = path.join(place, 'land');
  execFileSync(exe, ['make', '-o', folder, '-q', ...['network.source=dla', 'grid.width=200', 'grid.height=150', 'grid.cell=30', 'network.dla.particles=4000', 'network.prune=6'].flatMap((s) => ['--set', s])]);
  lands = [[0, landOf(folder)]];
  keys = keysOf(exe);
  values = valuesOf(fs.readFileSync(path.join(folder, 'recipe.toml'), 'utf8'));
  [gl, flat] = await Promise.all([launch('webgl'), launch('no3d')]);
});
after(async () => {
  await gl?.close();
  await flat?.close();
  fs.rmSync(place, { recursive: true, force: true });
});

/** The main river from the west to the east, with a tributary from the north; another one by itself. */
const three = () => sheet({ rivers: [river(0, 80, 40, 84, 80, 78, 120, 82, 160, 80, 200, 84), river(80, 20, 76, 50, 80, 78), river(150, 110, 155, 125, 150, 150)] });

let server;
let page;
let complaints;
async function visit(drawing, { browser = gl, map = false, ...context } = {}) {
  server = await fakeStudio({ lands, keys, values, pause: 5, drawing });
  page = await browser.newPage({ viewport: { width: 1280, height: 720 }, ...context });
  complaints = [];
  page.on('console', (message) => ['error', 'warning'].includes(message.type()) && complaints.push(message.text()));
  page.on('pageerror', (error) => complaints.push(String(error)));
  await page.goto(`${server.url}&aa=0`);
  await settled();
  if (map) await page.click('#bmap');
  await page.evaluate(() => window.__thalweg.still?.());
}
afterEach(async () => {
  assert.equal(await page.evaluate(() => window.__thalweg.error), null);
  assert.deepEqual(complaints, []);
  await page.close();
  await server.close();
});
const settled = (who = page) => who.waitForFunction(() => {
  const { error, ready, busy, drawing } = window.__thalweg;
  return error || (ready && !busy && drawing() !== null);
}, null, { timeout: 20000 });
const drawn = () => page.evaluate(() => window.__thalweg.drawing());
const sent = () => server.asked.filter((m) => m.do === 'draw').map((m) => m.what);
const said = () => page.textContent('#drawing-said');
/** Where a place of the grid is on the screen. */
const at = async (x, y, who = page) => who.evaluate(([px, py]) => {
  const frame = document.querySelector('#view canvas').getBoundingClientRect();
  const p = window.__thalweg.project(px, py);
  return p && { x: p.x + frame.left, y: p.y + frame.top };
}, [x, y]);
async function to(x, y, steps = 4) {
  const p = await at(x, y);
  assert.ok(p, `(${x}, ${y}) is in sight`);
  await page.mouse.move(p.x, p.y, { steps });
}
async function stroke(places) {
  await to(...places[0]);
  await page.mouse.down();
  for (const p of places.slice(1)) await to(...p);
  await page.mouse.up();
  await settled();
}
async function click(x, y, options) {
  const p = await at(x, y);
  await page.mouse.click(p.x, p.y, options);
}
const near = (line, vertex, [x, y], most = 3) => assert.ok(Math.hypot(line.at(2 * vertex) - x, line.at(2 * vertex + 1) - y) < most, `${line.at(2 * vertex)}, ${line.at(2 * vertex + 1)} is not near ${x}, ${y}`);

describe('a river', () => {
  for (const [where, options] of [['in 3-D', {}], ['on the map', { map: true }], ['without WebGL', { browser: 'flat' }]]) {
    test(`is drawn by hand ${where}, from its source or from its end`, async () => {
      await visit(three(), { ...options, browser: options.browser ? flat : gl });
      await page.keyboard.press('r');
      assert.equal(await page.getAttribute('#tool-river', 'aria-pressed'), 'true');
      await stroke([[140, 30], [142, 45], [140, 60], [141, 81]]);
      let { rivers } = await drawn();
      assert.equal(rivers.length, 4);
      near(rivers[3].line, 0, [140, 30]);
      near(rivers[3].line, rivers[3].line.length / 2 - 1, [141, 81]);
      // The end is bit for bit a vertex of the river that it meets.
      const end = rivers[3].line.slice(-2);
      assert.ok(rivers[0].line.some((v, i) => i % 2 === 0 && v === end[0] && rivers[0].line[i + 1] === end[1]));
      await stroke([[60, 81], [58, 100], [62, 120]]);
      ({ rivers } = await drawn());
      near(rivers[4].line, 0, [62, 120]);
      assert.match(await said(), /turned: it ends at river 1/);
      assert.ok(await page.isVisible('#saying'));
    });
  }

  test('is drawn point by point; a vertex is taken back by Backspace and by Ctrl+Z', async () => {
    await visit(three(), { map: true });
    await page.click('#tool-river');
    for (const p of [[120, 20], [130, 30], [140, 25], [150, 35]]) await click(...p);
    await page.keyboard.press('Backspace');
    await page.keyboard.press('Control+z');
    await click(130, 60);
    await page.keyboard.press('Enter');
    await settled();
    const [{ verb, points }] = sent();
    assert.equal(verb, 'river');
    assert.equal(points.length, 6);
    [[120, 20], [130, 30], [130, 60]].forEach((p, i) => near(points, i, p, 1));
    assert.equal(server.asked.filter((m) => m.do === 'undo').length, 0);
    // A click on a river, or a second one on the same place, is the end.
    await click(100, 30);
    await click(100, 81);
    await settled();
    assert.equal((await drawn()).rivers.length, 5);
    await click(170, 30);
    await click(180, 40);
    await click(180, 40);
    await settled();
    assert.equal((await drawn()).rivers.length, 6);
    await click(20, 120);
    await page.keyboard.press('Escape');
    await page.keyboard.press('Enter');
    await settled();
    assert.equal(sent().length, 3);
    await page.keyboard.press('Control+z');
    await settled();
    assert.equal((await drawn()).rivers.length, 5);
  });

  test('that would cross another one is red at once, and refused at its place; the points stay', async () => {
    await visit(three(), { map: true });
    await page.keyboard.press('r');
    await to(120, 60);
    await page.mouse.down();
    for (const p of [[121, 75], [122, 90], [123, 110]]) await to(...p);
    assert.match(await page.textContent('#saying'), /would cross river 1 here/);
    await page.mouse.up();
    await settled();
    assert.match(await page.textContent('#saying'), /would cross another one here/);
    const box = await page.locator('#saying').boundingBox();
    const there = await at(121.6, 82);
    assert.ok(Math.abs(box.x + box.width / 2 - there.x) < 20 && Math.abs(box.y + box.height - there.y) < 30, JSON.stringify([box, there]));
    assert.equal((await drawn()).rivers.length, 3);
    // Backspace takes it back to before the other river, and Enter sends it again.
    for (let k = 0; k < 4; ++k) await page.keyboard.press('Backspace');
    assert.ok(await page.isHidden('#saying'));
    await page.keyboard.press('Enter');
    await settled();
    assert.equal((await drawn()).rivers.length, 4);
  });

  test('is drawn by one finger, while two move the view', async () => {
    await visit(three(), { map: true, hasTouch: true, viewport: { width: 900, height: 700 } });
    await page.evaluate(() => window.__thalweg.hold('river'));
    const client = await page.context().newCDPSession(page);
    const touch = (type, ...points) => client.send('Input.dispatchTouchEvent', { type, touchPoints: points.map(({ x, y }, id) => ({ x, y, id })) });
    const line = await Promise.all([[140, 30], [142, 40], [140, 50], [141, 60]].map((p) => at(...p)));
    await touch('touchStart', line[0]);
    for (const p of line.slice(1)) await touch('touchMove', p);
    await touch('touchEnd');
    await settled();
    near((await drawn()).rivers[3].line, 0, [140, 30]);
    const still = await at(100, 75);
    const [a, b] = [{ x: 500, y: 300 }, { x: 600, y: 300 }];
    await touch('touchStart', a);
    await touch('touchMove', { x: 490, y: 300 });
    await touch('touchStart', { x: 490, y: 300 }, b);
    for (let k = 1; k <= 8; ++k) await touch('touchMove', { x: 490 - 10 * k, y: 300 }, { x: 600 + 10 * k, y: 300 });
    await touch('touchEnd');
    await page.evaluate(() => window.__thalweg.still());
    const moved = await at(100, 75);
    assert.ok(moved === null || Math.hypot(moved.x - still.x, moved.y - still.y) > 15);
    assert.equal(sent().length, 1);
  });

  test('is drawn by the keyboard alone', async () => {
    await visit(three());
    await page.focus('#view canvas');
    await page.keyboard.press('r');
    await page.keyboard.press('Enter');
    for (let k = 0; k < 3; ++k) await page.keyboard.press('Shift+ArrowUp');
    await page.keyboard.press(' ');
    assert.match(await said(), /begun/);
    for (let k = 0; k < 2; ++k) await page.keyboard.press('Shift+ArrowRight');
    await page.keyboard.press('ArrowRight');
    await page.keyboard.press('Enter');
    assert.match(await said(), /point 2/);
    await page.keyboard.press('Shift+ArrowRight');
    await page.keyboard.press('Enter');
    await page.keyboard.press('Enter');
    await settled();
    assert.equal(sent()[0].points.length, 6);
    assert.equal((await drawn()).rivers.length, 4);
    await page.keyboard.press('Escape');
    assert.equal(await page.getAttribute('#tool-river', 'aria-pressed'), 'false');
  });
});
