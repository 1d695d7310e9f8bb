// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The page's second life: it is served by `thalweg studio`, shows what the program makes, and edits its recipe.
import './studio.css';
import { byId, make, tellAll } from './elements.js';
import { Exporting } from './exporting.js';
import { typing } from './keys.js';
import { Link } from './link.js';
import { Page } from './page.js';
import { Messages, Progress } from './progress.js';
import { Questions } from './questions.js';
import { Scenes } from './scenes.js';
import { drawingKeys, openSheet } from './sheet.js';
import { Side } from './side.js';

const seconds = (s) => (s < 1 ? `${Math.round(1000 * s)} ms` : `${s.toFixed(1)} s`);
const studioKeys = [
  ...drawingKeys,
  ['Ctrl+Z', 'undo'],
  ['Ctrl+Shift+Z, Ctrl+Y', 'redo'],
  ['B', 'hold: before the last edit'],
];

/** The page stands beside the recipe, its panel folded where there is no room for both. */
function makeRoom(folder) {
  const { dataset } = document.documentElement;
  dataset.studio = 'on';
  dataset.panel = innerWidth < 1500 ? 'off' : 'on';
  byId('bpanel').setAttribute('aria-pressed', String(dataset.panel === 'on'));
  const name = folder.split(/[\\/]/).filter(Boolean).at(-1) ?? 'thalweg studio';
  document.title = name;
  byId('title').textContent = name;
}

/** The button that shows what was before, as long as it is pressed; hold(on) does it. */
function compareButton(hold) {
  const title = 'Hold to see the terrain before the last edit (B)';
  const button = make('button', { type: 'button', textContent: 'Before', title, disabled: true });
  button.setAttribute('aria-pressed', 'false');
  button.addEventListener('pointerdown', () => hold(true));
  for (const kind of ['pointerup', 'pointerleave', 'pointercancel', 'blur']) {
    button.addEventListener(kind, () => hold(false));
  }
  const isPress = ({ key }) => key === ' ' || key === 'Enter';
  button.addEventListener('keydown', (event) => isPress(event) && hold(true));
  button.addEventListener('keyup', (event) => isPress(event) && hold(false));
  return button;
}

/** The keys of the studio: undo, redo, and what was before. */
function followKeys(studio) {
  const { scenes, side } = studio;
  window.addEventListener('keyup', (event) => event.key.toLowerCase() === 'b' && scenes.hold(false));
  window.addEventListener('blur', () => scenes.hold(false));
  window.addEventListener('keydown', (event) => {
    const letter = event.key.toLowerCase();
    const isSelect = event.target instanceof HTMLSelectElement;
    if (typing(event) && !isSelect) return;
    const withControl = event.ctrlKey || event.metaKey;
    if (withControl && (letter === 'z' || letter === 'y')) {
      const again = letter === 'y' || event.shiftKey;
      if (again || !studio.sheet?.back()) side.press(again);
      event.preventDefault();
    } else if (letter === 'b' && !withControl && !event.altKey && !isSelect) scenes.hold(true);
  });
}

/** What the studio's page tells about itself, and takes, besides what a page does (page.js). */
function tellState(studio) {
  const { state } = studio;
  Object.defineProperty(state, 'busy', {
    get: () => studio.questions.isWaiting || (studio.sheet?.desk.waits ?? false),
  });
  Object.defineProperty(state, 'job', { get: () => studio.link.job });
  Object.assign(state, {
    level: null,
    /** {set, value} | {unset} | {recipe} | {name, steps}: a promise of the reply, as the others. */
    run: (edit) => studio.ask({ do: 'edit', edit: edit.steps ? edit : { name: '', steps: [edit] } }),
    undo: () => studio.ask({ do: 'undo' }),
    redo: () => studio.ask({ do: 'redo' }),
    recipe: () => studio.document.recipe,
    /** The program's last message of what is drawn, or null. */
    drawing: () => studio.drawing,
    /** Takes a tool by its id; null: none. */
    hold: (tool) => studio.page.tools.hold(tool),
    /** A verb of drawing. */
    draw: (what) => studio.ask({ do: 'draw', revision: studio.drawing?.revision, what }),
    export: (file) => studio.export(file),
  });
}

export class Studio {
  /** The view, once there is something to show. */
  page = null;
  /** What the tools draw on, once the page and a drawing are there. */
  sheet = null;
  /** The recipe and its history, as the program told last. */
  document = { values: {}, sections: [], undo: '', redo: '', command: '', recipe: '' };
  /** The program's last message of what is drawn. */
  drawing = null;

  /** about: what the page was given by the program; state: what it tells about itself to whoever asks. */
  constructor(about, state) {
    this.about = about;
    this.state = state;
    makeRoom(about.folder);
    this.progress = new Progress(() => this.link.ask({ do: 'stop' }).catch(() => {}));
    this.messages = new Messages();
    this.questions = new Questions(this);
    this.scenes = new Scenes(this);
    this.compare = compareButton((on) => this.scenes.hold(on));
    this.side = new Side(this, this.compare);
    this.exporting = new Exporting((file) => this.export(file));
    followKeys(this);
    tellState(this);
    this.link = new Link(this.#answers());
  }

  /** What the program says of a key of the recipe. */
  keyOf = (path) => this.about.keys.find((key) => key.path === path);

  /** Asks the program: a promise of the reply, which rejects with its words. */
  ask = (question) => this.questions.ask(question);

  /** Writes a file, or all of them: a promise of the reply. */
  export(file) {
    return this.link.ask(file ? { do: 'export', file } : { do: 'export' });
  }

  /** Whether no land is to come: what comes all the same was under way before. */
  get isEmpty() {
    const drawing = this.drawing;
    return drawing?.kind === 'drawn' && drawing.rivers.length === 0 && drawing.revision >= this.state.revision;
  }

  /** Shows the first scene. */
  open(scene) {
    this.page = new Page(scene, this.state, studioKeys);
    this.state.heights = () => this.link.heights;
    byId('controls').hidden = false;
    this.side.showFirst();
    this.#showDrawing();
  }

  #showDrawing() {
    if (!this.page || !this.drawing) return;
    const types = (this.keyOf('network.rosgen')?.choices ?? []).filter((type) => !type.startsWith('by_'));
    this.sheet ??= openSheet(this.page, {
      ask: this.ask,
      revision: () => this.state.revision,
      bends: () => Number(this.document.values['network.meander']) > 0,
      types,
    });
    this.sheet.take(this.drawing);
  }

  #takeDrawing(message) {
    const { page, scenes } = this;
    // Rivers that were shown on level ground, or were about to be, go too; another grid is another sheet.
    const isEmptied = page && !scenes.isFlat(message.grid);
    this.drawing = message;
    // Where rivers are shown and none is there, a given land comes.
    if (message.kind === 'drawn' && message.rivers.length === 0) {
      if (isEmptied) scenes.flatten(message.grid);
      else if (!page) setTimeout(() => this.page || scenes.flatten(message.grid), 300);
    }
    this.#showDrawing();
  }

  #takeDocument(message) {
    const { questions, state } = this;
    const isNewer = state.revision !== undefined && message.revision > state.revision;
    if (isNewer && !questions.isAsking) questions.keep(); // in another window
    this.document = message;
    state.revision = message.revision;
    this.side.show();
    this.exporting.showCommand(message.command);
    this.sheet?.follow();
  }

  #endJob({ job }) {
    this.questions.end(job);
    this.progress.end();
  }

  #lose(attempts) {
    this.side.element.inert = true;
    this.questions.forget();
    this.progress.end();
    this.progress.tell('');
    tellAll(
      attempts > 3
        ? 'thalweg studio has ended; start it again and reload'
        : 'The connection to thalweg studio was lost; trying again…',
    );
  }

  /** What the page does with each message (link.js). */
  #answers() {
    const { messages, progress, questions, scenes, side } = this;
    return {
      opened: () => {
        tellAll('');
        side.element.inert = false;
        questions.isWorking = false;
      },
      lost: (attempts) => this.#lose(attempts),
      document: (message) => this.#takeDocument(message),
      busy: (message) => {
        questions.isWorking = true;
        progress.run(message);
      },
      idle: (message) => {
        this.#endJob(message);
        const outcome = message.stopped ? 'stopped' : `done in ${seconds(message.seconds)}`;
        progress.tell(this.state.busy || !this.page ? '' : outcome); // one that a later job ended is not done
      },
      failed: (message) => {
        this.#endJob(message);
        progress.tell(message.error, { isBad: true });
        if (!this.page && this.drawing) scenes.flatten(this.drawing.grid);
      },
      drawing: (message) => this.#takeDrawing(message),
      cluster: (message) => side.cluster.show(message),
      scene: (message) => scenes.scene(message),
      heights: (header, values) => scenes.heights(header, values),
      say: ({ text }) => messages.add(text),
      findings: ({ list }) => {
        this.state.findings = list;
        messages.warn(list);
      },
    };
  }
}
