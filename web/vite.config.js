// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
import { createHash } from 'node:crypto';
import { readFileSync } from 'node:fs';
import { defineConfig } from 'vite';
import { viteSingleFile } from 'vite-plugin-singlefile';

/** Only the page's own script and style run: the policy names them by their hashes. */
function contentPolicy(name, connects, more) {
  const hash = (text) => `'sha256-${createHash('sha256').update(text).digest('base64')}'`;
  const hashes = (html, tag) =>
    [...html.matchAll(new RegExp(`<${tag}(?![^>]*application/json|[^>]*text/plain)[^>]*>(.*?)</${tag}>`, 'gs'))]
      .map((match) => hash(match[1]))
      .join(' ');
  return {
    name: 'content-policy',
    enforce: 'post',
    generateBundle: {
      order: 'post',
      handler(_, bundle) {
        const page = bundle[name];
        page.source = page.source.replace(
          '<!--@@POLICY@@-->',
          () =>
            `<meta http-equiv="Content-Security-Policy" content="default-src 'none'; ` +
            `script-src ${hashes(page.source, 'script')}; style-src ${hashes(page.source, 'style')}; ` +
            `img-src data: blob:; connect-src ${connects}; ${more}base-uri 'none'; form-action 'none'">`,
        );
      },
    },
  };
}

const maplibre = (name) => readFileSync(new URL(`node_modules/maplibre-gl/${name}`, import.meta.url), 'utf8');

/** MapLibre's worker as a text for a blob, as a classic script, and its licence, which every copy has to hold. */
function maplibreInside() {
  return {
    name: 'maplibre-inside',
    resolveId: (id) => (id === 'maplibre-worker' ? `\0${id}` : null),
    load(id) {
      if (id !== '\0maplibre-worker') return null;
      const script = maplibre('dist/maplibre-gl-worker.mjs').replace(
        /export\s*\{[^}]*\};?\s*(\/\/# sourceMappingURL=\S+\s*)?$/,
        '',
      );
      if (/\bexport\s*[{*]/.test(script.slice(-200))) {
        throw new Error('the worker of maplibre-gl still exports something');
      }
      return `export default ${JSON.stringify(script)};`;
    },
    transformIndexHtml: (html) => html.replace('<!--@@LICENCE@@-->', () =>
      `<script type="text/plain" id="licence">MapLibre GL JS\n${maplibre('LICENSE.txt')}</script>`),
  };
}

/** `vite build` makes the report page, `vite build --mode terrain` the map of `thalweg export --for web`. */
export default defineConfig(({ mode }) => {
  const terrain = mode === 'terrain';
  const page = terrain ? 'terrain.html' : 'report.html';
  return {
    plugins: [
      ...(terrain ? [maplibreInside()] : []),
      viteSingleFile({ removeViteModuleLoader: true }),
      contentPolicy(page, terrain ? "'self' blob:" : "'none'", terrain ? 'worker-src blob:; ' : ''),
    ],
    build: {
      target: 'es2022',
      modulePreload: false,
      emptyOutDir: false,
      rollupOptions: { input: page },
    },
  };
});
