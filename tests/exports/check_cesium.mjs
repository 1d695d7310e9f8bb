// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// check_cesium.mjs PAGE FOLDER: what Cesium makes of the tiles in FOLDER, which `export --for web` left, by the code that PAGE
// (docs/engines/web.md) shows. Figures as one JSON line on stdout, faults in words on stderr, exit 1 where there is one.
//
// Neighbouring tiles have the same heights along their edge, at every level. The height in the middle of a pixel lies among
// those of the pixels around it, and nearer to its own than where the pixels themselves are laid on the tile's edges: with such
// a provider, planted here, neighbours must differ by metres.
import * as Cesium from '@cesium/engine'
import { readFileSync } from 'node:fs'
import { PNG } from 'pngjs'

const EDGE_M = 1e-6 // of double arithmetic alone: the heights are the same
const FLOAT_M = 1e-3 // of heights as 32-bit floats
const STEPS_M = 1 // of the planted provider, at least
const NEARER = 0.7 // of the planted provider's misses; 0.51 for samples/relief.toml
const AGAIN = 2 // places for each sample along an edge: what lies between samples is compared too
const ADDRESS = 'https://example.org/terrain'

const [page, folder, ...more] = process.argv.slice(2)
if (!folder || more.length > 0) {
  console.error('usage: check_cesium.mjs PAGE FOLDER')
  process.exit(2)
}
const told = JSON.parse(readFileSync(`${folder}/export.json`))
const counts = {}
const examples = {}

function unless(holds, kind, where) {
  if (holds) return
  counts[kind] = (counts[kind] ?? 0) + 1
  if (counts[kind] <= 5) (examples[kind] ??= []).push(where)
}

/** The code of the page about Cesium, with the limits of this folder. */
function shown() {
  const blocks = [...readFileSync(page, 'utf8').matchAll(/^```js\n(.*?)^```/gms)].map((found) => found[1])
  const code = blocks.filter((block) => block.includes('new Cesium.')).join('')
  const limits = { bounds: told.bounds_degrees, minzoom: told.min_zoom, maxzoom: told.max_zoom }
  const line = /^const limits = .*;$/gm
  if (code.match(line)?.length !== 1) throw new Error(`${page}: not one line of limits beside Cesium`)
  return code.replace(line, `const limits = ${JSON.stringify(limits)};`)
}

// What a browser has and node has not. As in a browser, a colour is kept only where both options ask for it.
async function fetch(address) {
  if (!address.startsWith(`${ADDRESS}/heights/`)) throw new Error(`${address} is none of ours`)
  return { blob: async () => readFileSync(address.replace(ADDRESS, folder)) }
}
async function createImageBitmap(bytes, { colorSpaceConversion, premultiplyAlpha }) {
  if (colorSpaceConversion !== 'none' || premultiplyAlpha !== 'none') throw new Error('colours are changed')
  return PNG.sync.read(bytes)
}
class OffscreenCanvas {
  constructor(width, height) { this.size = [width, height] }
  getContext() {
    let drawn
    return {
      drawImage: (picture, x, y) => { drawn = { picture, x, y } },
      getImageData: (x, y, width, height) => {
        const sizes = [this.size, [drawn.picture.width, drawn.picture.height], [width, height]]
        if (sizes.flat().some((side) => side !== 256) || [x, y, drawn.x, drawn.y].some((place) => place !== 0)) {
          throw new Error(`a part of a picture: ${sizes}`)
        }
        return { data: drawn.picture.data }
      },
    }
  }
}

/** The provider that the page sets. */
function provided() {
  const viewer = { imageryLayers: { addImageryProvider: (colours) => { viewer.colours = colours } } }
  new Function('Cesium', 'viewer', 'fetch', 'createImageBitmap', 'OffscreenCanvas', shown())(
    Cesium, viewer, fetch, createImageBitmap, OffscreenCanvas)
  return viewer.terrainProvider
}

/** Heights of a picture, read by other code than that of the page. */
function samples([level, x, y]) {
  const { data } = PNG.sync.read(readFileSync(`${folder}/heights/${level}/${x}/${y}.png`))
  return Float32Array.from({ length: 256 * 256 }, (_, k) => data.readUIntBE(4 * k, 3) / 10 - 10000)
}

const tiles = told.files.map((name) => name.match(/^heights\/(\d+)\/(\d+)\/(\d+)\.png$/)).filter(Boolean)
  .map((found) => found.slice(1).map(Number))
const key = (tile) => tile.join('/')
const there = new Set(tiles.map(key))

/** Every tile as a function of longitude and latitude. */
async function surfaces(provider) {
  const out = new Map()
  for (const [level, x, y] of tiles) {
    const rectangle = provider.tilingScheme.tileXYToRectangle(x, y, level)
    const data = await provider.requestTileGeometry(x, y, level)
    out.set(key([level, x, y]), { rectangle, at: (longitude, latitude) => data.interpolateHeight(rectangle, longitude, latitude) })
  }
  return out
}

const mean = (values) => values.reduce((sum, value) => sum + value, 0) / values.length
const most = (values) => values.reduce((a, b) => Math.max(a, b), 0)

/** Differences of height along the edges that tiles of a level share. */
function steps(of, level) {
  const out = []
  for (const [, x, y] of tiles.filter((tile) => tile[0] === level)) {
    for (const [east, south] of [[1, 0], [0, 1]]) {
      const [here, other] = [[level, x, y], [level, x + east, y + south]].map((tile) => of.get(key(tile)))
      if (!other) continue
      const { west, south: bottom, width, height } = here.rectangle
      for (let k = 0; k <= 256 * AGAIN; ++k) {
        const share = k / (256 * AGAIN)
        const place = east ? [here.rectangle.east, bottom + share * height] : [west + share * width, bottom]
        out.push(Math.abs(here.at(...place) - other.at(...place)))
      }
    }
  }
  return out
}

/** The deepest level's pictures as one, whose rim goes on: its height at a column and a row of the whole world's. */
function mosaic() {
  const deepest = tiles.filter((tile) => tile[0] === told.max_zoom)
  const pictures = new Map(deepest.map((tile) => [key(tile), samples(tile)]))
  const ends = [1, 2].map((axis) => deepest.map((tile) => tile[axis]))
    .map((all) => [256 * Math.min(...all), 256 * Math.max(...all) + 255])
  return (...place) => {
    const [i, j] = place.map((at, axis) => Math.min(Math.max(at, ends[axis][0]), ends[axis][1]))
    return pictures.get(key([told.max_zoom, i >> 8, j >> 8]))[256 * (j & 255) + (i & 255)]
  }
}

/** How far the deepest level's heights are from the pictures in the middles of pixels; seen(holds, where): is each among its
 * neighbours? Higher up Cesium's interpolateHeight is off by up to half a row: it takes rows as even in latitude. */
function misses(of, scheme, seen) {
  const pixel = mosaic()
  const out = []
  for (const tile of tiles.filter((one) => one[0] === told.max_zoom)) {
    const [level, x, y] = tile
    const metres = scheme.tileXYToNativeRectangle(x, y, level)
    for (let k = 0; k < 256 * 256; ++k) {
      const [i, j] = [k & 255, k >> 8]
      const middle = scheme.projection.unproject(new Cesium.Cartesian3(
        metres.west + metres.width * (i + 0.5) / 256, metres.north - metres.height * (j + 0.5) / 256))
      const height = of.get(key(tile)).at(middle.longitude, middle.latitude)
      const around = [-1, 0, 1].flatMap((south) => [-1, 0, 1].map((east) => pixel(256 * x + i + east, 256 * y + j + south)))
      seen(height >= Math.min(...around) - FLOAT_M && height <= Math.max(...around) + FLOAT_M,
        `${key(tile)}, pixel ${i}, ${j}: ${height}`)
      out.push(Math.abs(height - pixel(256 * x + i, 256 * y + j)))
    }
  }
  return out
}

/** Which tiles Cesium asks for: those that are there, and the whole globe above them. */
async function checkAvailable(provider) {
  for (const [level, x, y] of tiles) {
    for (const near of [[level, x - 1, y], [level, x + 1, y], [level, x, y - 1], [level, x, y + 1], [level + 1, 2 * x, 2 * y]]) {
      const [z, column, row] = near
      unless(provider.getTileDataAvailable(column, row, z) === there.has(key(near)), 'available', key(near))
    }
  }
  for (let level = 0; level < told.min_zoom; ++level) {
    unless(provider.getTileDataAvailable(0, 0, level), 'available', `${level}/0/0`)
    const data = await provider.requestTileGeometry(0, 0, level)
    const rectangle = provider.tilingScheme.tileXYToRectangle(0, 0, level)
    const { longitude, latitude } = Cesium.Rectangle.center(rectangle)
    unless(data?.interpolateHeight(rectangle, longitude, latitude) === 0, 'globe', `${level}/0/0`)
  }
}

async function main() {
  const provider = provided()
  const scheme = provider.tilingScheme
  await checkAvailable(provider)
  const plain = new Cesium.CustomHeightmapTerrainProvider({
    tilingScheme: scheme, width: 256, height: 256, callback: (x, y, level) => samples([level, x, y]) })
  const [asShown, asTheyAre] = [await surfaces(provider), await surfaces(plain)]
  const figures = { cesium: globalThis.CESIUM_VERSION, edges: {}, planted_edges: {} }
  for (let level = told.min_zoom; level <= told.max_zoom; ++level) {
    const [edges, planted] = [asShown, asTheyAre].map((of) => steps(of, level))
    figures.edges[level] = { compared: edges.length, mean_m: mean(edges), max_m: most(edges) }
    figures.planted_edges[level] = { compared: planted.length, mean_m: mean(planted), max_m: most(planted) }
    unless(edges.length > 0, 'neighbours', level)
    unless(most(edges) <= EDGE_M, 'edges', `level ${level}: ${most(edges)} m`)
    unless(mean(planted) >= STEPS_M, 'planted', `level ${level}: steps of ${mean(planted)} m only`)
  }
  const middles = misses(asShown, scheme, (holds, where) => unless(holds, 'surroundings', where))
  const planted = misses(asTheyAre, scheme, () => {})
  figures.middles = { compared: middles.length, mean_m: mean(middles), max_m: most(middles) }
  figures.planted_middles = { compared: planted.length, mean_m: mean(planted), max_m: most(planted) }
  unless(mean(middles) < NEARER * mean(planted), 'middles', `${mean(middles)} m, planted ${mean(planted)} m`)
  for (const [kind, count] of Object.entries(counts)) {
    console.error(`check_cesium.mjs: ${kind} (${count}): ${examples[kind].join('; ')}`)
  }
  const short = (_, value) => typeof value === 'number' ? Number(value.toPrecision(4)) : value
  console.log(JSON.stringify({ ...figures, violations: counts, examples }, short))
  return Object.keys(counts).length > 0 ? 1 : 0
}

process.exitCode = await main()
