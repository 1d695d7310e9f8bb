// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The page of the studio in Debian's Chromium: with a server that only speaks as `thalweg studio` does, and with that
// itself. THALWEG_EXE names the program.
import assert from 'node:assert/strict';
import { execFileSync, spawn } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { after, before, beforeEach, afterEach, describe, test } from 'node:test';
import { barriers, launch, look, open, set } from './browser.mjs';
import { fakeStudio, keysOf, landOf, presetsOf, valuesOf } from './fake_studio.mjs';

const exe = process.env.THALWEG_EXE;
const place = fs.mkdtempSync(path.join(os.tmpdir(), 'thalweg-studio-'));
let gl;
let flat;
let lands;
let keys;
let presets;
let values;
before(async () => {
  lands = [[0, 6], [20, 24], [200, 6]].map(([from, prune], k) => {
    const folder = path.join(place, `land${from}`);
    const grid = k < 2 ? [200, 150] : [120, 140];
    execFileSync(exe, ['make', '-o', folder, '-q', ...['network.source=dla', `grid.width=${grid[0]}`, `grid.height=${grid[1]}`, 'grid.cell=30', 'network.dla.particles=4000', `network.prune=${prune}`].flatMap((s) => ['--set', s])]);
    return [from, landOf(folder)];
  });
  keys = keysOf(exe);
  presets = presetsOf(exe);
  values = valuesOf(fs.readFileSync(path.join(place, 'land0/recipe.toml'), 'utf8'));
  [gl, flat] = await Promise.all([launch('webgl'), launch('no3d')]);
});
after(async () => {
  await gl?.close();
  await flat?.close();
  fs.rmSync(place, { recursive: true, force: true });
});

let server;
let page;
let complaints;
let requests;
async function visit(browser = gl, context = {}, pause = 15) {
  server = await fakeStudio({ lands, keys, presets, values, pause });
  page = await browser.newPage({ viewport: { width: 1280, height: 720 }, ...context });
  complaints = [];
  requests = [];
  page.on('console', (message) => ['error', 'warning'].includes(message.type()) && complaints.push(message.text()));
  page.on('pageerror', (error) => complaints.push(String(error)));
  page.on('request', (request) => requests.push(request.url()));
  await page.goto(`${server.url}&aa=0`);
}
const settled = () => page.waitForFunction(() => window.__thalweg.error || (window.__thalweg.ready && !window.__thalweg.busy && window.__thalweg.level === 'full' && document.documentElement.dataset.stale === 'off'), null, { timeout: 20000 });
const leave = async () => {
  assert.equal(await page.evaluate(() => window.__thalweg.error), null);
  await page.close();
  await server.close();
};
const heights = () => page.evaluate(() => Array.from(window.__thalweg.heights()));
const asked = (what) => server.asked.filter((m) => m.do === what);
const run = (command) => page.evaluate((c) => window.__thalweg.run(c), command);
/** Waits for a land that was tried: no revision tells of it. */
const tried = (land) => page.waitForFunction((z) => {
  const { heights, level, busy } = window.__thalweg;
  return !busy && level === 'full' && z.every((v, i) => heights()[1000 + i] === v);
}, Array.from(land.heights.subarray(1000, 1020)));
const sameHeights = async (land) => assert.deepEqual(Float32Array.from(await heights()), land.heights);

describe('the studio', () => {
  beforeEach(async () => {
    await visit();
    await settled();
  });
  afterEach(leave);

  test('shows what the program makes, to the bit, and asks nobody else', async () => {
    await sameHeights(lands[0][1]);
    const { data } = lands[0][1];
    assert.equal(await page.textContent('#title'), data.title);
    assert.equal(await page.evaluate(() => window.__thalweg.orders().length), data.rivers.arcs.id.length);
    assert.equal(await page.evaluate(() => window.__thalweg.mode), 'webgl2');
    const shown = await look(page);
    assert.ok(shown.colours > 2000 && shown.rivers > 500, JSON.stringify(shown));
    assert.ok(requests.every((url) => url.startsWith(server.url.split('?')[0])));
    assert.deepEqual(complaints, []);
    // The areas that the page reckons with ways of water by exact heights are those of area_d8.
    const most = await page.evaluate(() => window.__thalweg.water.areas.reduce((a, b) => Math.max(a, b)));
    assert.ok(most * 900 >= 0.999 * Math.max(...data.rivers.arcs.ds_area));
    await page.click('#bpanel');
    assert.match(await page.textContent('#verdict'), /checks passed/);
    assert.ok((await page.$$('#sections section')).length >= 4);
  });

  test('run() edits, tells the times and rejects in the words of the program', async () => {
    const reply = await run({ set: 'network.prune', value: '30' });
    assert.equal(reply.revision, 2);
    assert.equal(await page.evaluate(() => window.__thalweg.busy), true);
    await settled();
    await sameHeights(lands[1][1]);
    await page.waitForFunction(() => window.__thalweg.times.full !== null);
    const { times, revision, recipe } = await page.evaluate(() => ({ ...window.__thalweg, recipe: window.__thalweg.recipe() }));
    assert.ok(times.first > 0 && times.full >= times.first, JSON.stringify(times));
    console.log(`# first land after ${times.first} ms, the whole after ${times.full} ms`);
    assert.equal(revision, 2);
    assert.match(recipe, /network\.prune = 30/);
    await assert.rejects(run({ set: 'network.purne', value: '3' }), /unknown key 'network.purne'/);
    await run({ name: 'two at once', steps: [{ set: 'network.prune', value: '7' }, { set: 'seed', value: '8' }] });
    await settled();
    assert.equal(await page.inputValue('#seed'), '8');
    assert.match(await page.getAttribute('.tools button', 'title'), /two at once/);
    await page.evaluate(() => window.__thalweg.undo());
    await settled();
    assert.equal(await page.inputValue('#seed'), String(values.seed));
    await page.evaluate(() => window.__thalweg.redo());
    await settled();
    assert.equal(await page.inputValue('#seed'), '8');
  });

  test('the camera, the exaggeration and the colours stay when the land changes', async () => {
    await page.focus('#view canvas');
    for (const key of ['ArrowLeft', 'ArrowLeft', '+', 'ArrowDown']) await page.keyboard.press(key);
    await page.selectOption('#colour', 'slope');
    await set(page, 'exaggeration', 9);
    const where = () => page.evaluate(async () => {
      await window.__thalweg.still();
      const places = [];
      for (let x = 5; x < 200; x += 10) for (let y = 5; y < 150; y += 10) places.push(window.__thalweg.project(x, y) ?? { x: NaN, y: NaN });
      return places;
    });
    /** Greatest distance on the screen of what is in sight both times. */
    const off = (a, b) => Math.max(...a.map((p, i) => Math.hypot(p.x - b[i].x, p.y - b[i].y)).filter((d) => !Number.isNaN(d)));
    const seen = await where();
    await run({ set: 'network.prune', value: '30' });
    await settled();
    assert.ok(off(seen, await where()) < 250);
    assert.equal(await page.inputValue('#colour'), 'slope');
    assert.equal(await page.inputValue('#exaggeration'), '9');
    const changed = await look(page);
    await run({ set: 'network.prune', value: '6' });
    await settled();
    assert.ok(off(seen, await where()) < 0.1);
    assert.notEqual((await look(page)).hash, changed.hash);
    // Land of another size is looked at afresh.
    await run({ set: 'network.prune', value: '220' });
    await settled();
    await sameHeights(lands[2][1]);
    assert.ok((await look(page)).colours > 1500);
    assert.deepEqual(complaints, []);
  });

  test('L is the recipe’s pruning length: lines follow at once, the land by tries, the end is an edit', async () => {
    const kept = await page.evaluate(() => window.__thalweg.kept);
    assert.equal(await page.inputValue('#L'), '6');
    const box = await page.locator('#L').boundingBox();
    const to = (share) => page.mouse.move(box.x + share * box.width, box.y + box.height / 2, { steps: 6 });
    await to(0.035);
    await page.mouse.down();
    await to(0.25);
    assert.ok((await page.evaluate(() => window.__thalweg.kept)) < kept);
    await tried(lands[1][1]);
    const value = await page.inputValue('#L');
    assert.equal(asked('try').at(-1).edit.steps[0].value, value);
    assert.ok(asked('try').length >= 1 && asked('edit').length === 0);
    await sameHeights(lands[1][1]);
    await page.mouse.up();
    await settled();
    assert.deepEqual(asked('edit').map((m) => m.edit.steps), [[{ set: 'network.prune', value }]]);
    // Away and back again is no edit, and the land is that of the recipe.
    await page.$eval('#L', (input) => (input.value = 10));
    await page.$eval('#L', (input) => input.dispatchEvent(new Event('input')));
    await tried(lands[0][1]);
    await page.$eval('#L', (input, v) => {
      input.value = v;
      input.dispatchEvent(new Event('input'));
      input.dispatchEvent(new Event('pointerup'));
    }, value);
    await tried(lands[1][1]);
    assert.equal(asked('edit').length, 1);
  });

  test('a document begins with a preset by one edit; the list folds with the first edit of another kind', async () => {
    const isOpen = () => page.$eval('#presets', (e) => e.open);
    assert.equal(await isOpen(), true);
    assert.deepEqual(await page.$$eval('#presets button', (all) => all.map((e) => Array.from(e.children, (c) => c.textContent))), [
      ['Hills', 'Gentle hills.', 'Not a plain.'], ['Basin and range', 'Long ranges.', 'Not basins of sediment.']]);
    await page.click('[data-preset="basin-and-range"]');
    await settled();
    assert.deepEqual(asked('edit').map((m) => m.edit), [{ name: 'preset basin-and-range', steps: [{ recipe: presets[1].recipe }] }]);
    assert.equal(await page.getAttribute('.tools button >> nth=0', 'title'), 'Undo: preset basin-and-range (Ctrl+Z)');
    assert.equal(await page.inputValue('#source'), 'forest');
    assert.equal(await isOpen(), true);
    await page.keyboard.press('Control+z');
    await settled();
    assert.equal(await page.inputValue('#source'), 'dla');
    assert.equal(await isOpen(), true);
    await run({ set: 'network.prune', value: '30' });
    await settled();
    assert.equal(await isOpen(), false);
    await page.click('#presets summary');
    assert.equal(await isOpen(), true);
    await run({ set: 'seed', value: '9' });
    await settled();
    assert.equal(await isOpen(), true, 'who unfolds it again has it so');
    assert.deepEqual(complaints, []);
  });

  test('Undo, redo and what was before, by keys and buttons', async () => {
    assert.ok(await page.isDisabled('.tools button >> nth=0'));
    await run({ set: 'network.prune', value: '30' });
    await settled();
    const after_ = await look(page);
    await page.keyboard.down('b');
    const before_ = await look(page);
    assert.notEqual(before_.hash, after_.hash);
    assert.equal(await page.evaluate(() => window.__thalweg.orders().length), lands[0][1].data.rivers.arcs.id.length);
    await page.keyboard.up('b');
    assert.equal((await look(page)).hash, after_.hash);
    await page.hover('.tools button >> nth=2');
    await page.mouse.down();
    assert.equal(await page.getAttribute('.tools button >> nth=2', 'aria-pressed'), 'true');
    await page.mouse.up();
    assert.equal(await page.getAttribute('.tools button >> nth=0', 'title'), 'Undo: network.prune = 30 (Ctrl+Z)');
    await page.keyboard.press('Control+z');
    await settled();
    await sameHeights(lands[0][1]);
    assert.equal(await page.inputValue('#L'), '6');
    await page.keyboard.press('Control+Shift+Z');
    await settled();
    await sameHeights(lands[1][1]);
    await page.keyboard.press('Control+z');
    await settled();
    await page.keyboard.press('Control+y');
    await settled();
    assert.equal(await page.inputValue('#L'), '30');
  });

  test('every key has a field; a refusal is told beside it, and it goes back', async () => {
    await page.evaluate(() => document.querySelectorAll('#recipe details').forEach((d) => (d.open = true)));
    const paths = await page.$$eval('.key', (all) => all.map((e) => e.dataset.path));
    for (const { path: p } of keys) if (!['seed', 'network.source', 'network.prune'].includes(p) && !p.startsWith('patch.')) assert.ok(paths.includes(p), p);
    const grain = '[data-path="surface.grain"]';
    const start = await page.inputValue(`${grain} input[type=number]`);
    await page.fill(`${grain} input[type=number]`, '21');
    await page.keyboard.press('Tab');
    await page.waitForSelector(`${grain} .refused:not([hidden])`);
    assert.equal(await page.textContent(`${grain} .refused`), 'surface.grain = 21 is not in [1, 20]');
    assert.equal(await page.inputValue(`${grain} input[type=number]`), start);
    await page.fill(`${grain} input[type=number]`, '7');
    await page.keyboard.press('Tab');
    await settled();
    assert.ok(await page.isHidden(`${grain} .refused`));
    assert.equal(await page.inputValue(`${grain} input[type=number]`), '7');
    await page.click(`${grain} .back`);
    await settled();
    assert.deepEqual(asked('edit').at(-1).edit.steps, [{ unset: 'surface.grain' }]);
    assert.equal(await page.inputValue(`${grain} input[type=number]`), '5');
    assert.ok(await page.isHidden(`${grain} .back`));
    await page.selectOption('[data-path="surface.drain"] select', 'fill');
    await settled();
    assert.deepEqual(asked('edit').at(-1).edit.steps, [{ set: 'surface.drain', value: 'fill' }]);
    await page.click('[data-path="output.accumulation"] input');
    await settled();
    assert.deepEqual(asked('edit').at(-1).edit.steps, [{ set: 'output.accumulation', value: 'true' }]);
    await page.fill('[data-path="grid.origin"] input >> nth=1', '4000000');
    await page.keyboard.press('Tab');
    await settled();
    assert.deepEqual(asked('edit').at(-1).edit.steps, [{ set: 'grid.origin', value: '[500000, 4000000]' }]);
    // A slider over decades tries while it is drawn.
    await page.focus('[data-path="surface.hillslope"] input[type=range]');
    await page.keyboard.press('PageUp');
    await settled();
    assert.ok(Number(asked('edit').at(-1).edit.steps[0].value) > 15);
    await run({ set: 'patch.1.gain', value: '2' });
    await settled();
    assert.deepEqual(await page.$$eval('[data-path$=".gain"]', (all) => all.map((e) => [e.dataset.path, e.closest('.unused') !== null])), [['patch.1.gain', false], ['patch.2.gain', true]]);
    await page.focus('[data-path="surface.hillslope"] input[type=range]');
    assert.match(await page.textContent('#key-help'), /surface\.hillslope.*soil creep.*default 15/);
  });

  test('keys are found by name and meaning', async () => {
    await page.fill('#find-key', 'soil');
    const seen = () => page.$$eval('.key', (all) => all.filter((e) => e.checkVisibility()).map((e) => e.dataset.path));
    assert.deepEqual(await seen(), ['surface.hillslope']);
    await page.fill('#find-key', 'zzz');
    assert.deepEqual(await seen(), []);
    await page.keyboard.press('Escape');
    assert.deepEqual(await seen(), []);
    assert.ok((await page.$$('.keys-section')).length > 5);
  });

  test('the cluster, the seed and the source of rivers', async () => {
    await page.click('.arms [data-arm=north]');
    await settled();
    assert.deepEqual(asked('edit').at(-1).edit.steps, [{ set: 'network.dla.branch', value: 'north' }]);
    assert.equal(await page.getAttribute('.arms [data-arm=north]', 'aria-pressed'), 'true');
    const box = await page.locator('.cluster canvas').boundingBox();
    await page.mouse.click(box.x + 0.12 * box.width, box.y + 0.5 * box.height);
    await settled();
    assert.equal(asked('edit').at(-1).edit.steps[0].value, 'west');
    await page.fill('#seed', '99');
    await page.keyboard.press('Enter');
    await settled();
    assert.deepEqual(asked('edit').at(-1).edit.steps, [{ set: 'seed', value: '99' }]);
    await page.click('text=New seed');
    await settled();
    assert.notEqual(await page.inputValue('#seed'), '99');
    await page.selectOption('#source', 'forest');
    await settled();
    assert.deepEqual(asked('edit').at(-1).edit.steps, [{ set: 'network.source', value: 'forest' }]);
  });

  test('exports everything, or one file', async () => {
    await page.click('text=Export…');
    await page.click('text=Export everything');
    await page.waitForSelector('#export .done');
    assert.match(await page.textContent('#export'), /4 files in.*studio\/export.*thalweg make/s);
    const [download] = await Promise.all([page.waitForEvent('download'), page.click('#export .one button')]);
    assert.equal(fs.readFileSync(await download.path(), 'utf8'), 'contents');
    assert.ok(server.asked.some((m) => m.get === '/files/dem.tif'));
    assert.deepEqual(await barriers(page), []);
    await page.keyboard.press('Escape');
    assert.ok(await page.isHidden('#export'));
  });

  test('drops what is late, says what is said, and tells of a recipe that cannot be made', async () => {
    const { job } = await page.evaluate(() => ({ job: window.__thalweg.job }));
    server.send({ type: 'scene', job: job - 1, revision: 1, level: 'measured', lines: '', water: '', data: {} });
    server.send({ type: 'failed', job: job - 1, revision: 1, error: 'late' });
    server.send({ type: 'say', text: '3 rivers were left out' });
    server.send({ type: 'failed', job: job + 1, revision: 1, error: 'network.prune leaves no river' });
    await page.waitForFunction(() => document.getElementById('doing').classList.contains('bad'));
    assert.match(await page.textContent('#doing'), /leaves no river/);
    assert.match(await page.textContent('.messages'), /3 rivers were left out/);
    const finding = (kind, text) => ({ kind, severity: 'warning', text, remedy: 'Mend it' });
    server.send({ type: 'findings', job: job + 1, revision: 1, count: 3, list: [finding('rills', 'they are rills'), { ...finding('grid', '3x3 cells'), severity: 'note' }] });
    server.send({ type: 'findings', job: job + 1, revision: 1, count: 3, list: [finding('rills', 'they are rills'), finding('gentle_land', 'it is gentle')] });
    await page.waitForFunction(() => window.__thalweg.findings?.length === 2 && window.__thalweg.findings[1].kind === 'gentle_land');
    assert.deepEqual(await page.locator('.said .careful').allTextContents(), ['they are rills. Mend it.', 'it is gentle. Mend it.']);
    server.send({ type: 'findings', job: job + 1, revision: 1, count: 0, list: [] });
    await page.waitForFunction(() => document.querySelectorAll('.said .careful').length === 0);
    assert.match(await page.textContent('.messages'), /3 rivers were left out/);
    await sameHeights(lands[0][1]);
  });

  test('says when the program has ended', async () => {
    await server.close();
    await page.waitForFunction(() => /trying again/.test(document.getElementById('message').textContent));
    await page.waitForFunction(() => /has ended; start it again and reload/.test(document.getElementById('message').textContent), null, { timeout: 30000 });
    assert.equal(await page.evaluate(() => document.getElementById('recipe').inert), true);
    await assert.rejects(run({ set: 'seed', value: '3' }), /no connection/);
  });

  test('comes back when only the connection was lost', async () => {
    server.drop();
    await page.waitForFunction(() => document.getElementById('recipe').inert);
    await page.waitForFunction(() => !document.getElementById('recipe').inert, null, { timeout: 10000 });
    await settled();
    assert.ok(await page.isHidden('#message'));
    await run({ set: 'network.prune', value: '30' });
    await settled();
    await sameHeights(lands[1][1]);
  });
});

describe('while it is made', () => {
  test('rivers come first, coarse land next, and the whole takes its place without a jump', async () => {
    await visit(gl, {}, 400);
    await page.waitForFunction(() => window.__thalweg.ready);
    assert.deepEqual(await page.evaluate(() => [window.__thalweg.level, window.__thalweg.orders().length]), [null, lands[0][1].data.rivers.arcs.id.length]);
    assert.ok(await page.isVisible('#doing button'));
    const where = () => page.evaluate(async () => (await window.__thalweg.still(), window.__thalweg.project(60, 40)));
    await page.waitForFunction(() => window.__thalweg.level === 'coarse');
    const coarse = await where();
    assert.match(await page.textContent('#doing'), /coarse terrain|equilibrium/);
    await page.waitForFunction(() => window.__thalweg.level === 'full');
    const full = await where();
    assert.ok(Math.hypot(full.x - coarse.x, full.y - coarse.y) < 12, JSON.stringify([coarse, full]));
    assert.equal(await page.evaluate(() => document.documentElement.dataset.stale), 'on');
    await page.click('#doing button');
    assert.equal(asked('stop').length, 1);
    await leave();
  });

  test('tries: one unanswered at most, the last wins', async () => {
    await visit();
    await settled();
    await page.evaluate(() => {
      for (let v = 7; v < 40; ++v) {
        document.getElementById('L').value = v;
        document.getElementById('L').dispatchEvent(new Event('input'));
      }
    });
    await page.waitForFunction(() => !window.__thalweg.busy);
    assert.deepEqual(asked('try').map((m) => m.edit.steps[0].value), ['7', '39']);
    await leave();
  });
});

describe('for everybody', () => {
  test('has no serious barrier, light, dark and on a phone, where nothing overflows', async () => {
    for (const context of [{ colorScheme: 'light' }, { colorScheme: 'dark' }, { colorScheme: 'dark', viewport: { width: 360, height: 740 } }]) {
      await visit(gl, context);
      await settled();
      await page.evaluate(() => document.querySelectorAll('details').forEach((d) => (d.open = true)));
      await page.evaluate(() => (document.documentElement.dataset.panel = 'on'));
      assert.deepEqual(await barriers(page), []);
      assert.deepEqual(complaints, []);
      assert.ok((await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth)) <= 0);
      await page.keyboard.press('?');
      assert.ok(await page.isVisible('dialog .keys'));
      assert.match(await page.textContent('dialog .keys'), /undo/);
      await leave();
    }
  });

  test('works without WebGL', async () => {
    await visit(flat);
    await settled();
    assert.equal(await page.evaluate(() => window.__thalweg.mode), '2d');
    const first = await look(page);
    await run({ set: 'network.prune', value: '30' });
    await settled();
    await sameHeights(lands[1][1]);
    const second = await look(page);
    assert.ok(second.colours > 1500 && second.hash !== first.hash);
    assert.deepEqual(complaints, []);
    await leave();
  });

  test('a report page connects to nobody, and lists its keys', async () => {
    const { page: report, complaints: said } = await open(gl, path.join(place, 'land0/report.html'));
    await report.keyboard.press('?');
    assert.ok(await report.isVisible('dialog .keys'));
    assert.doesNotMatch(await report.textContent('dialog .keys'), /undo/);
    assert.deepEqual(await barriers(report), []);
    assert.deepEqual(said, []);
    const refused = await report.evaluate(() => new Promise((done) => {
      document.addEventListener('securitypolicyviolation', (event) => done(event.effectiveDirective));
      new WebSocket('ws://127.0.0.1:9/');
    }));
    assert.equal(refused, 'connect-src');
    await report.close();
  });
});

describe('thalweg studio itself', () => {
  const folder = path.join(place, 'document');
  let program;
  before(async () => {
    const recipe = path.join(place, 'small.toml');
    fs.writeFileSync(recipe, '[grid]\nwidth = 200\nheight = 150\n[network]\nsource = "dla"\nprune = 6\n[network.dla]\nparticles = 4000\n[surface]\n');
    program = spawn(exe, ['studio', recipe, '-o', folder, '--no-browser', '-q'], { stdio: ['ignore', 'pipe', 'inherit'] });
    const url = await new Promise((done, failed) => {
      let text = '';
      program.on('exit', () => failed(new Error('thalweg studio has ended')));
      program.stdout.on('data', (bytes) => {
        text += bytes;
        if (text.includes('\n')) done(text.trim());
      });
    });
    server = { close() {} };
    page = await gl.newPage({ viewport: { width: 1280, height: 720 } });
    complaints = [];
    page.on('console', (message) => ['error', 'warning'].includes(message.type()) && complaints.push(message.text()));
    page.on('pageerror', (error) => complaints.push(String(error)));
    await page.goto(url);
    await settled();
  });
  after(() => program?.kill('SIGINT'));

  /** The heights that `thalweg make` gives from the document's recipe. */
  const made = () => {
    const out = path.join(place, 'again');
    fs.rmSync(out, { recursive: true, force: true });
    execFileSync(exe, ['make', path.join(folder, 'recipe.toml'), '-o', out, '-q']);
    return landOf(out);
  };

  test('shows the heights that make writes, to the bit, and after edits those of the new recipe', async () => {
    await sameHeights(made());
    await run({ set: 'network.prune', value: '24' });
    await settled();
    await sameHeights(made());
    assert.equal(await page.inputValue('#L'), '24');
    await page.click('.arms [data-arm=west]');
    await settled();
    await sameHeights(made());
    const most = await page.evaluate(() => window.__thalweg.water.areas.reduce((a, b) => Math.max(a, b)));
    assert.ok(most * 900 >= 0.999 * Math.max(...made().data.rivers.arcs.ds_area));
    await page.keyboard.press('Control+z');
    await page.keyboard.press('Control+z');
    await page.waitForFunction(() => document.getElementById('L').value === '6');
    await settled();
    await sameHeights(made());
    assert.ok((await page.locator('.cluster canvas').evaluate((c) => c.getContext('2d').getImageData(0, 0, c.width, c.height).data.filter((v, i) => i % 4 === 3 && v > 0).length)) > 200);
    await assert.rejects(run({ set: 'network.purne', value: '3' }), /purne/);
    assert.deepEqual(complaints, []);
  });

  test('tries while a slider is drawn, and forgets them', async () => {
    const first = await heights();
    await page.$eval('#L', (input) => {
      input.value = 40;
      input.dispatchEvent(new Event('input'));
    });
    await settled();
    assert.notDeepEqual(await heights(), first);
    assert.equal(await page.evaluate(() => window.__thalweg.recipe().includes('prune = 40')), false);
    await page.$eval('#L', (input) => {
      input.value = 6;
      input.dispatchEvent(new Event('input'));
      input.dispatchEvent(new Event('pointerup'));
    });
    await page.waitForTimeout(100);
    await settled();
    assert.deepEqual(await heights(), first);
  });

  test('prunes, takes another branch, a new seed and two other keys, undoes two and exports what thalweg check accepts', async () => {
    await page.fill('#seed', '11');
    await page.keyboard.press('Enter');
    await settled();
    await page.$eval('#L', (input) => {
      input.value = 9;
      for (const type of ['input', 'pointerup', 'change']) input.dispatchEvent(new Event(type));
    });
    await page.waitForFunction(() => window.__thalweg.recipe().includes('prune = 9.0'));
    await page.click('.arms [data-arm=east]');
    await settled();
    const kept = await page.evaluate(() => window.__thalweg.recipe());
    await run({ set: 'surface.mean_slope', value: '18' });
    await run({ set: 'surface.roughness', value: '0.1' });
    await settled();
    await page.click('text=Undo');
    await page.click('text=Undo');
    await page.waitForFunction((recipe) => window.__thalweg.recipe() === recipe, kept);
    await settled();
    await sameHeights(made());
    await page.click('text=Export…');
    await page.click('text=Export everything');
    await page.waitForSelector('#export .done', { timeout: 60000 });
    await page.keyboard.press('Escape');
    const terrain = path.join(folder, 'terrain');
    assert.deepEqual(fs.readFileSync(path.join(terrain, 'dem.tif')), fs.readFileSync(path.join(place, 'again/dem.tif')));
    execFileSync(exe, ['check', terrain, '--dem', path.join(terrain, 'dem.tif')]); // it exits with 0
    execFileSync(exe, ['replay', terrain]);
    assert.deepEqual(complaints, []);
  });

  test('writes a file, and says when it has ended', async () => {
    await page.click('text=Export…');
    await page.selectOption('#one-file', 'recipe.toml');
    const [download] = await Promise.all([page.waitForEvent('download'), page.click('#export .one button')]);
    assert.match(fs.readFileSync(await download.path(), 'utf8'), /prune = 9/);
    await page.keyboard.press('Escape');
    program.kill('SIGINT');
    await page.waitForFunction(() => /has ended; start it again and reload/.test(document.getElementById('message').textContent), null, { timeout: 30000 });
    await page.close();
  });
});
