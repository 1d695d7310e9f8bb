// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What stands beside the toolbar while one draws: what is chosen, and what can be done with it; and words at the
// pointer.
import { make } from './elements.js';

const press = (text, title, click) => {
  const b = make('button', { type: 'button', textContent: text, title });
  b.addEventListener('click', click);
  return b;
};

/** Words over the view: they lie at a place of the land or at the pointer. */
function saying(desk, stage) {
  const box = make('div', { id: 'saying', hidden: true });
  const spoken = make('p', { className: 'unseen', id: 'drawing-said' });
  spoken.setAttribute('role', 'status');
  box.setAttribute('aria-hidden', 'true'); // it is spoken
  stage.append(box, spoken);
  let at = null;
  let fading;
  let pointer = { x: 0, y: 0 };
  window.addEventListener('pointermove', (event) => (pointer = desk.pixel(event)), { capture: true, passive: true });
  desk.speak = (text) => {
    spoken.textContent = text;
  };
  desk.quiet = () => {
    clearTimeout(fading);
    box.hidden = true;
  };
  const follow = () => {
    if (box.hidden) return;
    const p = (at?.place && desk.view.place(...at.place)) || at?.pixel;
    const { clientWidth, clientHeight } = desk.view.parent;
    const [w, h] = [box.offsetWidth, box.offsetHeight];
    const above = p.y - h - 14;
    box.style.left = `${Math.min(Math.max(p.x - w / 2, 8), clientWidth - w - 8)}px`;
    box.style.top = `${Math.min(above < 8 ? p.y + 18 : above, clientHeight - h - 8)}px`;
  };
  desk.ontell = (text, { at: place, bad = false }) => {
    desk.quiet();
    const cursor = desk.cursor && [desk.cursor.x, desk.cursor.y];
    at = { place: place ?? cursor, pixel: pointer };
    box.textContent = text;
    box.classList.toggle('bad', bad);
    box.hidden = false;
    follow();
    desk.speak(text);
    if (!bad) fading = setTimeout(desk.quiet, 6000);
  };
  return follow;
}

/** types: of rivers. Gives {show(), follow(): words go with the view}. */
export function inspector(desk, types) {
  const stage = document.getElementById('stage');
  const follow = saying(desk, stage);
  const change = (what) => desk.send(what);
  const chosen = (kind) => (desk.chosen?.kind === kind ? desk.chosen : null);

  const title = make('p', { className: 'what' });
  const note = make('p', { className: 'hint' });
  const type = make('select', { id: 'river-type' });
  const lambda = make('input', {
    type: 'number',
    id: 'river-lambda',
    min: 1,
    max: 50,
    step: 1,
    placeholder: 'recipe',
    autocomplete: 'off',
  });
  const level = make('input', {
    type: 'number',
    id: 'lake-level',
    step: 'any',
    placeholder: 'by the terrain',
    autocomplete: 'off',
  });
  const field = (label, control, unit) =>
    make(
      'div',
      { className: 'row' },
      make('label', { htmlFor: control.id, textContent: label }),
      control,
      unit && make('span', { textContent: unit }),
    );
  const height = make('input', { type: 'number', id: 'pin-height', step: 'any', autocomplete: 'off' });
  const [from, to] = ['from', 'to'].map((end) =>
    make('input', {
      type: 'number',
      id: `ridge-${end}`,
      step: 'any',
      placeholder: 'by the terrain',
      autocomplete: 'off',
    }),
  );
  const [typeRow, lambdaRow, levelRow] = [field('Type', type), field('Branching', lambda), field('Level', level, 'm')];
  const [heightRow, fromRow, toRow] = [
    field('Height', height, 'm'),
    field('Begins at', from, 'm'),
    field('Ends at', to, 'm'),
  ];
  fromRow.title = toRow.title =
    'Height of the ridge at its end; one alone: it is level; none: it is as high as the terrain';
  lambdaRow.title =
    'Generator lambda of the side streams: 1 has none, 2 is dendritic, larger values are feathered; ' +
    'empty: as the recipe says';

  type.addEventListener('change', () => {
    const river = chosen('river');
    const { value } = type;
    if (river) change((same) => ({ verb: 'type', rivers: [same(river).n], type: value }));
    else desk.type = value;
  });
  lambda.addEventListener('change', () => {
    const river = chosen('river');
    const value = Math.min(50, Math.max(0, Math.round(Number(lambda.value) || 0)));
    if (river) change((same) => ({ verb: 'lambda', rivers: [same(river).n], lambda: value }));
    else desk.lambda = value;
  });
  level.addEventListener('change', () => {
    const lake = chosen('lake');
    const value = level.value.trim() === '' ? null : Number(level.value);
    if (lake) change((same) => ({ verb: 'level', lake: same(lake).n, level: value }));
    else desk.level = value;
  });

  const metres = ({ value }) => (value.trim() === '' ? null : Number(value));
  /** What is chosen has other heights at once, and the former ones again where they are refused. */
  const raise = async (verb, object, heights) => {
    const before = { ...object };
    Object.assign(object, heights);
    if (await change((same) => ({ verb, [object.kind]: same(object).n, ...heights }))) return;
    Object.assign(object, before);
    desk.onchange();
  };
  height.addEventListener('change', () => {
    const pin = chosen('pin');
    if (pin && metres(height) !== null) raise('height', pin, { height: metres(height) });
    else fields(true); // a pin has a height
  });
  for (const end of [from, to]) {
    end.addEventListener('change', () => {
      const ridge = chosen('ridge');
      if (ridge) raise('heights', ridge, { from: metres(from), to: metres(to) });
    });
  }
  // Enter and Escape lead back to the land, where the next one is drawn.
  for (const input of [height, from, to]) {
    input.addEventListener('keydown', (event) => {
      if (event.key === 'Escape') fields(true);
      if (event.key !== 'Enter' && event.key !== 'Escape') return;
      desk.view.canvas.focus({ preventScroll: true });
      event.stopPropagation();
    });
  }
  desk.onask = () => {
    const input = desk.chosen?.kind === 'ridge' ? from : height;
    input.focus({ preventScroll: true });
    input.select();
  };

  const reverse = press('Reverse', 'The river and all below it run the other way', () => {
    const river = chosen('river');
    change((same) => ({ verb: 'reverse', river: same(river).n }));
  });
  const swap = press('Swap land and sea', 'Land and sea change sides', () => {
    const coast = chosen('coast');
    change((same) => ({ verb: 'swap', coast: same(coast).n }));
  });
  const erase = press('Delete', '', () => desk.remove());
  const alone = press('Delete alone', 'The rivers that flow into it stay (Shift+Delete)', () => desk.remove(true));
  const finish = press('End the line', '(Enter, double click)', () => desk.tool.finish());
  const back = press('Take back', 'The last point (Backspace)', () => desk.tool.back());
  const actions = make('div', { className: 'actions' }, finish, back, reverse, swap, erase, alone);

  const branching = make('input', { type: 'checkbox', id: 'branching' });
  branching.title = 'Every river grows a network of side streams';
  branching.addEventListener('change', () => change({ verb: 'branching', on: branching.checked }));
  const clear = press('Clear sheet', 'An empty sheet: nothing is drawn on it', async () => {
    const { drawing } = desk;
    desk.choose(null);
    if (await desk.send({ verb: 'clear' }, { kind: 'river', line: [], hides: drawing.objects })) {
      desk.ontell('An empty sheet. Undo (Ctrl+Z) brings everything back', {});
    }
  });
  const whole = make('div', { className: 'whole' }, make('label', {}, branching, 'side streams'), clear);
  const box = make(
    'section',
    { id: 'inspector', hidden: true },
    title,
    note,
    typeRow,
    lambdaRow,
    levelRow,
    heightRow,
    fromRow,
    toRow,
    actions,
    whole,
  );
  box.setAttribute('aria-label', 'Drawing');
  const hint = make('p', { id: 'sheet-hint', hidden: true });
  hint.append('Draw a river ', make('kbd', { textContent: 'R' }), ': from its source to the sea, or the other way');
  document.getElementById('view').after(box);
  stage.append(hint);

  /** A field shows a value unless somebody is typing in it. */
  let shown = null; // whose values the fields have
  const put = (input, value, always) => {
    if (always || document.activeElement !== input) input.value = value;
  };
  function fields(always = desk.chosen?.kind !== shown?.kind || desk.chosen?.n !== shown?.n) {
    const river = chosen('river');
    const lake = chosen('lake');
    const pin = chosen('pin');
    const ridge = chosen('ridge');
    shown = desk.chosen;
    heightRow.hidden = !pin;
    fromRow.hidden = toRow.hidden = !ridge;
    if (pin) put(height, pin.height, always);
    if (ridge) put(from, ridge.from ?? '', always);
    if (ridge) put(to, ridge.to ?? '', always);
    const tool = desk.tool?.id;
    typeRow.hidden = !(river || tool === 'river');
    lambdaRow.hidden = typeRow.hidden || !desk.drawing.branching;
    levelRow.hidden = !(lake || tool === 'lake');
    const value = river ? river.type : desk.type;
    const all = ['', ...types, ...(types.includes(value) || value === '' ? [] : [value])];
    if (all.join() !== Array.from(type.options, (o) => o.value).join()) {
      type.replaceChildren(...all.map((t) => make('option', { value: t, textContent: t || 'none' })));
    }
    type.value = value;
    put(lambda, (river ? river.lambda : desk.lambda) || '');
    put(level, (lake ? lake.level : desk.level) ?? '');
  }

  function words() {
    const { drawing, tool } = desk;
    const count = (n, word) => n > 0 && `${n} ${word}${n > 1 ? 's' : ''}`;
    const all = [
      count(drawing.rivers.length, 'river'),
      count(drawing.coasts.length, 'coast'),
      count(drawing.lakes.length, 'lake'),
      count(drawing.masks.length, 'mask'),
      count(drawing.pins.length, 'pin'),
      count(drawing.ridges.length, 'ridge'),
    ].filter(Boolean);
    title.textContent = desk.chosen ? desk.describe(desk.chosen) : tool.title.split(':')[0];
    note.textContent =
      drawing.kind === 'shown' && drawing.rivers.length
        ? 'The network becomes drawn lines; undo brings the generator back.'
        : desk.chosen
          ? ''
          : tool.id === 'select'
            ? `${all.join(', ') || 'Nothing is drawn'}.`
            : `${tool.help}.`;
    note.hidden = note.textContent === '';
  }

  function show() {
    const { drawing, tool } = desk;
    box.hidden = !tool || !drawing;
    hint.hidden =
      !drawing || drawing.rivers.length > 0 || !desk.fits || desk.ghosts.length > 0 || (tool?.line?.length ?? 0) > 0;
    if (box.hidden) return;
    words();
    fields();
    const river = chosen('river');
    reverse.hidden = !river;
    swap.hidden = !chosen('coast');
    erase.hidden = !desk.chosen;
    erase.textContent = desk.vertex >= 0 ? 'Delete vertex' : 'Delete';
    const erased =
      desk.vertex >= 0 ? 'The chosen vertex' : river ? 'The river with all that flow into it' : 'What is chosen';
    erase.title = `${erased} (Delete)`;
    alone.hidden = !river || desk.vertex >= 0 || drawing.above(river).length < 2;
    const open = (tool.line?.length ?? 0) > 0;
    finish.hidden = back.hidden = !open;
    actions.hidden = !desk.chosen && !open;
    branching.checked = drawing.branching;
    clear.disabled = drawing.empty;
  }
  return { show, follow };
}
