// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What `npm run lint` asks of the page: ESLint's recommended rules, all of them, and those below.
import js from '@eslint/js';
import globals from 'globals';

/** Mistakes that the recommended set leaves out, and one way to write what can be written in two. */
const habits = {
  curly: ['error', 'multi-line'],
  eqeqeq: 'error',
  'max-len': ['error', { code: 120 }],
  'max-lines-per-function': ['error', { max: 100 }],
  'no-implicit-coercion': ['error', { boolean: true, number: false, string: true }],
  'no-shadow': ['error', { hoist: 'never' }],
  'no-throw-literal': 'error',
  'no-unused-expressions': ['error', { allowShortCircuit: true, allowTernary: true }],
  'no-unused-vars': ['error', { argsIgnorePattern: '^_' }],
  'no-use-before-define': ['error', { functions: false, classes: false, variables: false }],
  'no-var': 'error',
  'object-shorthand': 'error',
  'prefer-const': ['error', { destructuring: 'all' }],
};

export default [
  { ignores: ['dist/', 'node_modules/'] },
  js.configs.recommended,
  { linterOptions: { reportUnusedDisableDirectives: 'error' }, rules: habits },
  { files: ['src/**'], languageOptions: { globals: globals.browser } },
  { files: ['*.js', '*.mjs', 'test/**'], languageOptions: { globals: globals.node } },
  // It runs partly in the page that it takes a picture of.
  { files: ['screenshot.mjs'], languageOptions: { globals: globals.browser } },
];
