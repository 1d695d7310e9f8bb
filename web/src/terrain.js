// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The page of `thalweg export --for web`: MapLibre shows the tiles beside it, or those inside it where it is opened
// from disk.
import {
  addProtocol,
  AttributionControl,
  LngLat,
  Map,
  NavigationControl,
  ScaleControl,
  setWorkerUrl,
} from 'maplibre-gl';
import worker from 'maplibre-worker';
import 'maplibre-gl/dist/maplibre-gl.css';
import './terrain.css';
import { bytesOf } from './unpack.js';

const at = (id) => document.getElementById(id);
const inputAt = (id) => /** @type {HTMLInputElement} */ (at(id));
const data = JSON.parse(at('data').textContent);
const [west, south, east, north] = data.bounds;
const tilt = 62;
const state = (window.__thalweg = { ready: false, error: null, map: null });

/** Where tiles come from: the page's own address, or the page itself. */
function tileAddress() {
  if (!data.tiles) return new URL('.', location.href).href;
  const bytes = bytesOf(at('tiles').textContent);
  addProtocol('inside', async ({ url }) => {
    const [begin, size] = data.tiles[url.slice('inside://'.length)];
    return { data: bytes.slice(begin, begin + size).buffer };
  });
  return 'inside://';
}

async function riversOf() {
  if (typeof data.rivers !== 'string') return data.rivers;
  const answer = await fetch(data.rivers);
  if (!answer.ok) throw new Error(`${data.rivers}: ${answer.status} ${answer.statusText}`);
  return answer.json();
}

/**
 * Rivers, the wider the deeper blue.
 * @returns {import('maplibre-gl').LineLayerSpecification}
 */
function riverLayer() {
  return {
    id: 'rivers',
    type: 'line',
    source: 'rivers',
    layout: { 'line-cap': 'round', 'line-join': 'round' },
    paint: {
      'line-color': ['interpolate', ['linear'], ['get', 'width'], 1.2, '#4a8fd0', 5.4, '#124f9e'],
      'line-width': [
        'interpolate',
        ['exponential', 1.4],
        ['zoom'],
        data.min_zoom + 2,
        ['*', 0.6, ['get', 'width']],
        Math.max(data.min_zoom + 3, data.max_zoom + 1),
        ['*', 1.6, ['get', 'width']],
      ],
    },
  };
}

/** @returns {import('maplibre-gl').StyleSpecification} */
function styleOf(rivers) {
  const address = tileAddress();
  const ending = data.tiles ? '' : '.png';
  const limits = { bounds: data.bounds, minzoom: data.min_zoom, maxzoom: data.max_zoom };
  return {
    version: 8,
    sources: {
      heights: {
        type: 'raster-dem',
        tiles: [`${address}heights/{z}/{x}/{y}${ending}`],
        encoding: 'mapbox',
        tileSize: 256,
        ...limits,
      },
      colour: { type: 'raster', tiles: [`${address}colour/{z}/{x}/{y}${ending}`], tileSize: 256, ...limits },
      ...(rivers && { rivers: { type: 'geojson', data: rivers, tolerance: 0.1 } }),
    },
    layers: [
      { id: 'colour', type: 'raster', source: 'colour', paint: { 'raster-fade-duration': 0 } },
      ...(rivers ? [riverLayer()] : []),
    ],
    terrain: { source: 'heights', exaggeration: data.exaggeration },
  };
}

const times = (factor) => `${factor.toLocaleString('en', { maximumFractionDigits: 1 })}×`;
const metres = (z) => `${z.toLocaleString('en', { maximumFractionDigits: Math.abs(z) < 100 ? 1 : 0 })} m`;

/** The whole terrain, seen up its valley. */
function firstView(map) {
  const { center, zoom } = map.cameraForBounds([west, south, east, north], { bearing: data.bearing, padding: 20 });
  return { center, zoom: zoom + 0.45, bearing: data.bearing, pitch: tilt, padding: { bottom: 120 } };
}

function addControls(map) {
  map.addControl(new NavigationControl({ visualizePitch: true }), 'top-right');
  map.addControl(new ScaleControl(), 'bottom-left');
  map.addControl(new AttributionControl({ compact: false, customAttribution: 'thalweg' }), 'bottom-right');
  const slider = inputAt('exaggeration');
  slider.max = String(Math.max(5, data.exaggeration));
  slider.value = String(data.exaggeration);
  const say = () => {
    at('times').textContent = times(Number(slider.value));
  };
  slider.addEventListener('input', () => {
    say();
    map.setTerrain({ source: 'heights', exaggeration: Number(slider.value) });
  });
  say();
  at('label-rivers').hidden = !data.rivers;
  const shows = inputAt('show-rivers');
  shows.addEventListener('change', () =>
    map.setLayoutProperty('rivers', 'visibility', shows.checked ? 'visible' : 'none'),
  );
  at('reset').addEventListener('click', () => map.easeTo({ ...firstView(map), duration: 800 }));
}

/** Says the height under the pointer, or in the middle where the view is moved by keys. */
function followHeights(map) {
  const say = (place, words) => {
    const inside = place.lng >= west && place.lng <= east && place.lat >= south && place.lat <= north;
    const z = inside ? map.queryTerrainElevation(place) : null;
    at('height').textContent = z === null ? '' : `${words}${metres(z / map.getTerrain().exaggeration)}`;
  };
  map.on('mousemove', ({ lngLat }) => say(lngLat, ''));
  map.on('mouseout', () => say(map.getCenter(), 'middle: '));
  map.on('moveend', ({ originalEvent }) => originalEvent instanceof KeyboardEvent && say(map.getCenter(), 'middle: '));
}

async function show() {
  document.title = data.title || 'Terrain';
  at('title').textContent = document.title;
  at('facts').textContent = `${metres(data.min_m)} to ${metres(data.max_m)}`;
  // not a module: also from disk
  setWorkerUrl(`${URL.createObjectURL(new Blob([worker], { type: 'text/javascript' }))}#.cjs`);
  const map = new Map({
    container: 'map',
    style: styleOf(await riversOf()),
    attributionControl: false,
    maxPitch: 80,
    pitch: tilt,
    bearing: data.bearing,
    center: [0.5 * (west + east), 0.5 * (south + north)],
    zoom: data.min_zoom,
    minZoom: data.min_zoom + 1,
    maxZoom: Math.min(24, data.max_zoom + 3),
    renderWorldCopies: false,
    terrainSkirtLength: 'none',
    transformCameraUpdate: ({ center }) => ({
      // the terrain stays in sight
      center: new LngLat(
        Math.min(Math.max(center.lng, west), east),
        Math.min(Math.max(center.lat, south), north),
      ),
    }),
  });
  state.map = map;
  map.on('error', ({ error }) => fail(error));
  map.once('style.load', () => map.setSourceTileLodParams(1, 1)); // tiles of one level meet without gaps
  addControls(map);
  followHeights(map);
  map.jumpTo(firstView(map));
  map.once('idle', () => {
    state.ready = true;
  });
}

function fail(error) {
  state.error = String(error?.message ?? error);
  at('message').textContent =
    location.protocol === 'file:' && !data.tiles
      ? 'A browser does not let this page read its tiles from disk. Open terrain.html, or serve this folder: ' +
        'python3 -m http.server'
      : `The terrain cannot be shown: ${state.error}`;
  at('message').hidden = false;
}

show().catch(fail);
