// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Whether the terrain is right: its checks, and what was found where they failed.
import { number } from './chart.js';
import { fold, make, table } from './elements.js';

/** Kinds of findings that a check counts, where they are not its name. */
const kinds = {
  uphill_arcs: ['z_rising'],
  depressions: ['depression'],
  border_cells: ['border_cell'],
  sources_astray: ['source_astray'],
  walled_cells: ['walled_cell'],
  mean_slope_error: ['target_missed'],
  relief_error: ['target_missed'],
  trace_precision: ['water_leaves', 'outside_dem'],
  trace_recall: ['water_leaves', 'outside_dem'],
  trace_f_same_cell: ['water_leaves', 'outside_dem'],
};
const words = (name) => name.replace(/_/g, ' ');
const limit = (c) => `${c.bound === 'at_least' ? '≥' : '≤'} ${number(c.limit)}`;

/** What was found, with a way to its place. */
function item({ text, at, remedy }, actions) {
  if (remedy) text = `${text}. ${remedy}.`;
  if (!at) return make('li', { textContent: text });
  const button = make('button', { type: 'button', className: 'show', textContent: 'Show' });
  button.setAttribute('aria-label', `Show on the land: ${text}`);
  button.addEventListener('click', () => {
    actions.flyTo(...at);
    actions.point(...at);
  });
  return make('li', {}, `${text} `, button);
}

function failure(check, findings, actions) {
  const most = 3;
  const of = findings.filter(({ kind }) => (kinds[check.name] ?? [check.name]).includes(kind));
  return make(
    'li',
    {},
    make('b', { textContent: words(check.name) }),
    `: ${number(check.value)}, allowed ${limit(check)}`,
    of.length
      ? make(
          'ul',
          {},
          ...of.slice(0, most).map((f) => item(f, actions)),
          of.length > most && make('li', { textContent: 'more among the findings, at the end' }),
        )
      : '',
  );
}

/** Most checks count faults, and allow none: of those that passed the names are enough. */
function passed(checks) {
  const counts = checks.filter((c) => c.value === 0 && c.limit === 0);
  const others = checks.filter((c) => !counts.includes(c));
  return [
    others.length &&
      table(
        ['check', 'found', 'limit'],
        others.map((c) => [words(c.name), number(c.value), limit(c)]),
        'Checks that passed',
      ),
    counts.length &&
      make('p', { className: 'hint', textContent: `None of: ${counts.map((c) => words(c.name)).join(', ')}.` }),
  ];
}

export function verdict(parent, data, actions) {
  const failed = data.checks.filter((c) => !c.ok);
  const good = data.checks.filter((c) => c.ok);
  const { warnings } = data;
  if (warnings.count) {
    const list = fold(
      make(
        'span',
        { className: 'careful' },
        make('span', { textContent: '! ' }),
        `${warnings.count} ${warnings.count === 1 ? 'warning' : 'warnings'}`,
      ),
      make('ul', { className: 'warnings' }, ...warnings.shown.map((f) => item(f, actions))),
    );
    list.open = true;
    parent.append(list);
  }
  if (!data.checks.length) return;
  const count = (n) => `${n} ${n === 1 ? 'check' : 'checks'}`;
  const head = (sign, text, className) => make('span', { className }, make('span', { textContent: `${sign} ` }), text);
  const whole = failed.length
    ? fold(
        head('✗', `${failed.length} of ${count(data.checks.length)} failed`, 'bad'),
        make(
          'ul',
          { className: 'failures' },
          ...failed.map((c) => failure(c, [...data.findings.shown, ...warnings.shown], actions)),
        ),
        fold(`${count(good.length)} passed`, ...passed(good)),
      )
    : fold(head('✓', `${count(good.length)} passed`, 'ok'), ...passed(good));
  whole.open = failed.length > 0;
  parent.append(whole);
}

/** A list of findings or of repairs; null without one. */
export function listed(one, { count, shown }, actions) {
  const more = count > shown.length ? `; ${shown.length} of them` : '';
  return count
    ? fold(
        `${number(count)} ${one}${count === 1 ? '' : 's'}${more}`,
        make('ul', {}, ...shown.map((f) => item(f, actions))),
      )
    : null;
}
