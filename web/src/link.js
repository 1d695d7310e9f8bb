// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The socket to `thalweg studio`: questions and their replies, and heights put together from the tiles that changed.

/** The last raster of a level, to which tiles are added. */
class Tiles {
  #kind = '';
  values = new Float32Array(0);

  take(header, payload) {
    const { width, height, cells, grid, tile, tiles } = header;
    const kind = JSON.stringify([width, height, cells, grid]);
    const values = kind === this.#kind ? this.values.slice() : new Float32Array(width * height).fill(NaN);
    const across = Math.ceil(width / tile);
    let at = 0;
    for (const t of tiles) {
      const c0 = tile * (t % across);
      const r0 = tile * Math.floor(t / across);
      const columns = Math.min(tile, width - c0);
      for (let r = r0; r < Math.min(r0 + tile, height); ++r, at += columns) {
        values.set(payload.subarray(at, at + columns), r * width + c0);
      }
    }
    if (at !== payload.length) throw new Error('the heights from thalweg are damaged');
    this.#kind = kind;
    this.values = values;
    return values;
  }
}

/**
 * Speaks with the program. on: {opened(), lost(attempts), and by the type of a message: document(m), busy(m), … and
 * heights(header, values)}. What comes with a job below the highest seen is dropped.
 */
export class Link {
  #waiting = new Map();
  #number = 0;
  #attempts = 0;
  #job = 0;
  #rasters = { coarse: new Tiles(), full: new Tiles() };

  constructor(on) {
    this.on = on;
    this.#open();
  }

  #open() {
    this.#job = 0;
    const socket = (this.socket = new WebSocket(
      `${location.protocol === 'https:' ? 'wss' : 'ws'}://${location.host}${location.pathname}${location.search}`,
    ));
    socket.binaryType = 'arraybuffer';
    socket.addEventListener('open', () => {
      this.#attempts = 0;
      this.on.opened();
    });
    socket.addEventListener('message', ({ data }) =>
      typeof data === 'string' ? this.#read(JSON.parse(data)) : this.#frame(data),
    );
    socket.addEventListener('close', () => {
      for (const { reject } of this.#waiting.values()) reject(new Error('the connection to thalweg studio was lost'));
      this.#waiting.clear();
      this.on.lost(++this.#attempts);
      setTimeout(() => this.#open(), Math.min(500 * 2 ** this.#attempts, 8000));
    });
  }

  #late({ job }) {
    if (job < this.#job) return true;
    this.#job = Math.max(this.#job, job ?? 0);
    return false;
  }

  #read(message) {
    if (message.type === 'reply') {
      const { resolve, reject } = this.#waiting.get(message.id) ?? {};
      this.#waiting.delete(message.id);
      if (message.ok) resolve?.(message);
      else reject?.(Object.assign(new Error(message.error), { at: message.at }));
    } else if (!this.#late(message)) this.on[message.type]?.(message);
  }

  #frame(buffer) {
    const size = new DataView(buffer).getUint32(0, true);
    const header = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, size)));
    if (header.kind !== 'heights') return;
    // late ones too: later tiles lie beside them
    const values = this.#rasters[header.level].take(header, new Float32Array(buffer, 4 + size));
    if (!this.#late(header)) this.on.heights(header, values);
  }

  get job() {
    return this.#job;
  }

  /** Heights of the last full raster, NaN where there are none. */
  get heights() {
    return this.#rasters.full.values.slice();
  }

  /** Gives a promise of the reply, which rejects with the program's words. */
  ask(question) {
    return new Promise((resolve, reject) => {
      if (this.socket.readyState !== WebSocket.OPEN) {
        reject(new Error('there is no connection to thalweg studio'));
        return;
      }
      const id = ++this.#number;
      this.#waiting.set(id, { resolve, reject });
      this.socket.send(JSON.stringify({ id, ...question }));
    });
  }
}
