// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// report.html as readers meet it, in Debian's Chromium. THALWEG_EXE and THALWEG_SOURCE_DIR name the program and the sources.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { after, before, describe, test } from 'node:test';
import { barriers, launch, look, open, pickCentre, set } from './browser.mjs';

const exe = process.env.THALWEG_EXE;
const sources = process.env.THALWEG_SOURCE_DIR;
const place = fs.mkdtempSync(path.join(os.tmpdir(), 'thalweg-page-'));
const pageOf = (name) => path.join(place, name, 'report.html');
const make = (name, ...args) => execFileSync(exe, ['make', ...args, '-o', path.join(place, name), '-q']);

/** Heights of a raster file as GDAL reads them. */
function heightsOf(file) {
  const raw = path.join(place, 'heights.raw');
  execFileSync('gdal_translate', ['-q', '-of', 'ENVI', '-ot', 'Float32', file, raw]);
  const bytes = fs.readFileSync(raw);
  return new Float32Array(bytes.buffer, bytes.byteOffset, bytes.length / 4);
}

/** A page with other data than thalweg gave it. */
function altered(name, change) {
  const html = fs.readFileSync(pageOf(name), 'utf8');
  const [all, head, json, tail] = html.match(/(<script type="application\/json" id="data">)(.*?)(<\/script>)/s);
  const data = JSON.parse(json);
  change(data);
  const file = path.join(place, `${name}-altered.html`);
  fs.writeFileSync(file, html.replace(all, () => head + JSON.stringify(data) + tail));
  return file;
}

let gl;
let flat;
before(async () => {
  make('dla', path.join(sources, 'samples/dla.toml'));
  make('lines', path.join(sources, 'samples/lines.toml'));
  make('small', '--set', 'grid.width=150', '--set', 'grid.height=100', '--set', 'network.dla.particles=2500', '--set', 'network.prune=6');
  [gl, flat] = await Promise.all([launch('webgl'), launch('no3d')]);
});
after(async () => {
  await gl?.close();
  await flat?.close();
  fs.rmSync(place, { recursive: true, force: true });
});

describe('samples/dla.toml with WebGL', () => {
  let seen;
  before(async () => {
    seen = await open(gl, pageOf('dla'));
  });

  test('is under 3 MB and ready in under 15 s, without a word of complaint and without any request', () => {
    const bytes = fs.statSync(pageOf('dla')).size;
    console.log(`# ${bytes} bytes, ready after ${seen.seconds} s`);
    assert.ok(bytes < 3e6);
    assert.ok(seen.seconds < 15);
    assert.deepEqual(seen.complaints, []);
    assert.equal(seen.requests.length, 1, seen.requests.join(' ')); // the file itself
  });

  test('has a WebGL 2 view and no error', async () => {
    assert.deepEqual(await seen.page.evaluate(() => [window.__thalweg.mode, window.__thalweg.error]), ['webgl2', null]);
  });

  test('shows land in more than 2000 colours and rivers on more than 1500 pixels', async () => {
    const shown = await look(seen.page);
    console.log(`# ${shown.colours} colours, ${shown.rivers} river pixels`);
    assert.ok(shown.colours > 2000);
    assert.ok(shown.rivers > 1500);
  });

  test('picks the places that it shows, in 3-D and on the map', async () => {
    for (const way of ['3-D', 'map']) {
      const off = await seen.page.evaluate(() => {
        const { project, pick } = window.__thalweg;
        const off = [];
        for (let y = 60; y < 1024; y += 101) {
          for (let x = 60; x < 1024; x += 101) {
            const at = project(x + 0.5, y + 0.5);
            const found = at && pick(at.x, at.y);
            if (found) off.push(Math.hypot(found.col - x, found.row - y), typeof found.z === 'number' ? 0 : Infinity);
          }
        }
        return off;
      });
      console.log(`# ${way}: ${off.length / 2} places, off by up to ${Math.max(...off)} cells`);
      assert.ok(off.length > 80);
      assert.ok(off.every((d) => d <= 8)); // what stands a little before a place may hide it
      assert.ok(off.filter((d) => d <= 1.5).length >= 0.9 * off.length);
      await seen.page.click('#bmap');
    }
  });

  test('names summits and outlets, with room between them', async () => {
    for (const way of ['3-D', 'map']) {
      const labels = await seen.page.evaluate(async () => (await window.__thalweg.still(), window.__thalweg.labels()));
      console.log(`# ${way}: ${labels.map(({ text }) => text).join(', ')}`);
      assert.ok(labels.length > 6);
      assert.ok(labels.some(({ text }) => /km²$/.test(text)));
      assert.ok(labels.some(({ text }) => /^[\d.]+ k?m$/.test(text)), 'a scale bar');
      const { step, index } = await seen.page.evaluate(() => window.__thalweg.contours());
      assert.equal(index % step, 0);
      const onLines = labels.filter(({ kind }) => kind === 'contour');
      assert.ok(onLines.length > 4);
      onLines.forEach(({ text }) => assert.equal(Number(text) % index, 0, `${text} on contours every ${step} m`));
      labels.forEach((a, i) => labels.slice(i + 1).forEach((b) =>
        assert.ok(a.x1 <= b.x0 || b.x1 <= a.x0 || a.y1 <= b.y0 || b.y1 <= a.y0, `${a.text} covers ${b.text}`)));
      await seen.page.click('#bmap');
    }
  });

  test('colours the land by each measure, with its legend', async () => {
    const { page } = seen;
    const modes = await page.$$eval('#colour option', (all) => all.map((o) => o.value));
    assert.deepEqual(modes, ['height', 'slope', 'aspect', 'area', 'basins', 'strahler', 'hack', 'forms', 'difference', 'none']);
    const hashes = new Set();
    for (const mode of modes.filter((m) => m !== 'difference')) {
      await page.selectOption('#colour', mode);
      hashes.add((await look(page)).hash);
      assert.notEqual(await page.textContent('#legend'), '');
    }
    assert.equal(hashes.size, modes.length - 1);
    // The areas that the page reckons from its ways of water are those of area_d8.
    const most = await page.evaluate(() => window.__thalweg.water.areas.reduce((a, b) => Math.max(a, b)));
    const stated = await page.evaluate(() => Math.max(...JSON.parse(document.getElementById('data').textContent).rivers.arcs.ds_area));
    assert.ok(most * 900 >= 0.999 * stated, `${most * 900} ${stated}`);
    const other = await page.evaluate(() => window.__thalweg.heights().length);
    assert.equal(other, 1024 * 1024);
    await page.setInputFiles('#other', pageOf('dla'));
    await page.waitForFunction(() => document.getElementById('colour').value === 'difference');
    assert.match(await page.textContent('#legend'), /this less the other/);
    await page.setInputFiles('#other', pageOf('small'));
    await page.waitForFunction(() => !document.getElementById('message').hidden);
    assert.match(await page.textContent('#message'), /another grid/);
    await page.evaluate(() => (document.getElementById('message').hidden = true));
    await page.selectOption('#colour', 'height');
  });

  test('comes back when the graphics device was lost', async () => {
    const fresh = await open(gl, pageOf('dla'));
    const first = await look(fresh.page);
    await fresh.page.evaluate(async () => {
      const lose = document.querySelector('#view canvas').getContext('webgl2').getExtension('WEBGL_lose_context');
      lose.loseContext();
      await new Promise((done) => setTimeout(done, 300));
      if (document.getElementById('message').hidden) throw new Error('nothing is said');
      lose.restoreContext();
      await new Promise((done) => setTimeout(done, 500));
    });
    const again = await look(fresh.page);
    assert.ok(await fresh.page.isHidden('#message'));
    assert.ok(again.colours > 0.9 * first.colours && again.rivers > 0.9 * first.rivers, JSON.stringify([first, again]));
    await fresh.page.close();
  });

  test('keeps fewer links and draws less river as L rises from 20 to 160', async () => {
    const kept = [];
    const rivers = [];
    for (let L = 20; L <= 160; L += 20) {
      await set(seen.page, 'L', L);
      kept.push(await seen.page.evaluate(() => window.__thalweg.kept));
      rivers.push((await look(seen.page)).rivers);
    }
    console.log(`# kept ${kept.join(' ')}; river pixels ${rivers.join(' ')}`);
    const survives = await seen.page.evaluate(() => JSON.parse(document.getElementById('data').textContent).rivers.arcs.survives);
    kept.forEach((n, i) => assert.equal(n, survives.filter((s) => s === null || s >= 20 * (i + 1)).length));
    assert.ok(kept.every((n, i) => i === 0 || n <= kept[i - 1]));
    assert.ok(kept.at(-1) < kept[0]);
    assert.ok(rivers.every((n, i) => i === 0 || n <= 1.02 * rivers[i - 1])); // a higher order may be drawn thinner, never wider
    assert.ok(rivers.at(-1) < 0.7 * rivers[0]);
    await set(seen.page, 'L', 20);
  });

  test('holds the heights of dem.tif to (max − min) / 65535', async () => {
    const wanted = heightsOf(path.join(place, 'dla/dem.tif'));
    const given = await seen.page.evaluate(() => Array.from(window.__thalweg.heights()));
    assert.equal(given.length, wanted.length);
    let [low, high, off] = [Infinity, -Infinity, 0];
    for (const z of wanted) [low, high] = [Math.min(low, z), Math.max(high, z)];
    given.forEach((z, i) => (off = Math.max(off, Math.abs(z - wanted[i]))));
    console.log(`# greatest difference ${off} m, ${(high - low) / 65535} m allowed`);
    assert.ok(off <= (high - low) / 65535);
  });

  test('has the network that network.gpkg has', async () => {
    const arcs = await seen.page.evaluate(() => JSON.parse(document.getElementById('data').textContent).rivers.arcs);
    const csv = execFileSync('ogr2ogr', ['-f', 'CSV', '/vsistdout/', path.join(place, 'dla/network.gpkg'), '-sql',
      'SELECT arc_id, ds_arc, strahler, hack, survives, length FROM arcs ORDER BY arc_id']).toString().trim().split('\n').slice(1);
    assert.equal(csv.length, arcs.id.length);
    csv.forEach((row, k) => {
      const [id, ds, strahler, hack, survives, length] = row.replaceAll('"', '').split(',').map(Number);
      assert.deepEqual([arcs.id[k], arcs.ds[k], arcs.strahler[k], arcs.hack[k]], [id, ds, strahler, hack]);
      assert.ok(Math.abs((arcs.survives[k] ?? -1) - survives) < 1e-3, `${arcs.survives[k]} ${survives}`);
      assert.ok(Math.abs(arcs.length[k] - length) < 0.01);
    });
  });

  test('orders the kept arcs as thalweg does when it prunes at that length', async () => {
    const lengthByOrder = (arcs, orders) => {
      const sums = [];
      orders.forEach((order, k) => (sums[order] = (sums[order] ?? 0) + (order > 0 ? arcs.length[k] : 0)));
      return sums.slice(1);
    };
    const arcsOf = (page) => page.evaluate(() => JSON.parse(document.getElementById('data').textContent).rivers.arcs);
    const arcs = await arcsOf(seen.page);
    assert.deepEqual(await seen.page.evaluate(() => window.__thalweg.orders()), arcs.strahler);
    for (const L of [45, 90]) {
      make(`pruned${L}`, path.join(sources, 'samples/dla.toml'), '--set', `network.prune=${L}`);
      const { page } = await open(gl, pageOf(`pruned${L}`), { query: '?seg=15' });
      const pruned = await arcsOf(page);
      const wanted = lengthByOrder(pruned, pruned.strahler);
      await page.close();
      await set(seen.page, 'L', L);
      const got = lengthByOrder(arcs, await seen.page.evaluate(() => window.__thalweg.orders()));
      assert.equal(got.length, wanted.length);
      // make also cuts the corners where a branch was, a few cells on the whole; the page shows what it holds.
      got.forEach((length, i) =>
        assert.ok(length >= wanted[i] - 1 && length < 1.01 * wanted[i], `L = ${L}: ${got} for ${wanted}`),
      );
    }
    await set(seen.page, 'L', 20);
  });

  test('answers the keyboard', async () => {
    const { page } = seen;
    await page.focus('#view canvas');
    let last = (await look(page)).hash;
    for (const key of ['ArrowLeft', 'ArrowUp', '+', 'Shift+ArrowRight', 'm', '-', 'ArrowDown', 'm', '-', '0']) {
      await page.keyboard.press(key);
      const { hash } = await look(page);
      assert.notEqual(hash, last, key);
      last = hash;
    }
    await page.keyboard.press('p');
    assert.match(await page.textContent('#point'), /cell \d+, \d+ · \d+\.\d m.*slope \d.*drains .* km² · .* km to the outlet/s);
    await page.focus('#L');
    await page.keyboard.press('ArrowRight');
    assert.match(await page.textContent('#Lout'), /^21 cells/);
    await page.keyboard.press('ArrowLeft');
  });

  test('every control changes the view', async () => {
    const { page } = seen;
    let { hash: last } = await look(page);
    for (const [id, value] of [['exaggeration', 8], ['contour', 1], ['sun', 10], ['altitude', 1]]) {
      await set(page, id, value);
      const { hash } = await look(page);
      assert.notEqual(hash, last, id);
      last = hash;
    }
    for (const id of ['show-rivers', 'show-contours', 'show-rivers']) {
      await page.click(`#${id}`);
      const { hash } = await look(page);
      assert.notEqual(hash, last, id);
      last = hash;
    }
  });

  test('names the arc under the pointer, marks its way to the outlet, and saves the picture', async () => {
    const fresh = await open(gl, pageOf('dla'));
    const { page } = fresh;
    await page.click('#bmap');
    // A vertex in the middle of the main stem, on the map.
    const at = await page.evaluate(() => {
      const { clientWidth: w, clientHeight: h } = document.querySelector('#view canvas');
      for (let y = 0.2; y < 0.8; y += 0.01) {
        for (let x = 0.2; x < 0.8; x += 0.005) {
          const found = window.__thalweg.pick(x * w, y * h);
          if (found?.arc?.hack === 1) return [x * w, y * h, found.arc.id];
        }
      }
      return null;
    });
    assert.ok(at);
    const box = await page.locator('#view canvas').first().boundingBox();
    await page.mouse.move(box.x + at[0], box.y + at[1]);
    assert.match(await page.textContent('#point'), new RegExp(`arc ${at[2]}: order`));
    const before_ = (await look(page)).hash;
    await page.mouse.click(box.x + at[0], box.y + at[1]);
    assert.notEqual((await look(page)).hash, before_);
    const [download] = await Promise.all([page.waitForEvent('download'), page.click('#bpicture')]);
    const png = fs.readFileSync(await download.path());
    assert.equal(png.subarray(1, 4).toString(), 'PNG');
    assert.ok(png.length > 50000);
    assert.deepEqual(fresh.complaints, []);
    await page.close();
  });

  test('links the profile with the land, both ways', async () => {
    const { page } = seen;
    await page.click('#bhome');
    const labelled = () => page.evaluate(async () => {
      await window.__thalweg.still();
      return document.querySelector('#view canvas.labels').toDataURL();
    });
    const before_ = await labelled();
    await page.focus('#sections [role=slider]');
    for (let k = 0; k < 5; ++k) await page.keyboard.press('PageUp');
    assert.notEqual(await labelled(), before_); // a ring on the river
    await page.keyboard.press('Escape');
    assert.equal(await labelled(), before_);
    // A place of the main stem that is in sight.
    const at = await page.evaluate(() => {
      const { points } = JSON.parse(document.getElementById('data').textContent).profiles[0];
      for (const [, , x, y] of points) {
        const found = window.__thalweg.project(x, y);
        if (found && window.__thalweg.pick(found.x, found.y)?.arc?.hack === 1) return found;
      }
      return null;
    });
    assert.ok(at);
    const box = await page.locator('#view canvas').first().boundingBox();
    await page.mouse.move(box.x + at.x, box.y + at.y);
    await page.waitForSelector('#sections [role=slider] .tip', { state: 'visible' });
    await page.mouse.move(0, 0);
  });

  test('shows diagrams, laws, statistics, checks, times, command and recipe', async () => {
    const { page } = seen;
    const heads = await page.$$eval('#panel h2', (all) => all.map((e) => e.textContent));
    assert.deepEqual(heads.filter((head) => head !== 'Notes'),
      ['Long profile', 'Hypsometry', 'Increment', 'Network laws', 'Relief beside reference DEMs', 'Targets and results', 'Make it again']);
    const text = await page.textContent('#panel');
    for (const word of ['R_B', 'R_L', 'R_A', 'concavity', 'Hack', 'Tokunaga', 'natural range', 'Strahler 1964', 'Big Tujunga', 'Jacksboro', 'concavity θ of the DEM’s rivers', 'Geomorphons', 'footslope', 'checks passed', 'uphill arcs', 'stages', 'thalweg make', 'particles = 100000', 'rise_fall']) assert.ok(text.includes(word), word);
    const paths = await page.$$eval('#panel path', (all) => all.map((e) => e.getAttribute('d')));
    assert.ok(paths.length > 6);
    assert.ok(paths.every((d) => !d.includes('NaN') && !d.includes('Infinity')));
  });

  test('has no serious barrier, light, dark and on a phone, where nothing overflows', async () => {
    for (const context of [{ colorScheme: 'light' }, { colorScheme: 'dark' }, { colorScheme: 'light', viewport: { width: 360, height: 740 } }]) {
      const { page, complaints } = await open(gl, pageOf('dla'), { query: '?aa=0&seg=63', ...context });
      await page.$$eval('details', (all) => all.forEach((e) => (e.open = true)));
      assert.deepEqual(await barriers(page), []);
      assert.deepEqual(complaints, []);
      const wide = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
      assert.ok(wide <= 0, `${wide} px too wide`);
      await page.close();
    }
  });
});

describe('an island', () => {
  test('lies in water where its mask says sea, in 3-D, on the map and without WebGL', async () => {
    make('island', path.join(sources, 'samples/island.toml'), '--set', 'grid.width=300', '--set', 'grid.height=300', '--set', 'network.prune=20');
    for (const browser of [gl, flat]) {
      const { page, complaints } = await open(browser, pageOf('island'));
      for (const way of browser === gl ? ['3-D', 'map'] : ['plain']) {
        await look(page);
        const { sea, land, wrong } = await page.evaluate(() => {
          const { project, heights } = window.__thalweg;
          const shown = document.querySelector('#view canvas');
          const copy = new OffscreenCanvas(shown.width, shown.height).getContext('2d');
          copy.drawImage(shown, 0, 0);
          const scale = shown.width / shown.clientWidth;
          const { data } = copy.getImageData(0, 0, shown.width, shown.height);
          const z = heights();
          const found = { sea: 0, land: 0, wrong: 0 };
          for (let r = 6; r < 294; r += 6) {
            for (let c = 6; c < 294; c += 6) {
              const known = [-4, 0, 4].flatMap((dy) => [-4, 0, 4].map((dx) => !Number.isNaN(z[(r + dy) * 300 + c + dx])));
              if (known.some((k) => k !== known[0])) continue; // the shore
              const at = project(c + 0.5, r + 0.5);
              if (!at) continue;
              const k = 4 * (Math.round(at.y * scale) * shown.width + Math.round(at.x * scale));
              const [red, blue] = [data[k], data[k + 2]];
              const wet = blue - red > 12;
              if (known[0]) found.land += 1;
              else found.sea += 1;
              if (known[0] ? wet && blue - red < 60 : !wet) found.wrong += 1; // rivers are bluer than the sea
            }
          }
          return found;
        });
        console.log(`# ${way}: ${sea} places at sea, ${land} on land, ${wrong} of another colour`);
        assert.ok(sea > 300 && land > 300);
        assert.ok(wrong <= 0.03 * (sea + land));
        if (browser === gl && way === '3-D') await page.click('#bmap');
      }
      assert.deepEqual(complaints, []);
      await page.close();
    }
  });
});

describe('without WebGL', () => {
  test('a map of land and rivers is drawn, pruned and picked', async () => {
    const { page, complaints, seconds } = await open(flat, pageOf('dla'));
    console.log(`# ready after ${seconds} s`);
    assert.equal(await page.evaluate(() => window.__thalweg.mode), '2d');
    assert.equal(await page.evaluate(() => window.__thalweg.error), null);
    const whole = await look(page);
    assert.ok(whole.colours > 2000 && whole.rivers > 1500, JSON.stringify(whole));
    await set(page, 'L', 160);
    assert.ok((await look(page)).rivers < 0.7 * whole.rivers);
    const at = await pickCentre(page);
    assert.ok(Math.hypot(at.col - 511.5, at.row - 511.5) <= 2);
    const before_ = (await look(page)).hash;
    await page.mouse.move(300, 300);
    await page.mouse.wheel(0, -400);
    assert.notEqual((await look(page)).hash, before_);
    assert.deepEqual(await barriers(page), []);
    assert.deepEqual(complaints, []);
    await page.close();
  });
});

describe('other land', () => {
  const shows = async (browser, file, check) => {
    const { page, complaints } = await open(browser, file);
    assert.equal(await page.evaluate(() => window.__thalweg.error), null);
    await check?.(page);
    assert.deepEqual(complaints, []);
    await page.close();
  };

  test('real rivers', () => shows(gl, pageOf('lines'), async (page) => assert.ok((await look(page)).rivers > 800)));

  test('a network without a surface', async () => {
    fs.writeFileSync(path.join(place, 'bare.toml'), '[network]\nprune = 6\n[network.dla]\nparticles = 3000\n');
    make('bare', path.join(place, 'bare.toml'));
    for (const browser of [gl, flat]) await shows(browser, pageOf('bare'), async (page) => assert.ok((await look(page)).rivers > 300));
  });

  test('holes', async () => {
    const grid = ['-q', '-srcwin', '0', '0', '150', '100', '-ot', 'Byte', '-scale', '0', '200', '1', '1'];
    const all = path.join(place, 'all.tif');
    execFileSync('gdal_translate', [...grid, path.join(place, 'small/dem.tif'), all]);
    // Corners in which no river runs are left out.
    const mask = path.join(place, 'mask.tif');
    execFileSync('python3', ['-c', `
from osgeo import gdal
import sys
d = gdal.Open(sys.argv[1]); n = gdal.Open(sys.argv[2]).ReadAsArray()
out = gdal.GetDriverByName('GTiff').CreateCopy(sys.argv[3], d)
a = out.ReadAsArray(); a[:] = 1
for rows, cols in ((slice(0, 12), slice(0, 12)), (slice(-12, None), slice(-12, None))):
    if not n[rows, cols].any(): a[rows, cols] = 0
assert (a == 0).any()
out.GetRasterBand(1).WriteArray(a)
`, all, path.join(place, 'small/network.tif'), mask], { env: { ...process.env, PATH: `/usr/bin:${process.env.PATH}` } });
    make('holes', path.join(place, 'small/recipe.toml'), '--set', `surface.mask=${mask}`);
    for (const browser of [gl, flat]) {
      await shows(browser, pageOf('holes'), async (page) => {
        const given = await page.evaluate(() => Array.from(window.__thalweg.heights()));
        const dem = path.join(place, 'holes/dem.tif');
        const wanted = heightsOf(dem);
        const { noDataValue } = JSON.parse(execFileSync('gdalinfo', ['-json', dem])).bands[0];
        let holes = 0;
        given.forEach((z, i) => {
          const hole = wanted[i] === noDataValue;
          holes += hole;
          assert.equal(Number.isNaN(z), hole);
        });
        assert.ok(holes > 100);
      });
    }
  });

  test('any raster by thalweg draw: holes, one cell, one row, level, geographic, 20000 x 20000', async () => {
    execFileSync('/usr/bin/python3', ['-c', `
import sys
import numpy
from osgeo import gdal, osr
gdal.UseExceptions()
def save(name, z, frame=(500000, 30, 0, 5000000, 0, -30), epsg=32631):
    out = gdal.GetDriverByName('GTiff').Create(sys.argv[1] + '/' + name + '.tif', z.shape[1], z.shape[0], 1, gdal.GDT_Float32)
    reference = osr.SpatialReference()
    reference.ImportFromEPSG(epsg)
    out.SetProjection(reference.ExportToWkt())
    out.SetGeoTransform(frame)
    out.GetRasterBand(1).SetNoDataValue(-9999)
    out.GetRasterBand(1).WriteArray(numpy.where(numpy.isnan(z), -9999, z))
y, x = numpy.mgrid[0:90, 0:120]
hill = 300 * numpy.exp(-((x - 60) ** 2 + (y - 40) ** 2) / 900.0) + x
save('hill', hill)
save('gaps', numpy.where((x + y) % 7 == 0, numpy.nan, hill))
save('cell', hill[:1, :1])
save('row', hill[:1, :])
save('level', 0 * hill + 8848)
save('globe', hill, (3, 0.001, 0, 45, 0, -0.001), 4326)
save('square', hill[:80, :80])
gdal.Translate(sys.argv[1] + '/large.vrt', sys.argv[1] + '/square.tif', width=20000, height=20000)
`, place]);
    for (const [name, note] of [['gaps.tif'], ['cell.tif'], ['row.tif'], ['level.tif'], ['globe.tif', /UTM zone 31N/], ['large.vrt', /means of 5x5 cells/]]) {
      const file = path.join(place, `${name}.html`);
      execFileSync(exe, ['draw', path.join(place, name), '-o', file, '-q']);
      for (const browser of [gl, flat]) {
        await shows(browser, file, async (page) => {
          assert.ok((await look(page)).colours > 1, name);
          assert.equal(await page.isVisible('#L'), false); // nothing to prune
          const at = await pickCentre(page);
          assert.ok(name === 'gaps.tif' || typeof at.z === 'number', `${name}: ${JSON.stringify(at)}`);
          if (note) assert.match(await page.textContent('#sections'), note);
        });
      }
    }
  });

  test('one height, and one cell', async () => {
    for (const browser of [gl, flat]) {
      await shows(browser, altered('small', (data) => (data.heights.max = data.heights.min)));
      await shows(browser, altered('small', (data) => {
        data.grid.width = data.grid.height = 1;
        data.heights = null;
        for (const key of Object.keys(data.rivers.arcs)) data.rivers.arcs[key] = [];
        data.profiles = [];
        data.relief = null;
        data.laws = { rows: [], support: null, orders: [], dem_orders: [], hack: {}, concavity: {} };
      }));
    }
  });

  test('ridges are drawn and can be hidden', async () => {
    for (const browser of [gl, flat]) {
      // The last arcs' lines are handed over to be ridges.
      await shows(browser, altered('small', (data) => {
        const { arcs } = data.rivers;
        data.ridges = { n: [arcs.n.at(-1)] };
        for (const key of Object.keys(arcs)) arcs[key].pop();
        arcs.ds = arcs.ds.map((ds) => (arcs.id.includes(ds) ? ds : 0));
      }), async (page) => {
        const with_ = (await look(page)).hash;
        await page.click('#show-ridges');
        assert.notEqual((await look(page)).hash, with_);
      });
    }
  });

  test('a hostile title and CRS do nothing', async () => {
    fs.writeFileSync(path.join(place, 'title.toml'), '[grid]\nwidth = 90\nheight = 90\n[network]\nprune = 4\n[network.dla]\nparticles = 1200\n[surface]\n' +
      '[output]\ntitle = "</title></script><script>window.hurt=1</script><img src=x onerror=window.hurt=1> 河谷 @@DATA@@ $& @@LINES@@"\n');
    make('title', path.join(place, 'title.toml'));
    await shows(gl, pageOf('title'), async (page) => {
      assert.equal(await page.evaluate(() => window.hurt), undefined);
      assert.match(await page.textContent('#title'), /^<\/title><\/script>.*河谷 @@DATA@@ \$& @@LINES@@$/);
      assert.equal(await page.title(), await page.textContent('#title'));
    });
  });

  test('a damaged page says so', async () => {
    const html = fs.readFileSync(pageOf('small'), 'utf8');
    const file = path.join(place, 'damaged.html');
    fs.writeFileSync(file, html.replace(/(id="heights">.{200})/s, '$1AAAA'));
    const { page } = await open(gl, file);
    assert.notEqual(await page.evaluate(() => window.__thalweg.error), null);
    assert.match(await page.textContent('#message'), /cannot be shown/);
    await page.close();
  });
});
