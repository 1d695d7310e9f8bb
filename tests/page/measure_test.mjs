// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Measuring on the page in Debian's Chromium, by pointer, keys and touch; what is measured web/test/survey_test.mjs tests.
// THALWEG_EXE names the program, whose keys the studio's page wants.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { after, before, describe, test } from 'node:test';
import { sceneOf, valleyLand } from '../../web/test/made_land.mjs';
import { near } from '../../web/test/support.mjs';
import { barriers, launch, look, open, placeOn, set } from './browser.mjs';
import { fakeStudio, keysOf } from './fake_studio.mjs';
import { writePage } from './made_page.mjs';

const exe = process.env.THALWEG_EXE;
const place = fs.mkdtempSync(path.join(os.tmpdir(), 'thalweg-measure-'));
after(() => fs.rmSync(place, { recursive: true, force: true }));

const atan = (slope) => (Math.atan(slope) * 180) / Math.PI;

describe('in the browser', () => {
  let gl;
  let flat;
  let file;
  before(async () => {
    file = writePage(place, 'valley', valleyLand());
    [gl, flat] = await Promise.all([launch('webgl'), launch('no3d')]);
  });
  after(async () => {
    await gl?.close();
    await flat?.close();
  });

  const measured = (page) => page.evaluate(() => window.__thalweg.measured());
  const spoken = (page, wanted) => page.waitForFunction((text) => new RegExp(text).test(Array.from(document.querySelectorAll('[role=status]'), (e) => e.textContent).join(' ')), wanted);
  /** Where a place of the land is on the page. */
  const spot = async (page, x, y) => {
    const at = await placeOn(page, x, y);
    assert.ok(at, `${x}, ${y} is not in sight`);
    return [at.x, at.y];
  };
  const click = async (page, x, y) => page.mouse.click(...await spot(page, x, y));
  const overlay = (page) => page.evaluate(() => document.querySelector('#view canvas.overlay').toDataURL());
  const saved = async (page, button) => {
    const [download] = await Promise.all([page.waitForEvent('download'), page.click(`#measure >> text="${button}"`)]);
    return { name: download.suggestedFilename(), text: fs.readFileSync(await download.path(), 'utf8') };
  };
  async function shown(browser, ways, check, name = file) {
    const { page, complaints } = await open(browser, name, { query: '?aa=0&seg=127', viewport: { width: 1600, height: 900 }, ...ways.context });
    if (ways.map) await page.click('#bmap');
    await page.evaluate(() => window.__thalweg.still());
    await check(page);
    assert.equal(await page.evaluate(() => window.__thalweg.error), null);
    assert.deepEqual(complaints, []);
    await page.close();
  }
  /** 3-D, the map, and the map without WebGL. */
  const everywhere = async (check) => {
    for (const [browser, ways] of [[gl, {}], [gl, { map: true }], [flat, {}]]) await shown(browser, ways, (page) => check(page, browser === gl && !ways.map));
  };

  test('a profile is drawn freely or by clicks, read both ways, and saved', () => everywhere(async (page, deep) => {
    const first = await overlay(page);
    await page.click('#tool-profile');
    assert.match(await page.textContent('#measure'), /Draw a line/);
    const [from, to] = [await spot(page, 60, 90), await spot(page, 130, 90)];
    await page.mouse.move(...from);
    await page.mouse.down();
    await page.mouse.move(...to, { steps: 12 });
    assert.notEqual(await overlay(page), first);
    await page.mouse.up();
    const drawn = await measured(page);
    assert.equal(drawn.kind, 'profile');
    const off = deep ? 90 : 25; // the way over the land is straight on the map alone
    near(drawn.length, 70 * 30, off);
    near(drawn.up, 30 * 30 * 0.25, off);
    near(drawn.down, 40 * 30 * 0.4, off);
    assert.deepEqual(drawn.rivers.map(({ arc, order }) => [arc, order]), [[3, 2]]);
    await spoken(page, 'Profile of .* 1 river crossed');
    // By clicks, with one that is taken back; a click on a river begins a line with Shift.
    await click(page, 60, 90);
    await click(page, 90, 120);
    await page.keyboard.press('Backspace');
    await click(page, 100.5, 90);
    await page.mouse.dblclick(...await spot(page, 130, 90));
    const clicked = await measured(page);
    assert.equal(clicked.line.length, 3);
    near(clicked.length, 70 * 30, 25);
    near(clicked.down, 0.4 * 40.5 * 30, 12);
    clicked.points.forEach(({ d }, i) => i && assert.ok(d > clicked.points[i - 1].d));
    // The diagram marks the land, and the land the diagram.
    const still = await overlay(page);
    await page.hover('#measure .plot svg', { position: { x: 150, y: 70 } });
    assert.notEqual(await overlay(page), still);
    await page.mouse.move(...await spot(page, 80, 90));
    await page.waitForSelector('#measure .tip', { state: 'visible' });
    await page.mouse.move(...await spot(page, 80, 140));
    await page.waitForSelector('#measure .tip', { state: 'hidden' });
    const { name, text } = await saved(page, 'CSV');
    const rows = text.trim().split('\n');
    assert.equal(name, 'made-land-profile.csv');
    assert.equal(rows[0], 'distance [m],x [EPSG:32631],y [EPSG:32631],z [m]');
    assert.equal(rows.length, clicked.points.length + 1);
    const last = rows.at(-1).split(',').map(Number);
    near(last[0], clicked.length, 1e-3);
    near(last[1], 500000 + 30 * clicked.line[2][0], 1e-3);
    near(last[2], 5000000 - 30 * clicked.line[2][1], 1e-3);
    near(last[3], clicked.points.at(-1).z, 1e-3);
    // A river's own profile.
    await click(page, 100.5, 120);
    const river = await measured(page);
    assert.deepEqual([river.kind, river.order, river.arcs], ['river', 2, [1, 3]]);
    near(river.length, 140 * 30, 1);
    await page.keyboard.down('Shift');
    await click(page, 100.5, 120);
    await page.keyboard.up('Shift');
    await click(page, 120, 120);
    await page.keyboard.press('Enter');
    assert.equal((await measured(page)).kind, 'profile');
    await page.keyboard.press('Escape');
    assert.equal(await measured(page), null);
    assert.equal(await page.isVisible('#measure'), true); // the tool is held
    await page.keyboard.press('Escape');
    assert.equal(await page.isVisible('#measure'), false);
    assert.equal(await overlay(page), first);
  }));

  test('a section lies across the river and follows its handles', () => everywhere(async (page) => {
    await page.keyboard.press('x');
    await click(page, 102, 100);
    const found = await measured(page);
    assert.equal(found.kind, 'section');
    near(found.bearing, 90, 1e-6);
    near(found.line[0][1], found.line[1][1], 1e-6);
    near(found.left.slope, atan(0.25), 0.02);
    near(found.right.slope, atan(0.4), 0.02);
    near(found.area, (found.depth * found.depth * (1 / 0.25 + 1 / 0.4)) / 2, 0.01 * found.area);
    await spoken(page, 'Section of .* deep below the lower side');
    const [, [x, y]] = found.line;
    await page.mouse.move(...await spot(page, x, y));
    await page.mouse.down();
    await page.mouse.move(...await spot(page, 70, y), { steps: 4 });
    await page.mouse.up();
    const drawn = await measured(page);
    near(drawn.line[1][0], 70, 1);
    assert.deepEqual(drawn.line[0], found.line[0]);
    await set(page, 'section-width', 40);
    near((await measured(page)).width, 1200, 1);
    assert.match((await saved(page, 'CSV')).text, /^distance to the right \[m\],x/);
    await click(page, 40, 130); // beside rivers
    const beside = await measured(page);
    const [dx, dy] = [0.4, 0.02].map((slope) => slope / Math.hypot(0.4, 0.02));
    near((beside.line[1][0] - beside.line[0][0]) * dx + (beside.line[1][1] - beside.line[0][1]) * dy, 0, 0.05);
    await page.click('#measure .close');
    assert.equal(await measured(page), null);
    assert.equal(await page.isVisible('#measure'), false);
  }));

  test('a catchment is coloured, told and saved', () => everywhere(async (page) => {
    const plain = await look(page);
    await page.keyboard.press('c');
    await click(page, 101.5, 100.5);
    const found = await measured(page);
    assert.equal(found.kind, 'catchment');
    assert.equal(found.value % 200, 100);
    const areas = await page.evaluate((i) => window.__thalweg.water.areas[i], found.value);
    assert.equal(found.count, areas);
    near(found.area, areas * 900, 1e-6);
    near(found.share, areas / 32000, 1e-9);
    assert.deepEqual([found.arcs, found.sources, found.order, found.arc], [3, 2, 2, 3]);
    assert.notEqual((await look(page)).hash, plain.hash);
    await spoken(page, 'Catchment of .*% of the land');
    const { name, text } = await saved(page, 'Outline');
    const csv = path.join(place, name);
    fs.writeFileSync(csv, text);
    const { features } = JSON.parse(execFileSync('ogr2ogr', ['-f', 'GeoJSON', '/vsistdout/', csv, '-dialect', 'sqlite', '-sql', `SELECT *, ST_Area(geometry) AS shape FROM "${path.parse(name).name}"`]).toString());
    near(features[0].properties.shape, found.area, 1e-3);
    assert.equal(features[0].properties.crs, 'EPSG:32631');
    await click(page, 40.5, 100.5); // beside rivers
    const beside = await measured(page);
    assert.deepEqual([beside.value, beside.arcs, beside.arc], [100 * 200 + 40, 0, null]);
    await page.click('#measure .close');
    assert.equal((await look(page)).hash, plain.hash);
  }));

  test('distances are summed leg by leg, and a closed way has an area', () => everywhere(async (page) => {
    await page.click('#tool-distance');
    for (const [x, y] of [[60, 80], [90, 80], [90, 120], [60, 120]]) await click(page, x, y);
    const going = await measured(page);
    assert.equal(going.legs.length, 3);
    assert.equal(going.area, null);
    await click(page, 60, 80);
    const found = await measured(page);
    assert.equal(found.legs.length, 4);
    near(found.area, 30 * 40 * 900, 3e4);
    near(found.length, 140 * 30, 60);
    near(found.legs[0].bearing, 90, 1.5);
    near(found.legs[0].slope, -atan(0.4), 1);
    await spoken(page, 'in 4 legs, encloses');
    assert.equal(await page.locator('#measure tbody tr').count(), 4);
    await page.click('#tool-distance');
    assert.equal(await page.isVisible('#measure'), true); // what was measured stays
    await page.keyboard.press('Escape');
    assert.equal(await page.isVisible('#measure'), false);
  }));

  test('the keyboard alone measures', () => shown(gl, { map: true }, async (page) => {
    await page.focus('#view canvas');
    await page.keyboard.press('d');
    assert.equal(await page.getAttribute('#tool-distance', 'aria-pressed'), 'true');
    const before_ = await overlay(page);
    await page.keyboard.press('ArrowRight'); // the cross-hair comes to the middle
    assert.notEqual(await overlay(page), before_);
    await spoken(page, 'cell 100, 80');
    await page.keyboard.press('Enter');
    for (let k = 0; k < 3; ++k) await page.keyboard.press('ArrowRight');
    await page.keyboard.press('Shift+ArrowDown');
    await page.keyboard.press('Enter');
    await page.keyboard.press('ArrowUp'); // 4 pixels are another point
    await page.keyboard.press('Enter');
    await page.keyboard.press('Backspace');
    await page.keyboard.press('Escape');
    const { legs } = await measured(page);
    assert.equal(legs.length, 1);
    near(legs[0].bearing, 180 - atan(3 / 10), 0.1);
    // A profile of a river: Enter at the cross-hair, then the diagram by its keys.
    await page.keyboard.press('c');
    await page.keyboard.press('ArrowDown');
    await page.keyboard.press('Enter');
    assert.equal((await measured(page)).kind, 'catchment');
    await page.keyboard.press('l');
    await page.keyboard.press('ArrowDown');
    await page.keyboard.press('Enter');
    assert.equal((await measured(page)).kind, 'river');
    await page.focus('#measure [role=slider]');
    for (const key of ['PageUp', 'PageUp']) await page.keyboard.press(key);
    assert.equal(await page.isVisible('#measure .tip'), true);
    await page.focus('#view canvas');
    await page.keyboard.press('Escape');
    await page.keyboard.press('Escape');
    assert.equal(await measured(page), null);
    assert.equal(await page.getAttribute('#tool-profile', 'aria-pressed'), 'false');
    const turned = (await look(page)).hash;
    await page.keyboard.press('ArrowLeft'); // arrows are the view's again
    assert.notEqual((await look(page)).hash, turned);
  }));

  test('fingers measure, and on a phone the card lies below the view', () => shown(gl, { context: { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true } }, async (page) => {
    const tap = async (x, y) => page.touchscreen.tap(...await spot(page, x, y));
    await page.tap('#tool-distance');
    await tap(60, 80);
    await tap(90, 80);
    await page.tap('#measure >> text="Done"');
    const { legs } = await measured(page);
    assert.equal(legs.length, 1);
    near(legs[0].length, 900, 60);
    await page.tap('#tool-profile');
    await tap(101.5, 110);
    assert.equal((await measured(page)).kind, 'river');
    const [stage, card] = await page.evaluate(() => ['stage', 'measure'].map((id) => document.getElementById(id).getBoundingClientRect().toJSON()));
    assert.ok(card.top >= stage.bottom - 1 && card.width <= 390);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= document.documentElement.clientWidth));
    assert.deepEqual(await barriers(page), []);
  }));

  test('the card covers neither tools, north nor what is under the pointer, and raises no barrier, light and dark', async () => {
    for (const [colorScheme, viewport] of [['light', { width: 1280, height: 800 }], ['dark', { width: 1024, height: 700 }]]) {
      await shown(gl, { context: { colorScheme, viewport } }, async (page) => {
        await page.keyboard.press('x');
        await click(page, 100.5, 100);
        await page.$$eval('#measure details', (all) => all.forEach((e) => (e.open = true)));
        const boxes = await page.evaluate(() => Object.fromEntries(['measure', 'toolbar', 'north', 'point', 'ways'].map((id) => [id, document.getElementById(id).getBoundingClientRect().toJSON()])));
        const { measure: card, ...others } = boxes;
        for (const [name, b] of Object.entries(others)) assert.ok(b.right <= card.left || card.right <= b.left || b.bottom <= card.top || card.bottom <= b.top, `${name} under the card`);
        assert.deepEqual(await barriers(page), []);
      });
    }
  });

  test('where the page shows means of squares there is no catchment, and without land neither profile nor section', async () => {
    const means = writePage(place, 'means', valleyLand({ cells: 2 }));
    await shown(gl, {}, async (page) => {
      assert.match(await page.getAttribute('#tool-catchment', 'title'), /means of squares/);
      assert.equal(await page.isDisabled('#tool-catchment'), true);
      await page.keyboard.press('c');
      assert.equal(await page.isVisible('#measure'), false);
      await page.keyboard.press('x');
      await click(page, 100.5, 100);
      near((await measured(page)).bearing, 90, 1e-6);
    }, means);
    const scene = valleyLand();
    scene.data.heights = null;
    const bare = writePage(place, 'bare', { ...scene, packed: '', water: '' });
    for (const browser of [gl, flat]) {
      await shown(browser, {}, async (page) => {
        assert.deepEqual(await page.$$eval('#toolbar button', (all) => all.map((b) => b.disabled)), [true, true, true, false]);
        await page.keyboard.press('d');
        await click(page, 60, 80);
        await click(page, 90, 80);
        await page.keyboard.press('Enter');
        near((await measured(page)).length, 900, 40);
        assert.doesNotMatch(await page.textContent('#measure'), /height|NaN|Infinity/);
      }, bare);
    }
  });

  test('fewer rivers by the slider, fewer that a line crosses', () => shown(gl, { map: true }, async (page) => {
    await page.keyboard.press('l');
    await click(page, 60, 50);
    await click(page, 140, 50);
    await page.keyboard.press('Enter');
    assert.deepEqual((await measured(page)).rivers.map(({ arc }) => arc), [2, 1]);
    await set(page, 'L', 60);
    assert.deepEqual((await measured(page)).rivers.map(({ arc }) => arc), [1]);
  }));

  test('in the studio what is measured follows the land, and the line stays', async () => {
    const lands = [[0, valleyLand()], [20, valleyLand({ left: 0.2, right: 0.5, lift: 100 })]];
    const server = await fakeStudio({ lands, keys: keysOf(exe), values: { seed: '1', 'network.source': 'dla', 'network.prune': '6', 'network.dla.branch': 'largest' }, pause: 250 });
    after(() => server.close());
    const page = await gl.newPage({ viewport: { width: 1280, height: 720 } });
    await page.goto(`${server.url}&aa=0`);
    await page.waitForFunction(() => window.__thalweg?.ready);
    assert.match(await page.getAttribute('#tool-catchment', 'title'), /no land yet|still being computed/);
    const settled = () => page.waitForFunction(() => !window.__thalweg.busy && window.__thalweg.level === 'full' && document.documentElement.dataset.stale === 'off', null, { timeout: 20000 });
    await settled();
    assert.equal(await page.isDisabled('#tool-catchment'), false);
    await page.click('#bmap');
    await page.keyboard.press('x');
    await click(page, 100.5, 100);
    const first = await measured(page);
    near(first.left.slope, atan(0.25), 0.02);
    await page.evaluate(() => window.__thalweg.run({ set: 'network.prune', value: '30' }));
    await settled();
    const second = await measured(page);
    assert.deepEqual(second.line, first.line);
    near(second.left.slope, atan(0.5), 0.02);
    near(second.right.slope, atan(0.2), 0.02);
    near(second.floor.z, first.floor.z + 100, 0.1);
    await page.keyboard.press('c');
    await click(page, 40.5, 100.5);
    const catchments = [(await measured(page)).count];
    await page.evaluate(() => window.__thalweg.undo());
    await settled();
    catchments.push((await measured(page)).count);
    assert.ok(catchments.every((n) => n > 0));
    assert.equal(await page.evaluate(() => window.__thalweg.error), null);
    await page.close();
  });
});
