// SPDX-License-Identifier: Apache-2.0
// The dialogue that tells the keys, and what the page is made of.
import { readLicences } from './data';
import { button, h } from './dom';

const KEYS: readonly (readonly [string, string])[] = [
  ['N, P', 'next and previous finding'],
  ['/', 'filter the findings'],
  ['F', 'show all of the model'],
  ['E', 'edges on or off'],
  ['W', 'front and back of faces in two colours, or one'],
  ['C', 'patches in colours, or not'],
  ['1 to 4', 'the tabs of the panel'],
  ['Arrow keys', 'turn the model'],
  ['+, -', 'nearer, farther'],
  ['Space', 'touch or lift; in a log: play or pause'],
  [', and .', 'in a log: a tick back, a tick on'],
  ['R', 'record while touching'],
  ['T', 'dark or light'],
  ['Escape', 'nothing selected'],
  ['?', 'this help'],
];

export function makeHelp(version: string): HTMLDialogElement {
  const rows = KEYS.map(([key, what]) => h('tr', {}, h('th', { scope: 'row' }, key), h('td', {}, what)));
  const licences = h('pre.licences', { tabIndex: 0 });
  const details = h('details', {}, h('summary', {}, 'Licences of the software in this page'), licences);
  details.ontoggle = () => {
    if (details.open && licences.textContent === '') void readLicences().then((text) => (licences.textContent = text));
  };
  const dialog = h(
    'dialog.help',
    { 'aria-labelledby': 'help-title' },
    h('h2', { id: 'help-title' }, 'Keys'),
    h('table', {}, h('tbody', {}, ...rows)),
    h('p', {}, 'Mouse: the left button turns, the right one shifts, the wheel goes nearer. A click on a face tells its number.'),
    h('p.note', {}, `Written by fdcg ${version}. The page needs no network and sends nothing.`),
    details,
    button('Close', () => dialog.close(), { id: 'help-close', autofocus: true }),
  );
  return dialog;
}
