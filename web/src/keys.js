// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Dialogs, and the list of keys among them.
import { make } from './elements.js';

/** Whether a key is typed into a field. */
export const typing = ({ target }) =>
  target.closest?.('textarea, select, input:not([type=range], [type=checkbox], [type=radio])') !== null;

/** A dialog with a heading and a button that closes it. */
export function dialog(title, ...children) {
  const close = make('button', { type: 'button', className: 'close', textContent: 'Close' });
  const whole = make('dialog', {}, make('h2', { textContent: title }), ...children, close);
  whole.setAttribute('aria-label', title);
  close.addEventListener('click', () => whole.close());
  whole.addEventListener('click', (event) => event.target === whole && whole.close()); // beside it
  document.body.append(whole);
  return whole;
}

/** rows: [[key, what it does], …]. */
export function keysDialog(button, rows) {
  const list = make(
    'dl',
    { className: 'keys' },
    ...rows.flatMap(([key, does]) => [
      make('dt', {}, make('kbd', { textContent: key })),
      make('dd', { textContent: does }),
    ]),
  );
  const whole = dialog('Keys and pointer', list);
  button.addEventListener('click', () => whole.showModal());
  window.addEventListener('keydown', (event) => {
    if (event.key !== '?' || typing(event) || whole.open) return;
    whole.showModal();
    event.preventDefault();
  });
}
