// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Drawing on the studio's page, with a server that only speaks as `thalweg studio` does. THALWEG_EXE names the program,
// which makes the land.
import assert from 'node:assert/strict';
import { execFileSync, spawn } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { after, afterEach, before, describe, test } from 'node:test';
import { barriers, launch, moveTo, pickCentre, placeOn, strokeOn } from './browser.mjs';
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
const at = (x, y, who = page) => placeOn(who, x, y);
const to = (x, y, steps) => moveTo(page, x, y, steps);
async function stroke(places) {
  await strokeOn(page, places);
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

describe('what is drawn', () => {
  for (const flatly of [false, true]) test(`is chosen and its vertices are moved, put in and taken out${flatly ? ', without WebGL' : ''}; an end joins a river`, async () => {
    await visit(three(), flatly ? { browser: flat } : { map: true });
    await page.keyboard.press('v');
    await click(152.5, 117.5);
    assert.match(await page.textContent('#inspector .what'), /^River 3, 1\.24 km, leaves at the border$/);
    await stroke([[155, 125], [165, 122]]);
    near((await drawn()).rivers[2].line, 1, [165, 122], 0.5);
    // It is still chosen: the line between two vertices gets a new one.
    await click(157.5, 136);
    await settled();
    assert.equal((await drawn()).rivers[2].line.length, 8);
    assert.deepEqual(sent().map(({ verb }) => verb), ['move', 'insert']);
    assert.equal(sent()[1].vertex, 2);
    assert.ok(await page.isVisible('text=Delete vertex'));
    await page.keyboard.press('Delete');
    await settled();
    assert.equal((await drawn()).rivers[2].line.length, 6);
    await stroke([[150, 149.5], [160, 82], [162, 80.6]]);
    const { rivers } = await drawn();
    near(rivers[2].line, 2, [162, 80.2], 1);
    assert.match(await page.textContent('#inspector .what'), /joins river 1/);
    // What lies beside everything lets go.
    await click(100, 130);
    assert.match(await page.textContent('#inspector'), /3 rivers\./);
    await page.keyboard.press('Control+z');
    await settled();
    near((await drawn()).rivers[2].line, 2, [150, 150], 0.1);
  });

  test('dense lines are moved softly, by handles that stand for their neighbours', async () => {
    const wave = Array.from({ length: 401 }, (_, i) => [i / 2, 75 + 10 * Math.sin(i / 25)]).flat();
    await visit(sheet({ rivers: [river(...wave)] }));
    await page.keyboard.press('v');
    await click(100, 75 + 10 * Math.sin(8));
    await stroke([[100, 75 + 10 * Math.sin(8)], [104, 60]]);
    const [{ verb, vertex, reach, to: at_ }] = sent();
    assert.equal(verb, 'move');
    assert.ok(Math.abs(vertex - 200) < 6 && reach > 5 && reach < 30, JSON.stringify([vertex, reach]));
    near(at_, 0, [104, 60], 1.5);
    const [{ line }] = (await drawn()).rivers;
    assert.equal(line.length, wave.length);
    assert.deepEqual(line.slice(0, 100), wave.slice(0, 100));
  });

  test('rivers are cut, joined, turned and erased', async () => {
    await visit(three(), { map: true });
    await page.keyboard.press('k');
    await click(150, 80.5);
    await settled();
    let { rivers } = await drawn();
    assert.equal(rivers.length, 4);
    near(rivers[3].line, rivers[3].line.length / 2 - 1, [147, 80.5], 1);
    await page.keyboard.press('j');
    await click(...rivers[3].line.slice(-2));
    await click(150, 112);
    await settled();
    ({ rivers } = await drawn());
    assert.deepEqual(Object.keys(sent()[1]), ['verb', 'river', 'end', 'at']);
    assert.deepEqual([sent()[1].river, sent()[1].end], [3, 'outlet']);
    await page.keyboard.press('v');
    await click(76, 50);
    assert.match(await page.textContent('#inspector .what'), /River 2.*joins river 4/);
    await page.click('#inspector >> text=Reverse');
    await settled();
    near((await drawn()).rivers[1].line, 0, [80, 78], 0.1);
    await page.keyboard.press('Control+z');
    await settled();
    await page.click('#inspector >> text="Delete"');
    await settled();
    assert.deepEqual(sent().at(-1), { verb: 'erase', river: 1, alone: false });
    assert.equal((await drawn()).rivers.length, 3);
    await click(40, 84);
    await page.keyboard.press('Shift+Delete');
    await settled();
    assert.equal(sent().at(-1).alone, true);
  });

  test('coasts, lakes with their level and masks', async () => {
    await visit(three(), { map: true });
    await page.keyboard.press('o');
    await stroke([[120, 149], [125, 130], [160, 125], [199.5, 128]]);
    let now = await drawn();
    assert.equal(now.coasts.length, 1);
    near(now.coasts[0], now.coasts[0].length / 2 - 1, [200, 128], 0.5);
    assert.equal(now.coasts[0].at(-2), 200);
    await page.keyboard.press('v');
    await click(125, 130);
    await page.click('text=Swap land and sea');
    await settled();
    near((await drawn()).coasts[0], 0, [200, 128], 0.5);
    await page.keyboard.press('a');
    await page.fill('#lake-level', '120.5');
    await page.keyboard.press('Tab');
    for (const p of [[150, 20], [170, 22], [168, 40], [150, 38]]) await click(...p);
    await click(150, 20);
    await settled();
    assert.equal(sent().at(-1).points.length, 8);
    assert.equal((await drawn()).lakes[0].level, 120.5);
    await page.keyboard.press('v');
    await click(160, 30);
    assert.match(await page.textContent('#inspector .what'), /Lake 1.*level 120\.5 m/);
    await page.fill('#lake-level', '');
    await page.keyboard.press('Tab');
    await settled();
    assert.deepEqual(sent().at(-1), { verb: 'level', lake: 0, level: null });
    await page.keyboard.press('s');
    await stroke([[60, 60], [190, 62], [185, 100], [62, 102], [61, 64]]);
    now = await drawn();
    assert.equal(now.masks.length, 1);
    await page.keyboard.press('v');
    await click(...now.masks[0].slice(20, 22));
    assert.match(await page.textContent('#inspector .what'), /Mask 1/);
    await page.keyboard.press('Delete');
    await settled();
    assert.equal((await drawn()).masks.length, 0);
  });

  for (const [where, options] of [['on the map', { map: true }], ['in 3-D', {}]]) test(`pins: each begins with the terrain's height ${where}, and its field is ready for another`, async () => {
    await visit(three(), options);
    await page.keyboard.press('h');
    assert.equal(await page.getAttribute('#tool-pin', 'aria-pressed'), 'true');
    await click(120, 40);
    await settled();
    const [{ verb, at: [x, y], height }] = sent();
    assert.equal(verb, 'pin');
    near([x, y], 0, [120, 40], 1);
    const ground = await page.evaluate(([px, py]) => window.__thalweg.pick(...Object.values(window.__thalweg.project(px, py))).z, [x, y]);
    assert.ok(Number.isInteger(height) && Math.abs(height - ground) < 3, `${height} is not near ${ground}`);
    assert.equal(await page.evaluate(() => document.activeElement.id), 'pin-height');
    assert.equal(await page.inputValue('#pin-height'), String(height));
    await page.keyboard.type('431.5');
    await page.keyboard.press('Enter');
    await settled();
    assert.deepEqual(sent().at(-1), { verb: 'height', pin: 0, height: 431.5 });
    assert.match(await page.textContent('#inspector .what'), /^Pin 1, 431\.5 m$/);
    assert.equal(await page.evaluate(() => document.activeElement.tagName), 'CANVAS');
    // What is typed counts without Enter too, once the next one is set.
    await click(150, 50);
    await settled();
    await page.keyboard.type('77');
    await click(175, 60);
    await settled();
    assert.deepEqual((await drawn()).pins.map((pin) => pin.height).slice(0, 2), [431.5, 77]);
    await page.keyboard.press('Escape');
    assert.equal((await drawn()).pins.length, 3);
    // A pin that is there is taken, and keeps its height unless another is typed.
    await click(150, 50);
    assert.equal(await page.inputValue('#pin-height'), '77');
    await page.keyboard.type('5');
    await page.keyboard.press('Escape');
    await settled();
    assert.equal((await drawn()).pins[1].height, 77);
    await page.keyboard.press('Delete');
    await settled();
    assert.deepEqual(sent().at(-1), { verb: 'erase', pin: 1 });
    await page.keyboard.press('Control+z');
    await settled();
    assert.equal((await drawn()).pins.length, 3);
    await click(100, 80.5);
    await settled();
    assert.match(await page.textContent('#saying'), /a river runs here/);
    assert.equal((await drawn()).pins.length, 3);
  });

  test('pins are moved and erased with the tool that selects', async () => {
    await visit({ ...three(), pins: [{ at: [120, 40], height: 431.5 }, { at: [150, 50], height: 77 }] }, { map: true });
    await page.keyboard.press('v');
    assert.match(await page.textContent('#inspector'), /3 rivers, 2 pins\./);
    await click(120, 40);
    assert.match(await page.textContent('#inspector .what'), /^Pin 1, 431\.5 m$/);
    await stroke([[120, 40], [125, 35], [130, 42]]);
    near((await drawn()).pins[0].at, 0, [130, 42], 1);
    assert.deepEqual([sent()[0].verb, sent()[0].of], ['move', { pin: 0 }]);
    assert.match(await page.textContent('#inspector .what'), /^Pin 1/);
    assert.ok(await page.isHidden('text=Delete vertex'));
    await page.keyboard.press('Delete');
    await settled();
    assert.deepEqual(sent().at(-1), { verb: 'erase', pin: 0 });
  });

  test('pins by the keyboard alone', async () => {
    await visit(three());
    await page.focus('#view canvas');
    await page.keyboard.press('h');
    await page.keyboard.press('Shift+ArrowUp');
    await page.keyboard.press('Shift+ArrowUp');
    await page.keyboard.press('Enter');
    await settled();
    await page.keyboard.type('12');
    await page.keyboard.press('Enter');
    await settled();
    assert.equal((await drawn()).pins[0].height, 12);
    await page.keyboard.press('Delete');
    await settled();
    assert.equal((await drawn()).pins.length, 0);
  });

  test('ridges, with heights at their ends, at one or at none', async () => {
    await visit(three(), { map: true });
    await page.keyboard.press('g');
    assert.ok(await page.isHidden('#ridge-from'));
    await stroke([[100, 20], [110, 30], [120, 25], [140, 40]]);
    let { ridges } = await drawn();
    assert.equal(ridges.length, 1);
    near(ridges[0].line, 0, [100, 20], 1);
    assert.match(await page.textContent('#inspector .what'), /^Ridge 1, .* km, heights by the terrain$/);
    await page.fill('#ridge-from', '500');
    await page.keyboard.press('Tab');
    await settled();
    assert.deepEqual(sent().at(-1), { verb: 'heights', ridge: 0, from: 500, to: null });
    assert.match(await page.textContent('#inspector .what'), /level 500 m$/);
    await page.fill('#ridge-to', '420.5');
    await page.keyboard.press('Enter');
    await settled();
    assert.match(await page.textContent('#inspector .what'), /500 m to 420\.5 m$/);
    // The next one is another ridge; across a river it is red at once, and refused.
    await to(120, 60);
    await page.mouse.down();
    for (const p of [[121, 75], [122, 90], [123, 110]]) await to(...p);
    assert.match(await page.textContent('#saying'), /the ridge would cross river 1 here/);
    await page.mouse.up();
    await settled();
    assert.match(await page.textContent('#saying'), /cross/);
    ({ ridges } = await drawn());
    assert.equal(ridges.length, 1);
    await page.keyboard.press('Escape');
    await page.keyboard.press('v');
    await click(100.5, 20.5);
    assert.match(await page.textContent('#inspector .what'), /^Ridge 1/);
    assert.equal(await page.inputValue('#ridge-to'), '420.5');
    await stroke([[100, 20], [90, 15]]);
    near((await drawn()).ridges[0].line, 0, [90, 15], 1);
    await page.fill('#ridge-from', '');
    await page.fill('#ridge-to', '');
    await page.keyboard.press('Tab');
    await settled();
    assert.deepEqual(sent().at(-1), { verb: 'heights', ridge: 0, from: null, to: null });
    await page.click('#inspector >> text=Delete');
    await settled();
    assert.ok(['remove', 'erase'].includes(sent().at(-1).verb));
    await page.keyboard.press('Control+z');
    await settled();
    assert.equal((await drawn()).ridges.length, 1);
  });

  test('types, side streams and how many sources they have', async () => {
    await visit(three(), { map: true });
    await page.keyboard.press('v');
    await click(40, 84);
    await page.selectOption('#river-type', 'C');
    await settled();
    assert.deepEqual(sent().at(-1), { verb: 'type', rivers: [0], type: 'C' });
    assert.deepEqual(await page.$$eval('#river-type option', (all) => all.map((o) => o.value)), ['', 'Aa+', 'A', 'B', 'C', 'D', 'DA', 'E', 'F', 'G']);
    assert.ok(await page.isHidden('#river-lambda'));
    await page.click('#branching');
    await settled();
    assert.deepEqual(sent().at(-1), { verb: 'branching', on: true });
    await page.fill('#river-lambda', '12');
    await page.keyboard.press('Enter');
    await settled();
    assert.deepEqual(sent().at(-1), { verb: 'lambda', rivers: [0], lambda: 12 });
    // A new river gets what the fields say.
    await page.keyboard.press('Escape');
    await page.click('#tool-river');
    await page.selectOption('#river-type', 'E');
    await page.fill('#river-lambda', '4');
    await page.keyboard.press('Tab');
    await stroke([[150, 20], [152, 40]]);
    assert.deepEqual([sent().at(-1).type, sent().at(-1).lambda], ['E', 4]);
  });

  test('is chosen, moved and erased by the keyboard alone', async () => {
    await visit(three());
    await page.focus('#view canvas');
    await page.keyboard.press('v');
    await page.keyboard.press('PageDown');
    assert.match(await said(), /^River 1, .*leaves at the border$/);
    await page.keyboard.press('Enter');
    assert.match(await said(), /picked up/);
    for (let k = 0; k < 4; ++k) await page.keyboard.press('ArrowRight');
    await page.keyboard.press('Shift+ArrowUp');
    await page.keyboard.press(' ');
    await settled();
    const [{ verb, of, vertex, to: [x, y] }] = sent();
    assert.deepEqual([verb, of, vertex], ['move', { river: 0 }, 0]);
    assert.ok(x >= 0 && x < 12 && y < 78, `${x}, ${y}`);
    await page.keyboard.press('PageDown');
    await page.keyboard.press('Delete');
    await settled();
    assert.deepEqual(sent().at(-1), { verb: 'erase', river: 1, alone: false });
  });

  test('of a generator it says what an edit does, before one', async () => {
    await visit({ ...three(), kind: 'shown' }, { map: true });
    await page.keyboard.press('v');
    assert.match(await page.textContent('#inspector'), /becomes drawn lines; undo brings the generator back/);
    await click(40, 84);
    await page.keyboard.press('Delete');
    await settled();
    assert.equal((await drawn()).kind, 'drawn');
    assert.doesNotMatch(await page.textContent('#inspector'), /becomes drawn/);
    await page.keyboard.press('Control+z');
    await settled();
    assert.equal((await drawn()).kind, 'shown');
  });
});

describe('the sheet', () => {
  test('is empty at first, and its land comes with the first river', async () => {
    await visit(sheet());
    assert.equal((await pickCentre(page)).z, null);
    assert.ok(await page.isVisible('#sheet-hint'));
    assert.match(await page.textContent('#sheet-hint'), /Draw a river R: from its source to the sea/);
    await page.keyboard.press('r');
    const eye = await at(100, 75);
    await stroke([[100, 30], [102, 50], [100, 75], [104, 100]]);
    assert.ok(await page.isHidden('#sheet-hint'));
    await page.waitForFunction(() => window.__thalweg.level === 'full');
    const after_ = await at(100, 75);
    assert.ok(Math.hypot(after_.x - eye.x, after_.y - eye.y) < 80, 'the view stays while a tool is held');
    await page.click('text=Clear sheet');
    await settled();
    assert.match(await page.textContent('#saying'), /Undo \(Ctrl\+Z\) brings everything back/);
    assert.equal((await pickCentre(page)).z, null);
    assert.ok(await page.isVisible('#sheet-hint'));
    assert.ok(await page.isDisabled('text=Clear sheet'));
    await page.keyboard.press('Control+z');
    await page.waitForFunction(() => window.__thalweg.level === 'full');
    assert.equal((await drawn()).rivers.length, 1);
  });

  test('many lines one after another wait for nobody, and a second window follows', async () => {
    await visit(three(), { map: true });
    const other = await gl.newPage({ viewport: { width: 900, height: 700 } });
    await other.goto(`${server.url}&aa=0`);
    await settled(other);
    await page.keyboard.press('r');
    for (let x = 100; x < 180; x += 20) {
      await to(x, 20);
      await page.mouse.down();
      await to(x + 2, 40);
      await page.mouse.up();
    }
    await settled();
    assert.equal((await drawn()).rivers.length, 7);
    await other.waitForFunction(() => window.__thalweg.drawing().rivers.length === 7);
    const reply = await other.evaluate(() => window.__thalweg.draw({ verb: 'erase', river: 6, alone: true }));
    await page.waitForFunction(() => window.__thalweg.drawing().rivers.length === 6);
    assert.equal(reply.revision, (await drawn()).revision);
    await assert.rejects(other.evaluate(() => window.__thalweg.draw({ verb: 'dig' })), /unknown verb/);
    await other.close();
  });

  test('has names for all that can be pressed, and no serious barrier, light, dark and on a phone', async () => {
    for (const context of [{ colorScheme: 'light' }, { colorScheme: 'dark' }, { colorScheme: 'dark', viewport: { width: 360, height: 740 }, hasTouch: true }]) {
      if (page && !page.isClosed()) await page.close();
      await server?.close();
      await visit(three(), context);
      await page.evaluate(() => window.__thalweg.hold('select'));
      await page.focus('#view canvas');
      await page.keyboard.press('PageDown');
      assert.deepEqual(await barriers(page), []);
      const names = await page.$$eval('#toolbar button', (all) => all.map((b) => [b.getAttribute('aria-label'), b.title]));
      assert.ok(names.length >= 7 && names.every(([name, title]) => name && /\([A-Z]\)$/.test(title)), JSON.stringify(names));
      assert.ok((await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth)) <= 0);
      const inside = await page.evaluate(() => {
        const stage = document.getElementById('stage').getBoundingClientRect();
        return Array.from(document.querySelectorAll('#toolbar button, #inspector')).every((e) => {
          const box = e.getBoundingClientRect();
          return box.left >= stage.left && box.right <= stage.right && box.bottom <= stage.bottom;
        });
      });
      assert.ok(inside, 'all is in sight');
    }
  });

  test('has no tools where the program speaks of no drawing', async () => {
    server = await fakeStudio({ lands, keys, values, pause: 5 });
    page = await gl.newPage({ viewport: { width: 1280, height: 720 } });
    complaints = [];
    await page.goto(`${server.url}&aa=0`);
    await page.waitForFunction(() => window.__thalweg.ready && !window.__thalweg.busy);
    assert.equal(await page.locator('#tool-river').count(), 0);
  });
});

describe('thalweg studio itself', () => {
  test('makes land of what is drawn on an empty sheet, and takes it back', async () => {
    const folder = path.join(place, 'sheet');
    const program = spawn(exe, ['studio', '--blank', '-o', folder, '--no-browser', '-q'], { stdio: ['ignore', 'pipe', 'inherit'] });
    const ended = new Promise((done) => program.on('exit', done));
    const url = await new Promise((done) => program.stdout.once('data', (bytes) => done(String(bytes).trim())));
    server = { asked: [], close: () => (program.kill('SIGINT'), ended) };
    page = await gl.newPage({ viewport: { width: 1280, height: 720 } });
    complaints = [];
    page.on('pageerror', (error) => complaints.push(String(error)));
    await page.goto(url);
    await settled();
    assert.ok(await page.isVisible('#sheet-hint'));
    await page.click('#bmap');
    await page.keyboard.press('o');
    await stroke([[0, 400], [200, 390], [350, 410], [511, 400]]);
    await page.keyboard.press('r');
    await stroke([[200, 60], [220, 160], [200, 260], [240, 400]]);
    await page.waitForFunction(() => window.__thalweg.level === 'full');
    await stroke([[380, 100], [360, 200], [225, 320]]);
    const { rivers, coasts, kind } = await drawn();
    assert.deepEqual([kind, rivers.length, coasts.length], ['drawn', 2, 1]);
    const [x, y] = rivers[1].line.slice(-2);
    assert.ok(rivers[0].line.some((v, i) => i % 2 === 0 && v === x && rivers[0].line[i + 1] === y), 'the second joins the first');
    assert.equal(await page.evaluate(() => window.__thalweg.error), null);
    assert.ok((await page.evaluate(() => window.__thalweg.heights().filter((z) => Number.isNaN(z)).length)) > 20000, 'there is a sea');
    await stroke([[100, 200], [400, 220]]);
    assert.match(await page.textContent('#saying.bad'), /cross another one/);
    await page.keyboard.press('Escape');
    await page.keyboard.press('v');
    await click(...rivers[1].line.slice(0, 2));
    assert.match(await page.textContent('#inspector .what'), /^River 2, .* km, joins river 1$/);
    await page.keyboard.press('Delete');
    await settled();
    assert.equal((await drawn()).rivers.length, 1);
    for (let left = 3; left > 0; --left) {
      await page.keyboard.press('Control+z');
      await settled();
    }
    assert.deepEqual((await drawn()).rivers, []);
    assert.equal((await pickCentre(page)).z, null);
  });
});
