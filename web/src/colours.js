// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Colours of the land and its rivers. Ramps are readable with the common kinds of colour blindness.

/** From the lowest to the highest: sage, straw, sand, clay, white, joined in OKLab; those of the printed map. */
export const tints = [
  [126, 166, 136], [137, 173, 140], [148, 181, 143], [159, 189, 147], [170, 196, 150], [185, 202, 155], [199, 208, 159],
  [214, 214, 164], [231, 210, 166], [227, 201, 162], [222, 193, 160], [225, 201, 177], [228, 209, 194], [233, 218, 207],
  [238, 227, 219], [243, 237, 231], [248, 246, 243]];

const plain = [[204, 199, 186]];
const steep = [[247, 245, 236], [240, 222, 176], [228, 178, 108], [205, 120, 62], [158, 62, 44], [96, 20, 40]];
// cyclic
const around = [
  [226, 217, 226], [120, 158, 196], [71, 74, 142], [47, 20, 54], [128, 44, 80], [190, 130, 108], [226, 217, 226],
];
const wet = [[246, 243, 231], [206, 224, 214], [140, 194, 208], [72, 148, 196], [30, 92, 164], [8, 40, 106]];
const change = [
  [24, 74, 138],
  [90, 146, 196],
  [178, 208, 226],
  [246, 244, 240],
  [244, 196, 156],
  [212, 118, 72],
  [140, 40, 28],
];
const patches = [
  [166, 206, 227],
  [253, 191, 111],
  [178, 223, 138],
  [202, 178, 214],
  [255, 237, 160],
  [190, 186, 150],
  [141, 211, 199],
  [251, 154, 153],
  [128, 177, 211],
  [217, 191, 155],
  [204, 235, 197],
  [229, 196, 148],
];

/** The ten forms of Jasiewicz and Stepinski (2013), in their order. */
export const forms = [
  ['flat', [220, 220, 220]],
  ['peak', [56, 0, 0]],
  ['ridge', [200, 0, 0]],
  ['shoulder', [255, 80, 20]],
  ['spur', [250, 210, 60]],
  ['slope', [255, 255, 60]],
  ['hollow', [180, 230, 20]],
  ['footslope', [60, 250, 150]],
  ['valley', [0, 0, 255]],
  ['pit', [0, 0, 56]],
];

/** Lines by order where the ground is plain. */
export const orderColours = [
  [110, 178, 214],
  [44, 127, 184],
  [0, 158, 115],
  [230, 159, 0],
  [213, 94, 0],
  [204, 121, 167],
  [120, 40, 110],
  [40, 40, 40],
];

export function mix(ramp, share) {
  if (ramp.length === 1) return ramp[0];
  const place = Math.min(Math.max(share, 0), 1) * (ramp.length - 1);
  const k = Math.min(Math.floor(place), ramp.length - 2);
  return ramp[k].map((c, i) => c + (ramp[k + 1][i] - c) * (place - k));
}

/** 256 colours RGBA of a ramp. */
function palette(ramp) {
  const bytes = new Uint8Array(1024);
  for (let i = 0; i < 256; ++i) bytes.set([...mix(ramp, i / 255).map(Math.round), 255], 4 * i);
  return bytes;
}

function classes(colours) {
  const bytes = new Uint8Array(1024);
  for (let i = 0; i < 256; ++i) bytes.set([...colours[i % colours.length], 255], 4 * i);
  return bytes;
}

const shallow = [74, 145, 212];
const deep = [10, 58, 146];

/** The higher the order, the wider and the deeper blue. width in pixels. */
export function riverStyle(order, highest) {
  const share = highest > 1 ? (order - 1) / (highest - 1) : 1;
  return {
    share,
    width: 1.3 + Math.min(0.75, 4 / Math.max(1, highest - 1)) * (order - 1),
    colour: shallow.map((c, i) => Math.round(c + (deep[i] - c) * share)),
  };
}

/** @param {number[]} colour */
export const css = ([r, g, b]) => `rgb(${Math.round(r)} ${Math.round(g)} ${Math.round(b)})`;
export const ridgeColour = [120, 74, 40];
export const markColour = [255, 120, 0];

/** The landform of each value: which of eight directions look up or down, within 12 values and over one degree. */
function landforms(land) {
  const { width, height, z, has } = land;
  const codes = new Float32Array(z.length);
  const side = land.cells * land.grid.cell_m;
  const ways = [[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1]];
  const far = [1, 2, 3, 4, 6, 8, 10, 12];
  const flat = Math.tan(Math.PI / 180);
  // Rows: number of directions that look down; columns: number that look up.
  const table = [
    [0, 0, 0, 7, 7, 8, 8, 8, 9],
    [0, 0, 7, 7, 7, 8, 8, 8],
    [0, 3, 5, 5, 6, 6, 8],
    [3, 3, 5, 5, 5, 6],
    [3, 3, 4, 5, 5],
    [2, 2, 4, 4],
    [2, 2, 2],
    [2, 2],
    [1],
  ];
  for (let r = 0, i = 0; r < height; ++r) {
    for (let c = 0; c < width; ++c, ++i) {
      if (has && !has[i]) continue;
      let up = 0;
      let down = 0;
      for (const [dx, dy] of ways) {
        const step = Math.hypot(dx, dy) * side;
        let high = -Infinity;
        let low = Infinity;
        for (const n of far) {
          const x = c + n * dx;
          const y = r + n * dy;
          if (x < 0 || y < 0 || x >= width || y >= height) break;
          const slope = (z[y * width + x] - z[i]) / (n * step);
          if (slope > high) high = slope;
          if (slope < low) low = slope;
        }
        if (high === -Infinity) continue;
        // Of zenith and nadir angles the larger decides.
        if (high > flat && high >= -low) ++up;
        else if (-low > flat) ++down;
      }
      codes[i] = table[down][up];
    }
  }
  return codes;
}

/**
 * The ways to colour the ground: by name {label, needs, make}. make gives {values: null for heights, low, high,
 * palette, byClass} and legend: {ramp, from, to} or {entries: [[name, colour], …]}.
 */
export const modes = {
  height: {
    label: 'height',
    make: ({ land, metres }) => ({
      values: null,
      low: land.min,
      high: land.max,
      palette: palette(tints),
      legend: { ramp: tints, from: metres(land.min), to: `${metres(land.max)} m` },
    }),
  },
  slope: {
    label: 'slope',
    make: ({ slope }) => ({
      values: Float32Array.from(slope.east, (e, i) => (Math.atan(Math.hypot(e, slope.south[i])) * 180) / Math.PI),
      low: 0,
      high: 60,
      palette: palette(steep),
      legend: { ramp: steep, from: '0°', to: '60°' },
    }),
  },
  aspect: {
    label: 'aspect',
    make: ({ slope }) => ({
      values: Float32Array.from(slope.east, (e, i) => ((Math.atan2(-e, slope.south[i]) * 180) / Math.PI + 360) % 360),
      low: 0,
      high: 360,
      palette: palette(around),
      legend: { ramp: around, from: 'N', to: 'E · S · W · N' },
    }),
  },
  area: {
    label: 'drainage area',
    needs: 'water',
    make: ({ land, water }) => {
      const cell = (land.cells * land.grid.cell_m) ** 2 / 1e6;
      let most = 1;
      for (const a of water.areas) if (a > most) most = a;
      return {
        values: water.areas.map((a) => Math.log10(Math.max(a, 1))),
        low: 0,
        high: Math.log10(most),
        palette: palette(wet),
        legend: {
          ramp: wet,
          from: `${Number(cell.toPrecision(2))}`,
          to: `${Number((most * cell).toPrecision(3))} km² (log)`,
        },
      };
    },
  },
  basins: {
    label: 'basins',
    needs: 'water',
    make: ({ water }) => ({
      values: Float32Array.from(water.basins, (b) => (b === 0 ? 12 : (b - 1) % 12)),
      low: 0,
      high: 255,
      byClass: true,
      palette: classes([...patches, [204, 199, 186]]),
      legend: { entries: [['one colour a basin', patches[0]]] },
    }),
  },
  strahler: {
    label: 'Strahler order',
    needs: 'rivers',
    lines: 'strahler',
    make: () => ({ values: null, low: 0, high: 1, palette: palette(plain), legend: null }),
  },
  hack: {
    label: 'Hack order',
    needs: 'rivers',
    lines: 'hack',
    make: () => ({ values: null, low: 0, high: 1, palette: palette(plain), legend: null }),
  },
  forms: {
    label: 'landforms (geomorphons)',
    make: ({ land }) => ({
      values: landforms(land),
      low: 0,
      high: 255,
      byClass: true,
      palette: classes(forms.map(([, c]) => c)),
      legend: { entries: forms },
    }),
  },
  difference: {
    label: 'difference from another report…',
    needs: 'other',
    make: ({ land, other, metres }) => {
      const values = land.z.map((z, i) => (land.has && !land.has[i] ? 0 : z - other[i]));
      const sizes = values.map(Math.abs).sort();
      const most = sizes[Math.floor(0.99 * (sizes.length - 1))] || 1;
      return {
        values,
        low: -most,
        high: most,
        palette: palette(change),
        legend: { ramp: change, from: `−${metres(most)}`, to: `+${metres(most)} m, this less the other` },
      };
    },
  },
  none: { label: 'none', make: () => ({ values: null, low: 0, high: 1, palette: palette(plain), legend: null }) },
};

/** Where in its palette the colour of a painted value begins, for the map without WebGL. */
export function colourOf({ low, high, byClass }, value) {
  const k = byClass
    ? Math.round(value) & 255
    : high > low
      ? Math.round(255 * Math.min(Math.max((value - low) / (high - low), 0), 1))
      : 102;
  return 4 * k;
}
