// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the page has that no module of it exports.

interface Window {
  /** What a page tells about itself to whoever asks. */
  __thalweg: any;
}

/** MapLibre's worker as text: vite.config.js. */
declare module 'maplibre-worker' {
  const script: string;
  export default script;
}
