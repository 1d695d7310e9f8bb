// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Measuring on the page: the figures on lands of formulas against slow and obvious reckonings, then the tools in Debian's
// Chromium, by pointer, keys and touch. THALWEG_EXE names the program, whose keys the studio's page wants.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { after, before, describe, test } from 'node:test';
import { Land } from '../../web/src/land.js';
import { slopes } from '../../web/src/light.js';
import { ArcFinder, Rivers } from '../../web/src/rivers.js';
import { along, catchment, courseAt, crossings, fallAt, networkOf, outline, riverOf, riverProfile, sectionAcross, sectionPoints, sums, traverse, valley, valueOfRiver, wkt } from '../../web/src/survey.js';
import { Water } from '../../web/src/water.js';
import { barriers, launch, look, open, placeOn, set } from './browser.mjs';
import { fakeStudio, keysOf } from './fake_studio.mjs';
import { landOfFormula, valleyLand, writePage } from './made_land.mjs';

const exe = process.env.THALWEG_EXE;
const place = fs.mkdtempSync(path.join(os.tmpdir(), 'thalweg-measure-'));
after(() => fs.rmSync(place, { recursive: true, force: true }));

const close = (got, wanted, within, what = '') => assert.ok(Math.abs(got - wanted) <= within, `${what} ${got} for ${wanted}`);
const atan = (slope) => (Math.atan(slope) * 180) / Math.PI;
let seed = 11;
const random = () => (seed = (seed * 48271) % 2147483647) / 2147483647;
/** What the page makes of a scene; heights unrounded. */
function held(scene) {
  const { data, heights } = scene;
  const land = new Land(data.grid, data.heights, heights, null);
  const rivers = new Rivers(data.rivers, null, scene.lines);
  return { data, land, rivers, water: new Water(land, scene.water, false), orders: rivers.kept(0).orders, finder: new ArcFinder(rivers, data.grid) };
}
const rough = (width, height) => {
  const z = Array.from({ length: width * height }, () => 9 * random());
  return held(landOfFormula({ width, height, z: (x, y) => 3 * x + 5 * y + z[Math.floor(y) * width + Math.floor(x)] }));
};

describe('figures', () => {
  test('heights along a line are bilinear between the values, its ends and even steps among them', () => {
    const { land } = rough(40, 30);
    const centre = (c, r) => land.z[Math.min(Math.max(r, 0), 29) * 40 + Math.min(Math.max(c, 0), 39)];
    const bilinear = (x, y) => {
      const [c, r] = [Math.floor(x - 0.5), Math.floor(y - 0.5)];
      const [f, g] = [x - 0.5 - c, y - 0.5 - r];
      return centre(c, r) * (1 - f) * (1 - g) + centre(c + 1, r) * f * (1 - g) + centre(c, r + 1) * (1 - f) * g + centre(c + 1, r + 1) * f * g;
    };
    const line = [[0, 0], [13.3, 22.9], [39.7, 4.1], [40, 30]];
    const points = along(land, line);
    const length = Math.hypot(13.3, 22.9) + Math.hypot(26.4, 18.8) + Math.hypot(0.3, 25.9);
    close(points.at(-1).d, 30 * length, 1e-6);
    assert.deepEqual([points[0].x, points[0].y, points.at(-1).x, points.at(-1).y], [0, 0, 40, 30]);
    points.forEach(({ x, y, z, d }, i) => {
      close(z, bilinear(x, y), 1e-4);
      if (i) close(d - points[i - 1].d, points[1].d, 1e-6);
    });
    assert.ok(points[1].d <= 15);
  });

  test('on a plane lengths over the ground and slopes are exact, on a cone what is climbed and lost', () => {
    const plane = held(landOfFormula({ z: (x, y) => 9 * x + 12 * y })).land; // 0.3 and 0.4: 0.5 along the gradient
    const sum = sums(along(plane, [[20, 20], [50, 60]]));
    close(sum.length, 1500, 1e-6);
    close(sum.up, 750, 1e-2);
    assert.equal(sum.down, 0);
    close(sum.ground, Math.hypot(1500, 750), 1e-2);
    close(sum.steepest, atan(0.5), 1e-2);
    const cone = held(landOfFormula({ z: (x, y) => 1000 - 6 * Math.hypot(x - 100.5, y - 80.5) })).land;
    const over = sums(along(cone, [[40.5, 80.5], [140.5, 80.5]]));
    for (const [key, wanted] of [['up', 360], ['down', 240], ['high', 1000], ['low', 640], ['steepest', atan(0.2)]]) close(over[key], wanted, 0.02, key);
    const { dx, dy } = fallAt(cone, 130.5, 120.5, 3);
    close(dx, 0.6, 1e-3);
    close(dy, 0.8, 1e-3);
  });

  test('where there is no land a profile has a gap, and the sea is at its level', () => {
    const hole = landOfFormula({ width: 30, height: 20, z: (x) => (x > 10 && x < 20 ? NaN : x) });
    for (const [sea, wanted] of [[null, NaN], [{ level: -2, around: false }, -2]]) {
      const land = new Land(hole.data.grid, hole.data.heights, hole.heights, sea);
      const points = along(land, [[2, 10], [28, 10]]);
      const inside = points.filter(({ x }) => x > 11 && x < 19);
      assert.ok(inside.length > 10 && inside.every(({ z }) => Object.is(z, wanted)));
      assert.equal(sums(points).gaps, sea === null);
    }
  });

  test('a V valley has its area, widths, slopes and depth', () => {
    const { land, rivers, orders } = held(valleyLand({ fall: 0 }));
    const section = sectionAcross(land, courseAt(riverOf({ rivers, orders }, 2).line, 102, 100, 5));
    assert.deepEqual([section.x, section.ux, Math.abs(section.uy)], [100.5, -1, 0]); // to the south, right is west
    const found = valley(land, sectionPoints(land, { ...section, left: 50, right: 40 }));
    close(found.depth, 0.25 * 50 * 30, 1e-2); // east is left: the gentler side
    close(found.left.slope, atan(0.25), 1e-3);
    close(found.right.slope, atan(0.4), 1e-3);
    const width = found.depth / 0.25 + found.depth / 0.4;
    for (const { share, width: got } of found.widths) close(got, share * width, 0.02);
    close(found.area, (width * found.depth) / 2, 20);
    assert.ok(found.area > 4e5);
  });

  test('a section is at right angles to the river, also where it bends, and reaches beyond both divides', () => {
    for (const turn of [0.3, 1.2, 2.9, 4.4]) {
      const [dx, dy] = [Math.cos(turn), Math.sin(turn)];
      const line = Array.from({ length: 61 }, (_, i) => [100 + (i - 30) * dx, 80 + (i - 30) * dy]);
      const across = sectionAcross(held(landOfFormula({ z: (x) => x })).land, courseAt(line, 100.4, 80.2, 5));
      close(across.ux * dx + across.uy * dy, 0, 1e-9);
      close(dx * across.uy - dy * across.ux, 1, 1e-9); // to the right
    }
    const circle = Array.from({ length: 100 }, (_, i) => [100 + 40 * Math.cos(i / 20), 80 + 40 * Math.sin(i / 20)]);
    const { x, y, dx, dy } = courseAt(circle, ...circle[50], 5);
    close((x - 100) * dx + (y - 80) * dy, 0, 0.01);
    // Ridges at 30 and 20 cells beside the axis.
    const ridges = held(landOfFormula({ z: (u) => (u < 100.5 ? 300 - 8 * Math.abs(u - 70.5) : 200 - 8 * Math.abs(u - 120.5)) })).land;
    const { left, right } = sectionAcross(ridges, { x: 100.5, y: 80, dx: 0, dy: -1 });
    assert.ok(left > 30 && left < 40, left);
    assert.ok(right > 20 && right < 30, right);
  });

  test('a catchment is every value whose water comes by, on rough land', () => {
    const { land, water } = rough(48, 36);
    const { receivers } = water;
    const slope = slopes(land);
    const comesBy = (from, value) => {
      let length = 0;
      for (let i = from; i >= 0; i = receivers[i]) {
        if (i === value) return length;
        length += receivers[i] >= 0 && (receivers[i] % 48 !== i % 48) && Math.floor(receivers[i] / 48) !== Math.floor(i / 48) ? Math.SQRT2 : 1;
      }
      return null;
    };
    const values = [...receivers.keys()].sort((a, b) => water.areas[b] - water.areas[a]);
    for (const value of [values[0], values[3], values[20], values[200], values.at(-1)]) {
      const found = catchment(land, water, value, slope);
      const lengths = [...receivers.keys()].map((i) => comesBy(i, value));
      assert.deepEqual(Array.from(found.inside), lengths.map((l) => (l === null ? 0 : 255)));
      const those = [...receivers.keys()].filter((i) => lengths[i] !== null);
      const mean = (of) => those.reduce((sum, i) => sum + of(i), 0) / those.length;
      assert.equal(found.count, water.areas[value]);
      close(found.area, 900 * those.length, 1e-6);
      close(found.share, those.length / (48 * 36), 1e-12);
      close(found.mean, mean((i) => land.z[i]), 1e-6);
      close(found.slope, mean((i) => atan(Math.hypot(slope.east[i], slope.south[i]))), 1e-9);
      close(found.longest, 30 * Math.max(...those.map((i) => lengths[i])), 0.01);
      assert.equal(found.high, Math.max(...those.map((i) => land.z[i])));
      assert.equal(found.low, Math.min(...those.map((i) => land.z[i])));
    }
    assert.ok(water.areas[values[0]] > 100);
  });

  test('outlines enclose what is set and nothing else, and are valid', () => {
    const texts = [];
    for (const share of [0.3, 0.5, 0.7, 1]) {
      const [width, height] = [24, 17];
      const inside = Uint8Array.from({ length: width * height }, () => (random() < share ? 255 : 0));
      const polygons = outline({ width, height, cells: 1 }, inside);
      const rings = polygons.flatMap(({ outer, holes }) => [outer, ...holes]);
      for (let i = 0; i < inside.length; ++i) {
        const [x, y] = [(i % width) + 0.5, Math.floor(i / width) + 0.5];
        const cuts = rings.flatMap((ring) => ring.slice(1).map((b, k) => [ring[k], b])).filter(([a, b]) => a[0] === b[0] && a[0] > x && Math.min(a[1], b[1]) < y && y < Math.max(a[1], b[1]));
        assert.equal(cuts.length % 2 === 1, inside[i] > 0);
      }
      texts.push(wkt(polygons, { west: 0, north: 0, cell_m: 2 }), String(4 * inside.filter(Boolean).length));
    }
    execFileSync('/usr/bin/python3', ['-c', `
import sys
from osgeo import ogr
ogr.UseExceptions()
for text, area in zip(sys.argv[1::2], sys.argv[2::2]):
    shape = ogr.CreateGeometryFromWkt(text)
    assert shape.IsValid()
    assert abs(shape.Area() - float(area)) < 1e-6, (shape.Area(), area)
`, ...texts]);
  });

  test('rivers that a line crosses are found once, with what they drain there', () => {
    const here = held(valleyLand());
    const area = 200 * 160 * 900;
    const at = crossings(here.land, [[20, 80], [180, 80]], here);
    assert.deepEqual(at.map(({ arc, order }) => [arc, order]), [[2, 2]]);
    close(at[0].d, 80.5 * 30, 1e-6);
    close(at[0].area, area * (0.45 + 0.2 * 0.55), 1);
    assert.deepEqual(crossings(here.land, [[20, 50], [70, 50], [180, 50]], here).map(({ arc }) => arc), [1, 0]);
    // A vertex of the line on the river counts once.
    assert.equal(crossings(here.land, [[90, 100], [100.5, 110], [110, 110]], here).length, 1);
    // Against every segment, on a net of random lines.
    const arcs = Array.from({ length: 40 }, (_, k) => ({ id: k + 1, line: Array.from({ length: 5 }, () => [Math.round(16 * 200 * random()) / 16, Math.round(16 * 160 * random()) / 16]) }));
    const net = held(landOfFormula({ z: (x) => x, arcs }));
    const line = [[3, 150], [60.3, 20.2], [190.1, 140.7]];
    const side = ([ax, ay], [bx, by], [x, y]) => Math.sign((bx - ax) * (y - ay) - (by - ay) * (x - ax));
    let wanted = 0;
    for (const { line: river } of arcs) {
      for (let i = 1; i < river.length; ++i) {
        for (let k = 1; k < line.length; ++k) {
          wanted += side(line[k - 1], line[k], river[i - 1]) !== side(line[k - 1], line[k], river[i]) && side(river[i - 1], river[i], line[k - 1]) !== side(river[i - 1], river[i], line[k]);
        }
      }
    }
    assert.equal(crossings(net.land, line, net).length, wanted);
    assert.ok(wanted > 20);
  });

  test('a river goes from its farthest source to its outlet and never climbs', () => {
    const here = held(valleyLand());
    for (const arc of [0, 2]) {
      const { line, arcs, joins } = riverOf(here, arc);
      assert.deepEqual(arcs, [0, 2]);
      assert.deepEqual([line[0], line.at(-1)], [[100.5, 20], [100.5, 160]]);
      assert.deepEqual(joins.map(({ arc: k, order }) => [k, order]), [[1, 1]]);
    }
    assert.deepEqual(riverOf(here, 1).arcs, [1, 2]);
    const points = riverProfile(here.land, riverOf(here, 0).line);
    assert.ok(points.every(({ d, z }, i) => i === 0 || (d > points[i - 1].d && z >= points[i - 1].z)));
    close(points.at(-1).d, 140 * 30, 1e-6);
    // The axis lies in the middle of a column; the lowest beside it is a row farther down.
    const row = (y) => Math.min(159.5, Math.floor(y) + 1.5);
    points.forEach(({ y, z }) => close(z, 0.6 * (160 - row(y)), 0.65));
    assert.deepEqual(networkOf(here, { inside: null }, 2), { arcs: 3, sources: 2, order: 2 });
    assert.deepEqual(networkOf(here, { inside: null }, 0), { arcs: 1, sources: 1, order: 1 });
    // Beside the axis the value of the river is the one on it.
    assert.equal(valueOfRiver(here.land, here.water, here.rivers, 2, 101.3, 100.5) % 200, 100);
  });

  test('legs have lengths, bearings and slopes, and a closed way an area', () => {
    const { land } = held(landOfFormula({ z: (x) => 9 * x }));
    const found = traverse(land, [[20, 20], [60, 20], [60, 50], [20, 50]], true);
    assert.deepEqual(found.legs.map(({ length }) => Math.round(length)), [1200, 900, 1200, 900]);
    assert.deepEqual(found.legs.map(({ bearing }) => bearing), [90, 180, 270, 0]);
    found.legs.forEach(({ slope }, i) => close(slope, [atan(0.3), 0, -atan(0.3), 0][i], 1e-3));
    close(found.area, 40 * 30 * 900, 1e-6);
    close(found.length, 4200, 1e-6);
    close(found.ground, 1800 + 2 * Math.hypot(1200, 360), 0.01);
    close(found.rise, 0, 1e-9);
    assert.equal(traverse(land, [[20, 20], [60, 20]], false).area, null);
  });
});

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
    close(drawn.length, 70 * 30, off);
    close(drawn.up, 30 * 30 * 0.25, off);
    close(drawn.down, 40 * 30 * 0.4, off);
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
    close(clicked.length, 70 * 30, 25);
    close(clicked.down, 0.4 * 40.5 * 30, 12);
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
    close(last[0], clicked.length, 1e-3);
    close(last[1], 500000 + 30 * clicked.line[2][0], 1e-3);
    close(last[2], 5000000 - 30 * clicked.line[2][1], 1e-3);
    close(last[3], clicked.points.at(-1).z, 1e-3);
    // A river's own profile.
    await click(page, 100.5, 120);
    const river = await measured(page);
    assert.deepEqual([river.kind, river.order, river.arcs], ['river', 2, [1, 3]]);
    close(river.length, 140 * 30, 1);
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
    close(found.bearing, 90, 1e-6);
    close(found.line[0][1], found.line[1][1], 1e-6);
    close(found.left.slope, atan(0.25), 0.02);
    close(found.right.slope, atan(0.4), 0.02);
    close(found.area, (found.depth * found.depth * (1 / 0.25 + 1 / 0.4)) / 2, 0.01 * found.area);
    await spoken(page, 'Section of .* deep below the lower side');
    const [, [x, y]] = found.line;
    await page.mouse.move(...await spot(page, x, y));
    await page.mouse.down();
    await page.mouse.move(...await spot(page, 70, y), { steps: 4 });
    await page.mouse.up();
    const drawn = await measured(page);
    close(drawn.line[1][0], 70, 1);
    assert.deepEqual(drawn.line[0], found.line[0]);
    await set(page, 'section-width', 40);
    close((await measured(page)).width, 1200, 1);
    assert.match((await saved(page, 'CSV')).text, /^distance to the right \[m\],x/);
    await click(page, 40, 130); // beside rivers
    const beside = await measured(page);
    const [dx, dy] = [0.4, 0.02].map((slope) => slope / Math.hypot(0.4, 0.02));
    close((beside.line[1][0] - beside.line[0][0]) * dx + (beside.line[1][1] - beside.line[0][1]) * dy, 0, 0.05);
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
    close(found.area, areas * 900, 1e-6);
    close(found.share, areas / 32000, 1e-9);
    assert.deepEqual([found.arcs, found.sources, found.order, found.arc], [3, 2, 2, 3]);
    assert.notEqual((await look(page)).hash, plain.hash);
    await spoken(page, 'Catchment of .*% of the land');
    const { name, text } = await saved(page, 'Outline');
    const csv = path.join(place, name);
    fs.writeFileSync(csv, text);
    const { features } = JSON.parse(execFileSync('ogr2ogr', ['-f', 'GeoJSON', '/vsistdout/', csv, '-dialect', 'sqlite', '-sql', `SELECT *, ST_Area(geometry) AS shape FROM "${path.parse(name).name}"`]).toString());
    close(features[0].properties.shape, found.area, 1e-3);
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
    close(found.area, 30 * 40 * 900, 3e4);
    close(found.length, 140 * 30, 60);
    close(found.legs[0].bearing, 90, 1.5);
    close(found.legs[0].slope, -atan(0.4), 1);
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
    close(legs[0].bearing, 180 - atan(3 / 10), 0.1);
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
    close(legs[0].length, 900, 60);
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
      close((await measured(page)).bearing, 90, 1e-6);
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
        close((await measured(page)).length, 900, 40);
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
    close(first.left.slope, atan(0.25), 0.02);
    await page.evaluate(() => window.__thalweg.run({ set: 'network.prune', value: '30' }));
    await settled();
    const second = await measured(page);
    assert.deepEqual(second.line, first.line);
    close(second.left.slope, atan(0.5), 0.02);
    close(second.right.slope, atan(0.2), 0.02);
    close(second.floor.z, first.floor.z + 100, 0.1);
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
