// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
import { createHash } from 'node:crypto';
import { defineConfig } from 'vite';
import { viteSingleFile } from 'vite-plugin-singlefile';

/** Only the page's own script and style run: the policy names them by their hashes. */
function contentPolicy() {
  const hash = (text) => `'sha256-${createHash('sha256').update(text).digest('base64')}'`;
  const hashes = (html, tag) => [...html.matchAll(new RegExp(`<${tag}(?![^>]*application/json|[^>]*text/plain)[^>]*>(.*?)</${tag}>`, 'gs'))]
    .map((match) => hash(match[1])).join(' ');
  return {
    name: 'content-policy',
    enforce: 'post',
    generateBundle: {
      order: 'post',
      handler(_, bundle) {
        const page = bundle['report.html'];
        page.source = page.source.replace('<!--@@POLICY@@-->', () =>
          `<meta http-equiv="Content-Security-Policy" content="default-src 'none'; script-src ${hashes(page.source, 'script')}; ` +
          `style-src ${hashes(page.source, 'style')}; img-src data: blob:; connect-src 'none'; base-uri 'none'; form-action 'none'">`);
      },
    },
  };
}

export default defineConfig({
  plugins: [viteSingleFile({ removeViteModuleLoader: true }), contentPolicy()],
  build: {
    target: 'es2022',
    modulePreload: false,
    rollupOptions: { input: 'report.html' },
  },
});
