// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The page's JSON (README.md) of a scene of which nothing is known yet.
const noArcs = {
  id: [], ds: [], basin: [], strahler: [], shreve: [], hack: [], survives: [], length: [],
  z_up: [], z_down: [], us_area: [], ds_area: [], n: [],
};
const none = { count: 0, shown: [] };

export const noData = {
  command: '', recipe: '', crs: '', contour_m: 0, rivers: { step: 1, prune: 0, arcs: noArcs }, ridges: null,
  sea: null, lakes: false, summits: [], profiles: [], curve: null, hypsometry: null,
  laws: { rows: [], support: null, orders: [], dem_orders: [], hack: {}, concavity: {} },
  relief: null, statistics: [], given: [], checks: [], timings: [],
  warnings: none, repairs: none, findings: none, notes: [],
};
