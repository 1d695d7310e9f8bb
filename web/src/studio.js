// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The page's second life: it is served by `thalweg studio`, shows what the program makes, and edits its recipe.
import './studio.css';
import { clusterPicture } from './cluster.js';
import { copyable, make } from './elements.js';
import { isStandard, plain } from './fields.js';
import { dialog, typing } from './keys.js';
import { Land } from './land.js';
import { Link } from './link.js';
import { createPage, tellAll } from './page.js';
import { recipeForm } from './recipe.js';
import { Rivers } from './rivers.js';
import { drawingKeys, openSheet } from './sheet.js';
import { Water } from './water.js';

const $ = (id) => document.getElementById(id);
const root = document.documentElement;
const files = [
  'dem.tif',
  'network.gpkg',
  'report.html',
  'recipe.toml',
  'contours.gpkg',
  'catchments.gpkg',
  'map.png',
  'report.json',
];
const noArcs = {
  id: [],
  ds: [],
  basin: [],
  strahler: [],
  shreve: [],
  hack: [],
  survives: [],
  length: [],
  z_up: [],
  z_down: [],
  us_area: [],
  ds_area: [],
  n: [],
};
const noData = {
  command: '',
  recipe: '',
  crs: '',
  contour_m: 0,
  rivers: { step: 1, prune: 0, arcs: noArcs },
  ridges: null,
  sea: null,
  lakes: false,
  summits: [],
  profiles: [],
  curve: null,
  hypsometry: null,
  laws: { rows: [], support: null, orders: [], dem_orders: [], hack: {}, concavity: {} },
  relief: null,
  statistics: [],
  given: [],
  checks: [],
  timings: [],
  warnings: { count: 0, shown: [] },
  repairs: { count: 0, shown: [] },
  findings: { count: 0, shown: [] },
  notes: [],
};

const button = (text, title, click) => {
  const b = make('button', { type: 'button', textContent: text, title });
  b.addEventListener('click', click);
  return b;
};
const seconds = (s) => (s < 1 ? `${Math.round(1000 * s)} ms` : `${s.toFixed(1)} s`);
const oneFrame = () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));

/** about: what the page was given by the program; state: what it tells about itself to whoever asks. */
export function openStudio(about, state) {
  const key = (path) => about.keys.find((k) => k.path === path);
  let page = null;
  let now = null; // the scene that belongs to the last land
  let pending = null; // rivers whose land is yet to come: {data, rivers, job}
  let before = null; // the scene before the last edit
  let holding = false;
  let current = { values: {}, sections: [], undo: '', redo: '', command: '', recipe: '' };
  root.dataset.studio = 'on';
  root.dataset.panel = innerWidth < 1500 ? 'off' : 'on';
  $('bpanel').setAttribute('aria-pressed', String(root.dataset.panel === 'on'));
  document.title = $('title').textContent = about.folder.split(/[\\/]/).filter(Boolean).at(-1) ?? 'thalweg studio';

  // ── What is being done.
  const bar = make('div', { id: 'bar' }, make('i'));
  const words = make('span');
  const stop = button('Stop', 'Stop what is being computed', () => link.ask({ do: 'stop' }).catch(() => {}));
  const doing = make('div', { id: 'doing', hidden: true }, words, stop);
  const spoken = make('p', { className: 'unseen' });
  spoken.setAttribute('role', 'status');
  bar.setAttribute('aria-hidden', 'true');
  $('stage').append(bar, doing, spoken);
  let fading;
  let done = {}; // of the stage that runs
  function tell(text, { bad = false, running = false, stay = 4000 } = {}) {
    clearTimeout(fading);
    words.textContent = text;
    doing.classList.toggle('bad', bad);
    stop.hidden = !running;
    doing.hidden = text === '';
    if (!running) spoken.textContent = text;
    if (!running && !bad && text) fading = setTimeout(() => (doing.hidden = true), stay);
  }
  const log = make('ol', { className: 'said' });
  const messages = make(
    'details',
    { className: 'messages', hidden: true },
    make('summary', { textContent: 'Messages' }),
    log,
  );
  let warned = []; // items of the last job's warnings, which stand first
  function count() {
    messages.hidden = log.children.length === 0;
    messages.firstElementChild.textContent = `Messages (${log.children.length})`;
  }
  function say(text) {
    log.append(make('li', { textContent: text }));
    while (log.children.length > 50) log.firstElementChild.remove();
    count();
  }
  function warn(findings) {
    state.findings = findings;
    for (const one of warned) one.remove();
    warned = findings
      .filter(({ severity }) => severity === 'warning')
      .map(({ kind, text, remedy }) =>
        make('li', { className: 'careful', title: kind, textContent: remedy ? `${text}. ${remedy}.` : text }),
      );
    log.prepend(...warned);
    count();
  }

  // ── What the page asks, and whether it waits for an answer.
  let unanswered = 0;
  let working = false;
  let awaited = 0; // job whose end is to come
  let finished = 0; // job that ended last
  let sent = null; // the last edit: {at, job}, for the times
  state.times = { first: null, full: null };
  Object.defineProperty(state, 'busy', {
    get: () => unanswered > 0 || working || trial.waits || awaited > finished || (sheet?.desk.waits ?? false),
  });
  Object.defineProperty(state, 'job', { get: () => link.job });
  function changes() {
    page?.view.hurry?.(true);
    sent = { at: performance.now(), job: link.job };
    state.times = { first: null, full: null };
  }
  /** What was on screen becomes what was before. */
  function begins() {
    if (now && page && !trial.drawn) before = now;
    compare.disabled = !before;
  }
  async function ask(question) {
    begins();
    changes();
    trial.drop();
    const { revision = -1 } = state;
    const { job } = link;
    ++unanswered;
    try {
      const reply = await link.ask(question);
      if (reply.revision > revision) awaited = reply.job ?? job + 1;
      return reply;
    } catch (error) {
      page?.view.hurry?.(false);
      throw error;
    } finally {
      --unanswered;
    }
  }
  const stepsOf = (command) => (command.steps ? command : { name: '', steps: [command] });
  const edit = (...steps) => ask({ do: 'edit', edit: { name: '', steps } });

  /** Tries while a slider is drawn: one unanswered at most, the last wins. */
  const trial = {
    next: null, waits: false, drawn: false,
    take(step) {
      begins();
      this.drawn = true;
      this.next = step;
      if (!this.waits) this.send();
    },
    async send() {
      const step = this.next;
      this.next = null;
      this.waits = true;
      changes();
      const { job } = link;
      await link.ask({ do: 'try', edit: { name: '', steps: [step] } })
        .then((reply) => (awaited = reply.job ?? job + 1), (error) => tell(error.message, { bad: true }));
      this.waits = false;
      if (this.next) this.send();
    },
    drop() {
      this.next = null;
      this.drawn = false;
    },
  };
  const act = {
    trying: (path, value) => trial.take({ set: path, value }),
    set: (path, value) => edit({ set: path, value }),
    unset: (path) => edit({ unset: path }),
  };
  /** For what stands above the sections: a refusal is told in the view. */
  const quietly = (promise) => promise.catch((error) => {
    tell(error.message, { bad: true });
    form.show(current);
    above();
  });

  // ── The panel.
  const undo = button('Undo', 'Undo (Ctrl+Z)', () => sheet?.desk.recall() || quietly(ask({ do: 'undo' })));
  const redo = button('Redo', 'Redo (Ctrl+Shift+Z, Ctrl+Y)', () => quietly(ask({ do: 'redo' })));
  const compare = make('button', {
    type: 'button',
    textContent: 'Before',
    title: 'Hold to see the terrain before the last edit (B)',
    disabled: true,
  });
  compare.setAttribute('aria-pressed', 'false');
  const tools = make(
    'div',
    { className: 'tools' },
    undo,
    redo,
    compare,
    button('Export…', 'Write files', () => exporting.showModal()),
  );
  tools.setAttribute('role', 'toolbar');
  tools.setAttribute('aria-label', 'Edits');

  const seed = make('input', { type: 'number', id: 'seed', min: 0, step: 1, autocomplete: 'off' });
  seed.addEventListener('change', () => seed.value !== '' && quietly(act.set('seed', seed.value)));
  const chance = button('New seed', 'Another terrain of the same recipe', () =>
    quietly(act.set('seed', String(1 + Math.floor(Math.random() * 99999)))),
  );
  const source = make(
    'select',
    { id: 'source' },
    ...(key('network.source')?.choices ?? []).map((value) => make('option', { value, textContent: value })),
  );
  source.addEventListener('change', () => quietly(act.set('network.source', source.value)));
  const branch = 'network.dla.branch';
  const cluster = clusterPicture(key(branch).choices, (arm) => quietly(act.set(branch, arm)));
  const row = (label, ...controls) => make('div', { className: 'row' }, label, ...controls);
  const first = make('div', { id: 'first' },
    row(make('label', { htmlFor: 'seed', textContent: 'Seed' }), seed, chance),
    row(make('label', { htmlFor: 'source', textContent: 'Rivers from' }), source), cluster.element);
  const form = recipeForm(about.keys, act, ['seed', 'network.source', 'network.prune']);
  const side = make('aside', { id: 'recipe' });
  side.setAttribute('aria-label', 'Studio');
  const view = $('controls');
  const lengths = $('field-L');
  lengths.hidden = true;
  lengths.querySelector('label').textContent = 'Prune streams below';
  side.append(
    $('title'),
    tools,
    make('div', { id: 'length' }, lengths),
    first,
    view,
    form.element,
    messages,
    $('foot'),
  );
  document.body.prepend(side);
  view.hidden = true;
  const toggle = button('Recipe', 'Show or hide the recipe', () => {
    const off = root.dataset.recipe !== 'off';
    root.dataset.recipe = off ? 'off' : 'on';
    toggle.setAttribute('aria-pressed', String(!off));
  });
  toggle.setAttribute('aria-pressed', 'true');
  $('ways').insertBefore(toggle, $('bpanel'));

  let drawnL = false;
  const L = {
    least: 1,
    changing(value) {
      drawnL = true;
      act.trying('network.prune', value);
    },
    changed(value) {
      drawnL = false;
      if (Number(value) === Number(plain(current.values['network.prune'] ?? now?.data.rivers.prune))) {
        act.trying('network.prune', value);
      } else quietly(act.set('network.prune', value));
    },
  };
  $('L').addEventListener('pointerup', () => setTimeout(() => drawnL && L.changed($('L').value)));
  /** The controls above the sections, by the document. */
  function above() {
    const { values } = current;
    undo.disabled = !current.undo;
    redo.disabled = !current.redo;
    undo.title = `Undo${current.undo ? `: ${current.undo}` : ''} (Ctrl+Z)`;
    redo.title = `Redo${current.redo ? `: ${current.redo}` : ''} (Ctrl+Shift+Z, Ctrl+Y)`;
    seed.value = plain(values.seed ?? '');
    source.value = plain(values['network.source'] ?? '');
    source.parentElement.hidden = !('network.source' in values);
    cluster.mark(plain(values[branch] ?? 'largest'));
    // Left out, it is what the rivers were pruned at.
    const prune =
      'network.prune' in values ? (values['network.prune'] ?? String(now?.data.rivers.prune ?? 0)) : undefined;
    L.least = Number(prune) < 1 ? 0 : 1;
    lengths.hidden = !page || prune === undefined;
    if (!drawnL) {
      page?.bindLength(prune === undefined ? null : L, prune === undefined ? undefined : Number(plain(prune)));
    }
    $('L').title =
      prune === undefined
        ? ''
        : 'network.prune' +
          (isStandard(key('network.prune') ?? { type: '', standard: '' }, prune) ? ', the default' : '');
  }

  // ── Export.
  const outcome = make('div', { className: 'outcome' });
  outcome.setAttribute('role', 'status');
  const whole = button('Export everything', 'Write all files of make into the export folder', () => exported());
  const choice = make(
    'select',
    { id: 'one-file' },
    ...files.map((value) => make('option', { value, textContent: value })),
  );
  const one = button('Save', 'Save this file', () => exported(choice.value));
  const command = make('div');
  const exporting = dialog(
    'Export',
    make('p', { textContent: 'All files that make writes, in a folder beside the recipe:' }),
    whole,
    make('p', { className: 'one' }, make('label', { htmlFor: 'one-file', textContent: 'One file' }), choice, one),
    outcome,
    make('p', { className: 'hint', textContent: 'The same by the command line:' }),
    command,
  );
  exporting.id = 'export';
  async function exported(file) {
    whole.disabled = one.disabled = true;
    outcome.replaceChildren(make('p', { textContent: file ? `Making ${file}…` : 'Writing all files…' }));
    try {
      const reply = await state.export(file);
      if (file && reply.url) {
        const url = new URL(reply.url, location.href);
        for (const [name, value] of new URLSearchParams(location.search)) {
          if (!url.searchParams.has(name)) url.searchParams.append(name, value);
        }
        make('a', { href: url.href, download: file }).click();
      }
      const many = reply.files?.length ?? 0;
      outcome.replaceChildren(
        make('p', { className: 'done', textContent: file ? `${file} is saved.` : `${many} files in` }),
        !file && copyable(reply.folder ?? '', 'the folder'),
        many > 1 &&
          make(
            'details',
            {},
            make('summary', { textContent: 'Which' }),
            make('p', { className: 'hint', textContent: reply.files.join(', ') }),
          ),
      );
      outcome.replaceChildren(...[...outcome.childNodes].filter((n) => n.nodeType === 1));
    } catch (error) {
      outcome.replaceChildren(make('p', { className: 'refused', textContent: error.message }));
    }
    whole.disabled = one.disabled = false;
  }

  // ── Scenes.
  const stale = (is) => {
    root.dataset.stale = is ? 'on' : 'off';
    for (const id of ['verdict', 'ledger', 'sections']) $(id).setAttribute('aria-busy', String(is));
  };
  const sameGrid = (a, b) => ['width', 'height', 'cell_m', 'west', 'north'].every((k) => a[k] === b[k]);
  function show(scene, options) {
    now = scene;
    if (page) {
      if (!holding) page.replace(scene, { home: !page.tools.held, ...options });
      sheet?.follow();
      return;
    }
    page = createPage(
      scene,
      state,
      drawingKeys.concat([['Ctrl+Z', 'undo'], ['Ctrl+Shift+Z, Ctrl+Y', 'redo'], ['B', 'hold: before the last edit']]),
    );
    state.heights = () => link.heights;
    view.hidden = false;
    above();
    draw();
  }
  const dataOf = (grid, more) => ({
    ...noData,
    version: about.version,
    title: document.title,
    seed: Number(current.values.seed) || 0,
    grid,
    heights: null,
    ...more,
  });

  // ── Drawing.
  let sheet = null;
  let drawn = null; // the program's last message of it
  function draw() {
    if (!page || !drawn) return;
    sheet ??= openSheet(page, {
      ask,
      revision: () => state.revision,
      types: (key('network.rosgen')?.choices ?? []).filter((type) => !type.startsWith('by_')),
    });
    sheet.take(drawn);
  }

  function drawing(message) {
    // Rivers that were shown on level ground, or were about to be, go too; another grid is another sheet.
    const emptied =
      page && !(now?.land.level && now.rivers.count === 0 && !pending && sameGrid(now.data.grid, message.grid));
    drawn = message;
    // Where rivers are shown and none is there, a given land comes.
    if (message.kind === 'drawn' && message.rivers.length === 0) {
      if (emptied) flat(message.grid);
      else if (!page) setTimeout(() => page || flat(message.grid), 300);
    }
    draw();
  }

  /** Whether no land is to come: what comes all the same was under way before. */
  const isEmpty = () => drawn?.kind === 'drawn' && drawn.rivers.length === 0 && drawn.revision >= state.revision;

  /** An empty sheet: level ground. */
  function flat(grid) {
    pending = null;
    clearTimeout(alone);
    const land = new Land(grid, null);
    state.level = null;
    show({
      data: dataOf(grid, { command: current.command, recipe: current.recipe }),
      land,
      rivers: new Rivers(noData.rivers, null, ''),
      water: new Water(land, '', false),
    });
    stale(false);
  }

  let alone;
  function rivers({ data, lines, job }) {
    const next = { data, job, rivers: new Rivers(data.rivers, data.ridges, lines) };
    pending = next;
    clearTimeout(alone);
    if (now) alone = setTimeout(() => pending === next && riversAlone(next), 300); // mostly their land comes before
    else riversAlone(next);
  }

  function riversAlone(next) {
    const { data } = next;
    if (now && !sameGrid(now.data.grid, data.grid)) return; // they wait for their land
    if (now) {
      show(
        { ...now, rivers: next.rivers, data: { ...now.data, rivers: data.rivers, ridges: data.ridges } },
        { report: false },
      );
    } else {
      const land = new Land(data.grid, null);
      show({ data: dataOf(data.grid, data), land, rivers: next.rivers, water: new Water(land, '', false) });
    }
    stale(true);
  }

  function heights(header, values) {
    if (isEmpty()) return;
    const { grid, width, height, cells, min, max, nodata, sea, level } = header;
    const about_ = { width, height, cells, min, max, nodata };
    const land = new Land(grid, about_, values, sea);
    const of = [pending, now].find((made_) => made_ && sameGrid(made_.data.grid, grid));
    if (level === 'coarse' && now && !now.land.level && sameGrid(now.data.grid, grid)) {
      land.draft = true;
      land.steepest = now.land.steepness();
    }
    const data = {
      ...dataOf(grid, of?.data),
      heights: about_,
      sea,
      lakes: false,
      summits: [],
      contour_m: of?.data.contour_m || Number(((max - min) / 40).toPrecision(1)) || 1,
    };
    show(
      { data, land, rivers: of?.rivers ?? new Rivers(noData.rivers, null, ''), water: new Water(land, '', false) },
      { report: false },
    );
    state.level = level;
    stale(true);
    if (sent && header.job >= sent.job) seen(sent, level);
  }
  async function seen(what, level) {
    await oneFrame();
    if (what !== sent) return;
    const ms = Math.round(performance.now() - what.at);
    state.times.first ??= ms;
    if (level === 'full') state.times.full = ms;
  }

  let made = null; // of the last scene: {job, lines, rivers, water, text}
  function scene(message) {
    if (isEmpty()) return;
    const { data, lines, water: text, level, job } = message;
    if (level === 'rivers') {
      rivers(message);
      return;
    }
    pending = null;
    const land = !data.heights
      ? now?.land.level && sameGrid(now.data.grid, data.grid)
        ? now.land
        : new Land(data.grid, null)
      : now && state.level === 'full' && !now.land.level && sameGrid(now.data.grid, data.grid)
        ? now.land
        : new Land(data.grid, data.heights, link.heights, data.sea);
    const same = made && made.job === job && made.lines === lines && made.land === land && made.text === text;
    const net = same ? made.rivers : new Rivers(data.rivers, data.ridges, lines);
    const water = same ? made.water : new Water(land, text, data.lakes);
    made = { job, lines, land, text, rivers: net, water };
    const measured = level === 'measured';
    show({ data: measured ? data : dataOf(data.grid, data), land, rivers: net, water }, { report: measured });
    stale(!measured);
  }

  function hold(on) {
    if (on === holding || (on && (!before || !page))) return;
    holding = on;
    compare.setAttribute('aria-pressed', String(on));
    root.dataset.before = on ? 'on' : 'off';
    page.replace(on ? before : now, { report: false });
    if (on) page.bindLength({ least: L.least, changing() {}, changed() {} }, before.data.rivers.prune);
    else above();
  }
  for (const [kind, on] of [
    ['pointerdown', true],
    ['pointerup', false],
    ['pointerleave', false],
    ['pointercancel', false],
    ['blur', false],
  ]) {
    compare.addEventListener(kind, () => hold(on));
  }
  for (const [kind, on] of [['keydown', true], ['keyup', false]]) {
    compare.addEventListener(kind, (event) => [' ', 'Enter'].includes(event.key) && hold(on));
  }
  window.addEventListener('keyup', (event) => event.key.toLowerCase() === 'b' && hold(false));
  window.addEventListener('blur', () => hold(false));
  window.addEventListener('keydown', (event) => {
    const letter = event.key.toLowerCase();
    if (typing(event) && !(event.target.tagName === 'SELECT')) return;
    if ((event.ctrlKey || event.metaKey) && (letter === 'z' || letter === 'y')) {
      const again = letter === 'y' || event.shiftKey;
      if (!again && sheet?.back()) event.preventDefault();
      else if (!(again ? redo : undo).disabled) (again ? redo : undo).click();
      event.preventDefault();
    } else if (
      letter === 'b' && !event.ctrlKey && !event.metaKey && !event.altKey && event.target.tagName !== 'SELECT'
    ) {
      hold(true);
    }
  });

  const ends = ({ job }) => {
    page?.view.hurry?.(false);
    working = false;
    finished = job;
    bar.classList.remove('on');
  };
  const link = new Link({
    opened() {
      tellAll('');
      side.inert = false;
      working = false;
    },
    lost(attempts) {
      side.inert = true;
      working = false;
      awaited = finished = 0;
      bar.classList.remove('on');
      tell('');
      tellAll(
        attempts > 3
          ? 'thalweg studio has ended; start it again and reload'
          : 'The connection to thalweg studio was lost; trying again…',
      );
    },
    document(message) {
      // in another window
      if (state.revision !== undefined && message.revision > state.revision && unanswered === 0) begins();
      current = message;
      state.revision = message.revision;
      form.show(message);
      above();
      command.replaceChildren(copyable(message.command, 'the command'));
      sheet?.follow();
    },
    busy({ job, stage, share }) {
      working = true;
      // A stage of several passes does not run backwards.
      done =
        done.job === job && done.stage === stage
          ? { ...done, share: Math.max(done.share, share) }
          : { job, stage, share };
      bar.classList.add('on');
      bar.firstElementChild.style.width = `${(100 * done.share).toFixed(1)}%`;
      tell(
        stage.replace(/_/g, ' ') +
          (done.share > 0 && done.share < 1 ? ` ${Math.round(100 * done.share)}\u00a0%` : ''),
        { running: true },
      );
    },
    idle(message) {
      ends(message);
      // one that a later job ended is not done
      tell(state.busy || !page ? '' : message.stopped ? 'stopped' : `done in ${seconds(message.seconds)}`);
    },
    failed(message) {
      ends(message);
      tell(message.error, { bad: true });
      if (!page && drawn) flat(drawn.grid);
    },
    drawing,
    cluster: (message) => cluster.show(message),
    scene,
    heights,
    say: ({ text }) => say(text),
    findings: ({ list }) => warn(list),
  });
  Object.assign(state, {
    level: null,
    /**
     * {set, value} | {unset} | {recipe} | {name, steps}: a promise of the reply, which rejects with the program's
     * words.
     */
    run: (one_) => ask({ do: 'edit', edit: stepsOf(one_) }),
    undo: () => ask({ do: 'undo' }),
    redo: () => ask({ do: 'redo' }),
    recipe: () => current.recipe,
    /** The program's last message of what is drawn, or null. */
    drawing: () => drawn,
    /** Takes a tool by its id; null: none. */
    hold: (tool) => page.tools.hold(tool),
    /** A verb of drawing: a promise of the reply, which rejects with the program's words. */
    draw: (what) => ask({ do: 'draw', revision: drawn?.revision, what }),
    export: (file) => link.ask(file ? { do: 'export', file } : { do: 'export' }),
  });
}
