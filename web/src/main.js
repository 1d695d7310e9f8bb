// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The page: what is packed in it, and a view of it.
import './style.css';
import { Land } from './land.js';
import { tellAll } from './elements.js';
import { Page } from './page.js';
import { Rivers } from './rivers.js';
import { Studio } from './studio.js';
import { Water } from './water.js';

const text = (id) => document.getElementById(id).textContent;
const state = (window.__thalweg = { ready: false, mode: null, error: null, kept: 0, pick: () => null });

function fail(error) {
  state.error = String(error?.message ?? error);
  tellAll(`This page cannot be shown: ${state.error}`);
}

function packed() {
  const data = JSON.parse(text('data'));
  const land = new Land(data.grid, data.heights, text('heights'), data.sea);
  return {
    data,
    land,
    rivers: new Rivers(data.rivers, data.ridges, text('lines')),
    water: new Water(land, text('water'), data.lakes),
  };
}

window.addEventListener('error', (event) => fail(event.error ?? event.message));
try {
  const studio = text('studio').trim();
  if (studio.startsWith('{')) new Studio(JSON.parse(studio), state);
  else new Page(packed(), state);
} catch (error) {
  fail(error);
  console.error(error);
}
