// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A server that speaks as `thalweg studio` does, for tests of the page alone: it holds a few finished lands, chosen by the
// pruning length, and edits the values of a recipe without understanding them.
import { deflateSync } from 'node:zlib';
import { execFileSync } from 'node:child_process';
import { createHash } from 'node:crypto';
import fs from 'node:fs';
import http from 'node:http';
import path from 'node:path';
import { web } from './browser.mjs';
import { drawnBy } from './fake_drawing.mjs';

/** A land that `thalweg make` wrote: what its page holds, and its heights. */
export function landOf(folder) {
  const html = fs.readFileSync(path.join(folder, 'report.html'), 'utf8');
  const block = (id) => html.match(new RegExp(`<script type="[^"]*" id="${id}">(.*?)</script>`, 's'))[1];
  const raw = path.join(folder, 'heights.raw');
  execFileSync('gdal_translate', ['-q', '-of', 'ENVI', '-ot', 'Float32', path.join(folder, 'dem.tif'), raw]);
  const bytes = fs.readFileSync(raw);
  const heights = Float32Array.from(new Float32Array(bytes.buffer, bytes.byteOffset, bytes.length / 4), (z) => (z < -9000 ? NaN : z));
  return { data: JSON.parse(block('data')), lines: block('lines'), water: block('water'), heights };
}

/** The keys as @@STUDIO@@ has them. */
export function keysOf(exe) {
  const { keys } = JSON.parse(execFileSync(exe, ['recipe', '--json'], { maxBuffer: 1e8 }));
  return keys.map(({ key, default: standard, range, ...rest }) => {
    const [, low, high] = /^[[(](-?[\d.e+-]+), (-?[\d.e+-]+)\]/.exec(range) ?? [null, />= (\d+)/.exec(range)?.[1] ?? null, null];
    return { path: key, standard, range, low: low === null ? null : Number(low), high: high === null ? null : Number(high), ...rest };
  });
}

/** Presets as @@STUDIO@@ has them, in other words. */
export function presetsOf(exe) {
  const all = [['hills', 'gentle hills', 'a plain'], ['basin-and-range', 'long ranges', 'basins of sediment']];
  return all.map(([name, meaning, not_meant]) => ({ name, meaning, not_meant, recipe: execFileSync(exe, ['recipe', '--preset', name], { encoding: 'utf8' }) }));
}

/** The values of a recipe.toml. */
export function valuesOf(toml) {
  const values = {};
  let section = '';
  for (const line of toml.split('\n')) {
    const head = /^\[+([\w.]+)\]+/.exec(line);
    const set = /^(\w+) = (.*)$/.exec(line);
    if (head) section = `${head[1]}.`;
    else if (set) values[section + set[1]] = set[2].replace(/^'(.*)'$/, '$1');
  }
  return values;
}

/** A cluster that grew from the middle: its arms by number. */
export function cluster(size = 160, particles = 2600) {
  const arms = Buffer.alloc(size * size);
  const middle = size / 2;
  [[0, -1], [1, 0], [0, 1], [-1, 0]].forEach(([dx, dy], k) => (arms[(middle + dy) * size + middle + dx] = k + 1));
  let state = 7;
  const random = () => (state = (state * 48271) % 2147483647) / 2147483647;
  let reach = 3;
  for (let n = 0; n < particles && reach < middle - 4;) {
    const turn = 2 * Math.PI * random();
    let x = Math.round(middle + (reach + 2) * Math.cos(turn));
    let y = Math.round(middle + (reach + 2) * Math.sin(turn));
    while (Math.hypot(x - middle, y - middle) < reach + 8) {
      const k = Math.floor(4 * random());
      x += [1, -1, 0, 0][k];
      y += [0, 0, 1, -1][k];
      if (x < 1 || y < 1 || x > size - 2 || y > size - 2) break;
      const at = y * size + x;
      const arm = [at + 1, at - 1, at + size, at - size].map((i) => arms[i]).find((a) => a > 0);
      if (arms[at] || !arm) continue;
      arms[at] = arm;
      reach = Math.max(reach, Math.hypot(x - middle, y - middle));
      ++n;
      break;
    }
  }
  return { width: size, height: size, arms: deflateSync(arms).toString('base64') };
}

function frame(opcode, payload) {
  const n = payload.length;
  const head = n < 126 ? Buffer.from([0x80 | opcode, n]) : n < 65536 ? Buffer.from([0x80 | opcode, 126, n >> 8, n & 255]) : Buffer.alloc(10);
  if (n >= 65536) {
    head.set([0x80 | opcode, 127]);
    head.writeBigUInt64BE(BigInt(n), 2);
  }
  return Buffer.concat([head, payload]);
}

/** Takes the messages out of what a socket sent: calls text(string); gives what is left. */
function unframe(bytes, text, close) {
  for (;;) {
    if (bytes.length < 2) return bytes;
    const opcode = bytes[0] & 15;
    let n = bytes[1] & 127;
    let at = 2;
    if (n === 126) {
      if (bytes.length < 4) return bytes;
      n = bytes.readUInt16BE(2);
      at = 4;
    } else if (n === 127) {
      if (bytes.length < 10) return bytes;
      n = Number(bytes.readBigUInt64BE(2));
      at = 10;
    }
    if (bytes.length < at + 4 + n) return bytes;
    const mask = bytes.subarray(at, at + 4);
    const body = Buffer.from(bytes.subarray(at + 4, at + 4 + n)).map((b, i) => b ^ mask[i & 3]);
    bytes = bytes.subarray(at + 4 + n);
    if (opcode === 1) text(body.toString());
    else if (opcode === 8) close();
  }
}

const tile = 64;
function raster(header, values, last) {
  const { width, height } = header;
  const across = Math.ceil(width / tile);
  const tiles = [];
  const parts = [];
  for (let t = 0; t < across * Math.ceil(height / tile); ++t) {
    const c0 = tile * (t % across);
    const c1 = Math.min(c0 + tile, width);
    const rows = [];
    let differs = !last || last.length !== values.length;
    for (let r = tile * Math.floor(t / across); r < Math.min(tile * Math.floor(t / across) + tile, height); ++r) {
      const row = values.subarray(r * width + c0, r * width + c1);
      differs ||= row.some((z, i) => !Object.is(z, last[r * width + c0 + i]));
      rows.push(row);
    }
    if (!differs) continue;
    tiles.push(t);
    for (const row of rows) parts.push(Buffer.from(row.buffer, row.byteOffset, 4 * row.length));
  }
  let json = JSON.stringify({ ...header, tile, tiles });
  json += ' '.repeat((4 - (Buffer.byteLength(json) % 4)) % 4);
  const size = Buffer.alloc(4);
  size.writeUInt32LE(Buffer.byteLength(json));
  return Buffer.concat([size, Buffer.from(json), ...parts]);
}

function means(z, width, height, cells) {
  const [w, h] = [Math.ceil(width / cells), Math.ceil(height / cells)];
  return { width: w, height: h, values: Float32Array.from({ length: w * h }, (_, i) => {
    let sum = 0;
    let n = 0;
    for (let r = cells * Math.floor(i / w); r < Math.min(height, cells * Math.floor(i / w) + cells); ++r) {
      for (let c = cells * (i % w); c < Math.min(width, cells * (i % w) + cells); ++c) {
        if (Number.isNaN(z[r * width + c])) continue;
        sum += z[r * width + c];
        ++n;
      }
    }
    return n ? sum / n : NaN;
  }) };
}

const span = (values) => values.reduce(([low, high, none], z) => (Number.isNaN(z) ? [low, high, none + 1] : [Math.min(low, z), Math.max(high, z), none]), [Infinity, -Infinity, 0]);

/**
 * lands: by the least pruning length they are for, [[prune, land], …] ascending; keys, presets, values: of the recipe; pause: [ms]
 * between messages of a job; drawing: what is drawn (fake_drawing.mjs), null: it speaks of none. Gives {url, asked: messages of the page, jobs, send(message), drop(): ends all sockets, close()}.
 */
export async function fakeStudio({ lands, keys, presets = [], values: begin, pause = 20, tree = cluster(), port = 0, drawing = null }) {
  const token = 't0k3n';
  const sockets = new Set();
  const asked = [];
  let values = { ...begin };
  let drawn = drawing && { grid: lands[0][1].data.grid, ...drawing };
  let revision = 1;
  const done = [];
  const undone = [];
  let job = 0;
  let last = null;
  const byPath = new Map(keys.map((key) => [key.path, key]));
  const toml = () => Object.entries(values).map(([key, value]) => `${key} = ${value}\n`).join('');
  const send = (message, to = sockets) => {
    for (const s of to) s.write(Buffer.isBuffer(message) ? frame(2, message) : frame(1, Buffer.from(JSON.stringify(message))));
  };
  const document = () => ({ type: 'document', revision, recipe: toml(), values, sections: [...new Set(Object.keys(values).map((k) => k.split('.').slice(0, -1).join('.')).filter(Boolean))],
    undo: done.at(-1)?.name ?? '', redo: undone.at(-1)?.name ?? '', command: "thalweg make 'studio/recipe.toml' -o out" });
  const drawing_ = () => ({ type: 'drawing', ...drawn, revision });
  const rest = () => new Promise((ok) => setTimeout(ok, pause));

  async function make(of, to = sockets, whole = false) {
    const mine = ++job;
    if (drawn?.rivers.length === 0) {
      await rest();
      send({ type: 'idle', job: mine, revision, seconds: 0 }, to);
      return;
    }
    const land = lands.findLast(([prune]) => Number(of['network.prune']) >= prune)?.[1] ?? lands[0][1];
    const { data, lines, water, heights } = land;
    const { grid } = data;
    const head = { job: mine, revision };
    const steps = [
      () => ({ type: 'busy', ...head, stage: 'grow', share: 0.1 }),
      () => ({ type: 'cluster', job: mine, ...tree, chosen: of['network.dla.branch'] ?? 'largest' }),
      () => ({ type: 'scene', ...head, level: 'rivers', lines, water: '', data: { ...data, heights: null, sea: null, lakes: false, summits: [], profiles: [], checks: [], relief: null, laws: null, hypsometry: null } }),
      () => ({ type: 'busy', ...head, stage: 'coarse_terrain', share: 0.3 }),
      () => {
        const coarse = means(heights, grid.width, grid.height, 4);
        const [min, max, nodata] = span(coarse.values);
        return raster({ kind: 'heights', ...head, level: 'coarse', grid, width: coarse.width, height: coarse.height, cells: 4, min, max, nodata, sea: data.sea }, coarse.values, null);
      },
      () => ({ type: 'busy', ...head, stage: 'equilibrium', share: 0.7 }),
      () => {
        const [min, max, nodata] = span(heights);
        const bytes = raster({ kind: 'heights', ...head, level: 'full', grid, width: grid.width, height: grid.height, cells: 1, min, max, nodata, sea: data.sea }, heights, whole ? null : last);
        last = heights;
        return bytes;
      },
      () => ({ type: 'scene', ...head, level: 'land', lines, water, data: { ...data, checks: [], relief: null, laws: { rows: [] } } }),
      () => ({ type: 'busy', ...head, stage: 'measure', share: 0.9 }),
      () => ({ type: 'scene', ...head, level: 'measured', lines, water, data }),
      () => ({ type: 'idle', ...head, seconds: (10 * pause) / 1000 }),
    ];
    for (const step of steps) {
      await rest();
      if (job !== mine) return;
      send(step(), to);
    }
  }

  function applied(edit) {
    const next = { ...values };
    for (const { set, unset, value, recipe } of edit.steps) {
      if (recipe) {
        for (const key of Object.keys(next)) delete next[key];
        Object.assign(next, valuesOf(recipe));
        continue;
      }
      const path = set ?? unset;
      const key = byPath.get(path?.replace(/\.\d+(?=\.)/, ''));
      if (!key && !unset) throw new Error(`unknown key '${path}'`);
      const number = Number(value);
      if (set && key.high !== null && !(number >= key.low && number <= key.high)) throw new Error(`${path} = ${value} is not in ${key.range}`);
      if (set) next[path] = value;
      else if (key) next[path] = key.standard;
      else for (const k of Object.keys(next)) if (k.startsWith(`${path}.`)) delete next[k];
    }
    return next;
  }

  /** One verb of drawing is an edit like any other. */
  function draw(socket, id, { revision: of, what }) {
    if (of !== revision) throw new Error('studio.draw: the document was changed meanwhile: draw on what is shown now');
    const { next, said } = drawnBy(drawn, what);
    done.push({ name: what.verb, values, drawn });
    undone.length = 0;
    drawn = next;
    ++revision;
    send(document());
    send(drawing_());
    send({ type: 'reply', id, ok: true, revision, said }, [socket]);
    make(values);
  }

  function answer(socket, { id, do: what, edit, file, ...rest_ }) {
    if (what === 'draw') return draw(socket, id, rest_);
    const reply = (more) => send({ type: 'reply', id, ok: true, revision, ...more }, [socket]);
    if (what === 'edit') {
      const next = applied(edit);
      if (JSON.stringify(next) === JSON.stringify(values)) return reply({});
      done.push({ name: edit.name || edit.steps.map((s) => (s.set ? `${s.set} = ${s.value}` : `unset ${s.unset}`)).join(', '), values, drawn });
      undone.length = 0;
      values = next;
    } else if (what === 'undo' || what === 'redo') {
      const [from, to] = what === 'undo' ? [done, undone] : [undone, done];
      const change = from.pop();
      if (!change) return reply({});
      to.push({ name: change.name, values, drawn });
      values = change.values;
      drawn = change.drawn;
    } else if (what === 'try') {
      const next = applied(edit);
      reply({});
      make(next);
      return undefined;
    } else if (what === 'export') {
      return reply({ folder: 'studio/export', files: file ? [file] : ['dem.tif', 'network.gpkg', 'recipe.toml', 'report.html'], ...(file ? { url: `files/${file}?${revision}` } : {}) });
    } else {
      ++job;
      return reply({});
    }
    ++revision;
    send(document());
    if (drawn) send(drawing_());
    reply({});
    make(values);
    return undefined;
  }

  const server = http.createServer((request, response) => {
    const url = new URL(request.url, 'http://localhost');
    if (url.searchParams.get('token') !== token) {
      response.writeHead(403).end('no token');
    } else if (url.pathname.startsWith('/files/')) {
      asked.push({ get: url.pathname });
      response.writeHead(200, { 'Content-Type': 'application/octet-stream' }).end('contents');
    } else {
      const about = JSON.stringify({ version: '0.2.0', folder: 'studio', keys, presets }).replaceAll('<', '\\u003c');
      let html = fs.readFileSync(path.join(web, 'dist/report.html'), 'utf8');
      for (const [marker, text] of [['@@TITLE@@', 'studio'], ['@@DATA@@', ''], ['@@HEIGHTS@@', ''], ['@@LINES@@', ''], ['@@WATER@@', ''], ['@@STUDIO@@', about]]) html = html.replace(marker, () => text);
      html = html.replace("connect-src 'none'", "connect-src 'self'");
      response.writeHead(200, { 'Content-Type': 'text/html; charset=utf-8', 'Content-Security-Policy': "connect-src 'self'; frame-ancestors 'none'" }).end(html);
    }
  });
  server.on('upgrade', (request, socket) => {
    if (new URL(request.url, 'http://localhost').searchParams.get('token') !== token) {
      socket.end('HTTP/1.1 403 Forbidden\r\n\r\n');
      return;
    }
    const accept = createHash('sha1').update(`${request.headers['sec-websocket-key']}258EAFA5-E914-47DA-95CA-C5AB0DC85B11`).digest('base64');
    socket.write(`HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Accept: ${accept}\r\n\r\n`);
    sockets.add(socket);
    let left = Buffer.alloc(0);
    const gone = () => sockets.delete(socket);
    socket.on('close', gone).on('error', gone);
    socket.on('data', (bytes) => {
      left = unframe(Buffer.concat([left, bytes]), (text) => {
        const message = JSON.parse(text);
        asked.push(message);
        try {
          answer(socket, message);
        } catch (error) {
          send({ type: 'reply', id: message.id, ok: false, error: error.message, at: error.at }, [socket]);
        }
      }, () => socket.end(frame(8, Buffer.alloc(0))));
    });
    send(document(), [socket]);
    if (drawn) send(drawing_(), [socket]);
    make(values, [socket], true);
  });
  await new Promise((ok) => server.listen(port, '127.0.0.1', ok));
  return {
    url: `http://127.0.0.1:${server.address().port}/?token=${token}`,
    asked,
    get job() {
      return job;
    },
    send,
    drop: () => sockets.forEach((s) => s.destroy()),
    close: () => new Promise((ok) => {
      sockets.forEach((s) => s.destroy());
      server.close(ok);
      server.closeAllConnections();
    }),
  };
}
