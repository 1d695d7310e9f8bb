// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The panel of report.html by itself: with data that thalweg wrote, altered where a test says so, and actions that are
// only noted down. THALWEG_EXE names the program.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import { createRequire } from 'node:module';
import os from 'node:os';
import path from 'node:path';
import { after, before, describe, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { barriers, launch, open, web } from './browser.mjs';
import { valleyLand } from '../../web/test/made_land.mjs';
import { madeAgainst, writePage } from './made_page.mjs';

const place = fs.mkdtempSync(path.join(os.tmpdir(), 'thalweg-panel-'));
const vite = createRequire(path.join(web, 'package.json')).resolve('vite');
let browser;
let data;
let bundle;

/** The panel's script and style as a page of their own would have them. */
async function built() {
  const { build } = await import(pathToFileURL(vite));
  const [{ output }] = await build({
    configFile: false, root: web, logLevel: 'error',
    build: { write: false, minify: false, lib: { entry: path.join(web, 'src/panel.js'), formats: ['iife'], name: 'Panel', cssFileName: 'panel' } },
  });
  const part = (ends) => output.find(({ fileName }) => fileName.endsWith(ends));
  return { script: part('.js').code, style: fs.readFileSync(path.join(web, 'src/style.css'), 'utf8') + part('.css').source };
}

/** A page with the panel alone; `calls` of it are what the panel asked of the view. */
async function shown(change = () => {}, { theme = 'light', ...context } = {}) {
  const altered = structuredClone(data);
  change(altered);
  const page = await browser.newPage({ viewport: { width: 400, height: 900 }, ...context });
  const complaints = [];
  page.on('pageerror', (error) => complaints.push(String(error)));
  await page.setContent(`<!doctype html><html lang="en" data-theme="${theme}"><title>panel</title><style>${bundle.style} body { display: block }</style>
    <main><h1>panel</h1><div id="verdict"></div><div id="ledger"></div><div id="sections"></div></main>`);
  await page.addScriptTag({ content: bundle.script.replace('var Panel', 'window.Panel') });
  await page.evaluate((json) => {
    window.calls = [];
    const note = (name) => (...at) => window.calls.push([name, ...at]);
    const [verdict, ledger, sections] = ['verdict', 'ledger', 'sections'].map((id) => document.getElementById(id));
    window.panel = window.Panel.fillPanel({ verdict, ledger, sections }, JSON.parse(json), { flyTo: note('flyTo'), point: note('point'), unpoint: note('unpoint') });
  }, JSON.stringify(altered));
  const take = () => page.evaluate(() => window.calls.splice(0));
  const close = async () => {
    assert.deepEqual(complaints, []);
    const marks = await page.$$eval('path, circle, rect, line, text', (all) => all.flatMap((e) => [...e.attributes].map((a) => a.value)));
    assert.ok(marks.length > 0 && marks.every((text) => !/NaN|Infinity|undefined/.test(text)));
    const words = await page.$$eval('#sections, #verdict, #ledger', (all) => all.flatMap((e) => {
      const texts = document.createTreeWalker(e, NodeFilter.SHOW_TEXT);
      return Array.from({ length: 1e5 }, () => texts.nextNode()?.data).filter(Boolean);
    }));
    for (const text of words) assert.doesNotMatch(text, /NaN|Infinity|undefined|\[object|^(null|false)$/);
    await page.close();
  };
  return { page, take, close, data: altered };
}

before(async () => {
  execFileSync(process.env.THALWEG_EXE, ['make', '--set', 'grid.width=300', '--set', 'grid.height=250', '-o', place, '-q']);
  const html = fs.readFileSync(path.join(place, 'report.html'), 'utf8');
  data = JSON.parse(html.match(/<script type="application\/json" id="data">(.*?)<\/script>/s)[1]);
  [browser, bundle] = await Promise.all([launch('no3d'), built()]);
});
after(async () => {
  await browser?.close();
  fs.rmSync(place, { recursive: true, force: true });
});

describe('verdict', () => {
  test('checks that passed are one closed line', async () => {
    const { page, close } = await shown();
    assert.equal(await page.innerText('#verdict'), `✓ ${data.checks.length} checks passed`);
    await page.click('#verdict summary');
    assert.match(await page.innerText('#verdict'), /None of: .*depressions/);
    await close();
  });

  test('a failed check is open, says what was found, and shows where', async () => {
    const { page, take, close } = await shown((d) => {
      Object.assign(d.checks.find((c) => c.name === 'depressions'), { value: 2, ok: false });
      d.findings = { count: 2, shown: [{ kind: 'depression', text: 'a deep one', at: [12.5, 30.5] }, { kind: 'depression', text: 'one nowhere', at: null }, { kind: 'other', text: 'another', at: [1, 1] }] };
    });
    assert.equal(await page.innerText('#verdict > details > summary'), `✗ 1 of ${data.checks.length} checks failed`);
    const failure = await page.innerText('.failures');
    assert.match(failure, /depressions: 2, allowed ≤ 0/);
    assert.match(failure, /a deep one/);
    assert.match(failure, /one nowhere/);
    assert.doesNotMatch(failure, /another/);
    assert.equal(await page.locator('.failures button').count(), 1);
    await page.locator('.failures button').focus();
    await page.keyboard.press('Enter');
    assert.deepEqual(await take(), [['flyTo', 12.5, 30.5], ['point', 12.5, 30.5]]);
    await close();
  });

  test('warnings stand first, with what to do and where', async () => {
    const { page, close } = await shown((d) => {
      d.warnings = { count: 2, shown: [{ kind: 'filled_heights', text: '1 of 3 lines lack heights', remedy: 'Give them some', at: [3, 4] }, { kind: 'texture_missed', text: 'too smooth', remedy: '', at: null }] };
    });
    assert.equal(await page.innerText('#verdict > details:first-child > summary'), '! 2 warnings');
    assert.match(await page.innerText('.warnings'), /1 of 3 lines lack heights\. Give them some\. Show\s+too smooth/);
    assert.equal(await page.locator('.warnings button').count(), 1);
    await close();
  });

  test('none without checks', async () => {
    const { page, close } = await shown((d) => Object.assign(d, { checks: [], warnings: { count: 0, shown: [] } }));
    assert.equal(await page.innerText('#verdict'), '');
    await close();
  });
});

describe('ledger', () => {
  const given = [['read', 100, 'km'], ['left out: duplicates', 1, 'km'], ['left out: canals and others', 9.5, 'km'], ['in the network', 90, 'km'],
    ['added where ends were joined', 0.5, 'km'], ['reversed', 8, 'km'], ['ends moved by up to', 12, 'm'], ['within a factor of 2', 94, '% of arcs']];

  test('its bar holds the whole length, the network first and what was left out by its length', async () => {
    const { page, close } = await shown((d) => (d.given = given));
    const bars = await page.$$eval('.ledger-bar rect', (all) => all.map((e) => ['x', 'width'].map((name) => parseFloat(e.getAttribute(name)))));
    assert.equal(bars.length, 3);
    bars.forEach(([x], i) => assert.ok(Math.abs(x - bars.slice(0, i).reduce((sum, [, width]) => sum + width, 0)) < 0.01));
    assert.ok(Math.abs(bars.at(-1)[0] + bars.at(-1)[1] - 100) < 0.01);
    const text = (await page.innerText('#ledger')).replace(/\s/g, ' ');
    assert.match(text, /100 km of rivers given: 89.6 % in the network, reversed 8 km, ends moved by up to 12 m/);
    assert.match(text, /left out: canals and others 9.5 km.*duplicates 1 km/s);
    await page.click('#ledger summary');
    assert.match(await page.innerText('#ledger table'), /within a factor of 2\s+94\s+% of arcs/);
    await close();
  });

  test('coastlines are no rivers', async () => {
    const { page, close } = await shown((d) => (d.given = [['read', 100, 'km'], ['left out: coastlines', 40, 'km'], ['in the network', 60, 'km']]));
    assert.equal(await page.locator('.ledger-bar').count(), 0);
    assert.match((await page.innerText('#ledger')).replace(/\s/g, ' '), /60 km of rivers given beside 40 km of coastlines: 100 % in the network/);
    await close();
  });

  test('no bar where all is in the network, and nothing without a file', async () => {
    const whole = await shown((d) => (d.given = [['read', 5, 'km'], ['in the network', 5, 'km']]));
    assert.equal(await whole.page.locator('.ledger-bar').count(), 0);
    assert.match((await whole.page.innerText('#ledger')).replace(/\s/g, ' '), /5 km of rivers given: 100 % in the network/);
    await whole.close();
    const { page, close } = await shown();
    assert.equal(await page.innerText('#ledger'), '');
    await close();
  });
});

describe('profile', () => {
  /** A stem of 10 km that falls by 1 %, with a step of 100 m from 5 to 4.9 km. */
  const stepped = (d) => {
    const points = Array.from({ length: 201 }, (_, i) => 10000 - 50 * i).map((s) => [s, 0.01 * s + 100 * Math.min(1, Math.max(0, (s - 4900) / 100)), s / 100, 40]);
    d.profiles = [{ basin: 1, points }, { basin: 4, points: [[900, 50, 5, 5], [0, 10, 6, 9]] }];
    d.rivers.arcs = { ...d.rivers.arcs, basin: [1, 1, 4], hack: [1, 2, 1] };
  };
  const field = (page) => page.locator('.plot').first();

  test('a reading under the pointer is marked on the land', async () => {
    const { page, take, close } = await shown(stepped);
    const box = await field(page).boundingBox();
    await page.mouse.move(box.x + box.width / 2, box.y + 60);
    const [[name, x, y]] = await take();
    assert.equal(name, 'point');
    assert.ok(x > 35 && x < 65 && y === 40, `${x}, ${y}`);
    assert.match(await field(page).locator('.tip').innerText(), /km\s.*m/s);
    await page.mouse.move(box.x + box.width / 2, 5);
    assert.deepEqual((await take()).at(-1), ['unpoint']);
    assert.equal(await field(page).locator('.tip').isVisible(), false);
    await close();
  });

  test('arrow keys move the reading', async () => {
    const { page, take, close } = await shown(stepped);
    await field(page).focus();
    const keys = { ArrowRight: [0, 40], ArrowUp: [0.5, 40], PageUp: [10.5, 40], ArrowLeft: [10, 40], End: [100, 40], ArrowDown: [99.5, 40], Home: [0, 40] };
    for (const [key, at] of Object.entries(keys)) {
      await page.keyboard.press(key);
      assert.deepEqual(await take(), [['point', ...at]], key);
    }
    assert.match(await field(page).getAttribute('aria-valuetext'), /^0\u00a0km, 0\u00a0m$/);
    await page.keyboard.press('Escape');
    assert.deepEqual(await take(), [['unpoint']]);
    await close();
  });

  test('a step is a knickpoint, shown and flown to; an even slope has none', async () => {
    const { page, take, close } = await shown(stepped);
    assert.equal(await page.locator('.flag').count(), 1);
    const link = page.locator('.link');
    assert.match(await link.innerText(), /^(4.9|5)\skm$/);
    await link.click();
    const [[name, x]] = await take();
    assert.equal(name, 'flyTo');
    assert.ok(x >= 49 && x <= 51);
    await page.selectOption('#stem', '1');
    assert.equal(await page.locator('.flag').count(), 0);
    await close();
  });

  test('its stems can be chosen, and the land’s pointer is read on the stem shown', async () => {
    const { page, take, close } = await shown(stepped);
    assert.deepEqual((await page.locator('#stem option').allInnerTexts()), ['main stem, 10 km', 'basin 4, 900 m']);
    const hover = async (...at) => {
      await page.evaluate((args) => window.panel.hover(...args), at);
      return (await field(page).locator('.tip').isVisible()) ? (await field(page).locator('.tip').innerText()).replace(/\s+/g, ' ') : null;
    };
    assert.equal(await hover(30.1, 41, 0), '3 km 30 m');
    assert.equal(await hover(30.1, 41, 1), null); // a tributary
    assert.equal(await hover(5, 5, 2), null); // another basin
    await page.selectOption('#stem', '1');
    assert.match(await page.innerText('figcaption >> nth=0'), /basin 4/);
    assert.equal(await hover(5, 5, 2), '900 m 50 m');
    assert.equal(await hover(null, null, -1), null);
    assert.deepEqual(await take(), []);
    await close();
  });

  test('no choice of one stem, and no profile without rivers', async () => {
    const one = await shown((d) => d.profiles.splice(1));
    assert.equal(await one.page.locator('#stem').count(), 0);
    await one.close();
    const none = await shown((d) => {
      d.profiles = [];
      d.laws = { rows: [], support: null, orders: [], dem_orders: [], hack: {}, concavity: {} };
    });
    assert.doesNotMatch(await none.page.innerText('#sections'), /Long profile|Network laws/);
    await none.page.evaluate(() => window.panel.hover(1, 1, 0));
    await none.close();
  });
});

describe('figures', () => {
  test('laws lie where their ranges say, and beyond the strip as a triangle', async () => {
    const { page, close } = await shown((d) => {
      const row = (value, nature) => ({ key: 'k', name: 'law', unit: '', network: { value, note: '' }, dem: null, nature, source: 'S' });
      d.laws.rows = [row(3, [2, 4]), row(2, [2, 4]), row(90, [2, 4]), row(10, [1, 100]), row(null, [2, 4]), row(5, null)];
      d.relief = null;
    });
    const strips = await page.$$eval('.strip', (all) => all.map((e) => [...e.querySelectorAll('svg')].map((dot) => `${dot.getAttribute('x')} ${dot.firstChild.getAttribute('class')}`).join()));
    assert.deepEqual(strips.slice(0, 6), ['50.00% s0', '30.00% s0', '97.00% beyond s0', '50.00% s0', '', '70.00% s0']);
    const words = await page.$$eval('.strip', (all) => all.map((e) => e.getAttribute('aria-label')));
    assert.deepEqual(words.slice(0, 3), ['natural range 2–4, network within it', 'natural range 2–4, network within it', 'natural range 2–4, network above it']);
    await close();
  });

  test('one stream, equal values and wide ones fit their axes', async () => {
    for (const [streams, metres] of [[1, 3000], [3, 30], [3e6, 1e-3]]) {
      const { page, close } = await shown((d) => {
        d.laws.orders = [{ order: 1, streams, length_m: metres, area_m2: 3e6 }];
        d.laws.dem_orders = [];
      });
      const boxes = await page.$$eval('.plot svg', (all) => all.map((e) => [...e.querySelectorAll('.axis')].map((axis) => axis.getAttribute('x2') - axis.getAttribute('x1'))));
      assert.ok(boxes.flat().every((width) => width > 50), boxes.join(' '));
      await close();
    }
  });

  test('indices of the relief have a sign with words, and all figures in a table', async () => {
    const { page, close } = await shown();
    const judged = Object.values(data.relief.figures).filter((f) => f.range && f.value !== null);
    const signs = await page.$$eval('.relief [role=img].ok, .relief [role=img].bad', (all) => all.map((e) => `${e.textContent} ${e.getAttribute('aria-label')}`));
    assert.equal(signs.length, judged.length);
    for (const words of signs) assert.match(words, /^✓ within .*–|^✗ outside .*–/);
    assert.match(await page.innerText('#sections'), new RegExp(`${judged.filter((f) => f.in_range).length} of ${judged.length} figures`));
    assert.equal(await page.locator('table[aria-label="Relief compared with reference DEMs"] tbody tr').count(), Object.keys(data.relief.figures).length);
    await close();
  });
});

describe('a comparison with a DEM', () => {
  const having = (change = () => {}) => (d) => {
    d.against = madeAgainst();
    change(d.against);
  };
  const plain = (text) => text.replace(/\s+/g, ' ').trim();

  test('its table has every figure of every land, and signs the best', async () => {
    const { page, close } = await shown(having());
    const cells = await page.$$eval('table.against tr', (all) => all.map((row) => [...row.children].map((cell) => cell.textContent)));
    assert.deepEqual(cells, [
      ['figure', 'this terrain', 'cone', 'TIN', 'dilation', 'DEM'],
      ['correlation of heights', '●0.984', '0.981', '0.950', '0.981', ''], // 0.9805 and 0.9806
      ['correlation above the nearest river', '●0.772', '0.745', '–', '0.718', ''],
      ['RMS difference [m]', '●65.0', '78.0', '175.0', '78.6', ''],
      ['mean difference [m]', '●−0.3', '+28.1', '−1\u202f131.8', '−30.5', ''],
      ['same reach [%]', '●80.2', '78.8', '39.9', '76.6', ''],
      ['divides found [%]', '●54.7', '48.9', '27.5', '48.6', ''],
      ['divides right [%]', '●57.7', '●57.7', '–', '53.8', ''],
      ['difference of slopes', '●0.089', '0.381', '0.745', '0.489', ''],
      ['mean slope [°]', '21.1', '21.8given', '7.3', '21.8given', '21.8'],
      ['hypsometric integral', '0.459', '0.468', '0.498', '●0.479', '0.480']]);
    assert.deepEqual(new Set(await page.$$eval('table.against [role=img]', (all) => all.map((e) => e.getAttribute('aria-label')))), new Set(['best']));
    assert.equal(plain(await page.innerText('section:has(table.against) .lead')), 'This terrain is nearer to Big <b>Tujunga</b>.tif than each of the three simple terrains in 7 of 9 figures: '
      + 'correlation of heights, correlation above the nearest river, RMS difference, mean difference, same reach, divides found, difference of slopes. '
      + 'A simple one is nearer in 1: hypsometric integral (dilation, cone, TIN). As near as the best of them: divides right.');
    assert.match(plain(await page.innerText('section:has(table.against)')), /740 487 cells compared.*Given: .*Height above the nearest river:.*Same reach:.*Divides:.*within 3 cells.*right:/);
    await close();
  });

  test('its sentence is true of one simple terrain, of a terrain that is the best, of one that never is, and of none', async () => {
    const lead = async (change) => {
      const { page, close } = await shown(having(change));
      const text = await page.locator('section:has(table.against) .lead').allInnerTexts();
      await close();
      return plain(text.join());
    };
    assert.match(await lead((d) => d.rows.splice(2)), /than the cone in 7 of 9 figures: .* The cone is nearer in 1: hypsometric integral. As near as the best/);
    assert.equal(await lead((d) => Object.assign(d.rows[0], { divides_right: 0.9, ...d.real })), 'This terrain is nearer to Big <b>Tujunga</b>.tif than each of the three simple terrains in all 9 figures.');
    assert.match(await lead((d) => d.rows.reverse()[0]), /terrains in 1 of 9 figures: hypsometric integral\. A simple one is nearer in 8: correlation of heights \(this terrain\)/);
    assert.match(await lead((d) => d.rows.splice(0, 4, { ...d.rows[2], hypsometric_integral: null }, d.rows[1], d.rows[3])), /each of the two simple terrains in none of 6 figures\. A simple one is nearer in 6/);
    assert.equal(await lead((d) => d.rows.splice(1)), '');
  });

  test('its map, scatter, slopes and hypsometry are drawn', async () => {
    const { page, close } = await shown(having());
    const section = page.locator('section:has(table.against)');
    const image = section.locator('img');
    assert.match(await image.getAttribute('alt'), /less Big <b>Tujunga<\/b>.tif: blue where it is lower, red where it is higher, up to 120\sm/);
    assert.equal(await image.evaluate((e) => e.naturalWidth), 2);
    assert.equal(await image.evaluate((e) => e.clientWidth - e.closest('section').clientWidth), 0);
    assert.match(plain(await section.innerText()), /−120 m: this terrain lower 0 higher: \+120 m divides of both of the DEM alone of this terrain alone/);
    await section.getByRole('button', { name: 'Enlarge' }).click();
    assert.ok(await page.locator('dialog img').isVisible());
    await page.keyboard.press('Escape');
    assert.equal(await page.locator('dialog img').isVisible(), false);

    // The squares: those of most cells lie two rows above the line, where this terrain is higher.
    const [line, dark] = await section.locator('.scatter').evaluate((e) => {
      const at = (of, ...names) => names.map((name) => Number(of.getAttribute(name)));
      const corners = [...e.querySelector('.plot path.square:last-of-type').getAttribute('d').matchAll(/M([\d.]+) ([\d.]+)/g)].map(([, x, y]) => [Number(x), Number(y)]);
      return [at(e.querySelector('.equal'), 'x1', 'y1', 'x2', 'y2'), corners];
    });
    const [x1, y1, x2, y2] = line;
    assert.ok(Math.abs(x2 - x1 - (y1 - y2)) < 0.01 && x2 - x1 > 250, line.join());
    const size = (x2 - x1) / 64;
    const above = dark.map(([x, y]) => (y1 - y - (x - x1)) / size);
    assert.ok(dark.length === 62 && above.every((rows) => Math.abs(rows - 2) < 0.05), `${dark.length} ${above}`);
    assert.deepEqual((await section.locator('.scatter .scale text').allTextContents()).map(plain), ['1 cell', '3', '10', '30', '100', '300', '1 000', '3 000', '10 000']);

    const plots = section.locator('.plot[role=slider]');
    assert.equal(await plots.count(), 2);
    await plots.first().focus();
    await page.keyboard.press('PageUp');
    const [slope, ...shares] = plain(await plots.first().getAttribute('aria-valuetext')).split(', ');
    assert.deepEqual([slope, ...shares], ['4°', 'DEM 10%', 'this terrain 0%', 'cone 0%', 'TIN 0%', 'dilation 0%']);
    assert.match(await plots.nth(1).getAttribute('aria-label'), /height \[m\], from 420 to 2\u202f000/);
    await close();
  });

  test('it has no barrier and is not too wide, from a phone to a wide panel', async () => {
    for (const width of [360, 640, 1200]) {
      for (const theme of ['light', 'dark']) {
        const { page, close } = await shown(having(), { theme, viewport: { width, height: 800 } });
        await page.waitForTimeout(100);
        assert.deepEqual(await barriers(page), []);
        const beyond = await page.$eval('section:has(table.against)', (e) => [...e.querySelectorAll('*')].filter((c) => c.getBoundingClientRect().right > e.getBoundingClientRect().right + 0.5).map((c) => c.outerHTML.slice(0, 90)));
        assert.deepEqual(beyond, [], `${theme} ${width}`);
        await close();
      }
    }
  });

  test('a report page shows it within its content policy, and nothing of it where there is none', async () => {
    const scene = valleyLand();
    for (const [name, against] of [['with', madeAgainst()], ['null', null], ['older', undefined]]) {
      const { page, complaints, requests, failed } = await open(browser, writePage(place, name, { ...scene, data: { ...scene.data, against } }));
      assert.deepEqual([complaints, requests.filter((url) => !url.startsWith('data:')).length, failed], [[], 1, null]);
      assert.deepEqual(await page.$$eval('#panel img', (all) => all.map((e) => [e.complete, e.naturalWidth])), against ? [[true, 2]] : []);
      assert.equal(await page.locator('h2', { hasText: 'Compared with a real DEM' }).count(), against ? 1 : 0);
      await page.close();
    }
  });
});

test('no barrier and nothing too wide, in either theme, from a phone to a wide panel', async () => {
  for (const width of [360, 640, 1200]) {
    for (const theme of ['light', 'dark']) {
      const { page, close } = await shown((d) => {
        d.given = [['read', 100, 'km'], ['left out: coastlines', 10, 'km'], ['in the network', 90, 'km']];
        Object.assign(d.checks[0], { value: 2, ok: false });
      }, { theme, viewport: { width, height: 800 } });
      await page.$$eval('details', (all) => all.forEach((e) => (e.open = true)));
      await page.waitForTimeout(100);
      assert.deepEqual(await barriers(page), []);
      const wide = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
      assert.ok(wide <= 0, `${wide} px too wide at ${width}`);
      await close();
    }
  }
});
