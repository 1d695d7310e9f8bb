// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Drawing on a page of the studio: its tools, what lies over the view, and what stands beside the toolbar.
import { Desk } from './desk.js';
import { Cut, Join, Pin, Select } from './edits.js';
import { round } from './hand.js';
import { Inspector } from './inspector.js';
import { Overlay } from './overlay.js';
import { Pen } from './pens.js';

const icons = {
  select: 'M5 3v12.5l3.4-3.2 2.2 5 2.2-1-2.2-4.9 4.7-.2Z',
  river: 'M2 17.5c5 .6 2.6-5 7-5M14.2 3.2l2.6 2.6L11 11.6 7.8 12.2l.6-3.2Z',
  cut:
    'M8 15.2a2.4 2.4 0 1 1-4.8 0 2.4 2.4 0 0 1 4.8 0ZM16.8 15.2a2.4 2.4 0 1 1-4.8 0 2.4 2.4 0 0 1 4.8 0Z' +
    'M6.8 13.2 13.4 2.5M13.2 13.2 6.6 2.5',
  join: 'M3 3c3 0 3 7 7 7h7M3 17c3 0 4-3 5-5M14 7l3 3-3 3',
  coast:
    'M2 13c2-.5 2.5-3 4.5-3.5S9 5 11.5 5.5 13 3 18 2.5' +
    'M9 14.5c1.5-1.3 2.5 1 4 0s2.5 1 4.5 0M4 18c1.5-1.3 2.5 1 4 0s2.5 1 4 0 2.5.8 4 0',
  lake: 'M2.5 11.5c0-4 3-4 5-6s7-1.5 9 2 .5 8-3.5 8.5-10.5-.5-10.5-4.5ZM6.5 12.5c1.5-1.3 2.7 1 4.2 0s2.3-.3 2.8 0',
  mask: 'M2.5 2.5h15v15h-15ZM6 12.5l1.5-6 6-.5 1 5-3.5 3.5Z',
  pin: 'M10 18c-1-3.5-5-5.5-5-9.5a5 5 0 0 1 10 0c0 4-4 6-5 9.5ZM12 8.5a2 2 0 1 1-4 0 2 2 0 0 1 4 0Z',
  ridge: 'M1.5 15.5 7 6l3 5 2.5-3.5 6 8M4.5 18h1.5M9 18h1.5M13.5 18h1.5',
};

/** For the list of keys. */
export const drawingKeys = [
  ['R, O, A, S, G', 'draw a river, a coast, a lake, a mask, a ridge: drag, or point by point'],
  ['H', 'pin a height'],
  ['Enter, double click', 'end of a line'],
  ['Backspace', 'back by a point'],
  ['V, K, J', 'choose and edit, cut, join'],
  ['Delete', 'the chosen vertex, or all that is chosen'],
  ['Escape', 'put away'],
  ['space bar and drag', 'move the view with a tool in the hand'],
];

/** The tools in the order of the toolbar. */
function drawingTools(desk, overlay) {
  const points = (line) => line.map(round);
  const pen = (about) => new Pen(desk, overlay, { avoids: about.kind, ...about });
  return [
    new Select(desk, overlay, {
      id: 'select',
      group: 1,
      letter: 'v',
      title: 'Select and edit',
      icon: icons.select,
      help: 'Press a line to choose it, drag its vertices; page down goes to the next one',
    }),
    pen({
      id: 'river',
      group: 1,
      letter: 'r',
      title: 'Draw a river',
      icon: icons.river,
      kind: 'river',
      snaps: ['river', 'coast', 'border'],
      help: 'Drag, or set points and end with Enter',
      what: (line, { type, lambda }) => ({ verb: 'river', points: line, type, lambda }),
    }),
    new Cut(desk, overlay, {
      id: 'cut',
      group: 1,
      letter: 'k',
      title: 'Cut a river',
      icon: icons.cut,
      help: 'Press a river where it is to be cut',
    }),
    new Join(desk, overlay, {
      id: 'join',
      group: 1,
      letter: 'j',
      title: 'Join a river to another',
      icon: icons.join,
      help: 'Press an end of a river, then the river that it joins',
    }),
    pen({
      id: 'coast',
      group: 2,
      letter: 'o',
      title: 'Draw a coast',
      icon: icons.coast,
      kind: 'coast',
      snaps: ['border'],
      closes: 'maybe',
      help: 'From border to border, or around an island',
      what: (line) => ({ verb: 'coast', points: points(line) }),
    }),
    pen({
      id: 'lake',
      group: 2,
      letter: 'a',
      title: 'Draw a lake',
      icon: icons.lake,
      kind: 'lake',
      snaps: [],
      closes: true,
      help: 'Drag around it, or set points and end with Enter',
      what: (line, { level }) => ({ verb: 'lake', points: points(line), level }),
    }),
    pen({
      id: 'mask',
      group: 2,
      letter: 's',
      title: 'Draw a mask: only what lies in it gets heights',
      icon: icons.mask,
      kind: 'mask',
      snaps: [],
      closes: true,
      help: 'Drag around the land that is to have heights',
      what: (line) => ({ verb: 'mask', points: points(line) }),
    }),
    new Pin(desk, overlay, {
      id: 'pin',
      group: 3,
      letter: 'h',
      title: 'Pin a height',
      icon: icons.pin,
      help: 'Press the land, and type the height that it has there',
    }),
    pen({
      id: 'ridge',
      group: 3,
      letter: 'g',
      title: 'Draw a ridge',
      icon: icons.ridge,
      kind: 'ridge',
      avoids: 'river',
      snaps: [],
      help: 'Drag, or set points and end with Enter; no water crosses it',
      what: (line) => ({ verb: 'ridge', points: points(line) }),
      then: ({ drawing }) => desk.choose(drawing.ridges.at(-1)),
    }),
  ];
}

/** page: of page.js; ask, revision, bends: as for Desk; types: of rivers. */
export function openSheet({ view, tools }, { ask, revision, bends, types }) {
  const desk = new Desk(view, { ask, revision, bends });
  const overlay = new Overlay(desk);
  const beside = new Inspector(desk, types);
  const all = drawingTools(desk, overlay);
  for (const tool of all) tools.add(tool);
  const drawn = view.ondraw;
  view.ondraw = (turn) => {
    desk.heading = turn;
    overlay.stale();
    drawn(turn);
  };
  tools.layer((pen, place) => {
    if (!desk.drawing) return;
    overlay.paint(pen, place, desk.tool !== null);
    beside.follow();
  });
  desk.onchange = () => {
    if (!desk.drawing) return;
    beside.show();
    tools.draw();
  };
  desk.onrefused = (ghost) => {
    if (ghost?.pen && ghost.pen === desk.tool) ghost.pen.resume(ghost);
  };
  return {
    desk,
    take: (message) => desk.take(message),
    /** The document or the land has changed. */
    follow: () => desk.onchange(),
    /**
     * Takes back the last step of a line that is drawn point by point, or what the program has not got yet; false:
     * there is none.
     */
    back: () => (desk.tool?.back?.() ?? false) || desk.recall(),
  };
}
