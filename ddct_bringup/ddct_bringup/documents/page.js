/* Copyright 2026 DDCT team
 * SPDX-License-Identifier: Apache-2.0 */
'use strict';

// What every page of ours does. Its colours are the system's until the button chooses light or dark;
// a window event `colours` follows each change. Tables sort by the column whose heading is pressed, and
// say so where they are wider than their frame. Paper has what a screen folds away.

const colours = (() => {
  const {dataset} = document.documentElement;
  const themes = ['auto', 'light', 'dark'];
  const button = document.getElementById('theme');
  const systemDark = matchMedia('(prefers-color-scheme: dark)');

  function theme() { return dataset.theme ?? 'auto'; }

  function set(chosen) {
    if (chosen === 'auto') delete dataset.theme; else dataset.theme = chosen;
    button.firstElementChild.textContent = chosen;
  }

  function announceColours() { dispatchEvent(new Event('colours')); }

  function stored() {
    try { return localStorage.getItem('report-theme'); } catch { return null; }
  }

  button.addEventListener('click', () => {
    set(themes[(themes.indexOf(theme()) + 1) % themes.length]);
    announceColours();
    try { localStorage.setItem('report-theme', theme()); } catch { /* a page without storage */ }
  });
  systemDark.addEventListener('change', announceColours);
  set(themes.includes(stored()) ? stored() : 'auto');
  return {theme, set, dark: () => theme() === 'dark' || (theme() === 'auto' && systemDark.matches)};
})();

(() => {
  function sortKey(row, column) {
    const cell = row.children[column];
    const value = cell?.querySelector('data')?.value;
    return value === undefined ? cell?.textContent.trim() ?? '' : Number(value);
  }

  function compare(a, b) {
    if (typeof a !== typeof b) return typeof a === 'number' ? -1 : 1;
    return typeof a === 'number' ? a - b : a.localeCompare(b, 'en', {numeric: true});
  }

  function sort(button) {
    const heading = button.closest('th');
    const body = heading.closest('table').tBodies[0];
    const column = Number(heading.dataset.column ?? [...heading.parentElement.children].indexOf(heading));
    const descending = heading.getAttribute('aria-sort') === 'ascending';
    heading.closest('thead').querySelectorAll('th').forEach((other) => other.removeAttribute('aria-sort'));
    heading.setAttribute('aria-sort', descending ? 'descending' : 'ascending');
    // Lines between blocks belong to the first order only.
    body.querySelectorAll('.next').forEach((row) => row.classList.remove('next'));
    const rows = [...body.rows].sort((a, b) => compare(sortKey(a, column), sortKey(b, column)));
    body.append(...(descending ? rows.reverse() : rows));
  }

  // Browsers leave buttons out of the headings that they repeat on paper, so these are plain elements.
  document.querySelectorAll('.sort').forEach((button) => {
    button.addEventListener('click', () => sort(button));
    button.addEventListener('keydown', (event) => {
      if (event.key !== 'Enter' && event.key !== ' ') return;
      event.preventDefault();
      sort(button);
    });
  });
})();

(() => {
  let unfolded = [];
  addEventListener('beforeprint', () => {
    const folded = [...document.querySelectorAll('details.paper-too:not([open])')];
    folded.forEach((part) => { part.open = true; });
    unfolded.push(...folded);
  });
  addEventListener('afterprint', () => {
    unfolded.forEach((part) => { part.open = false; });
    unfolded = [];
  });
})();

document.querySelectorAll('.scroll').forEach((frame) => {
  const words = document.createElement('p');
  words.className = 'more';
  words.textContent = 'more columns: scroll the table to the side \u2192';
  frame.after(words);

  function look() {
    const hidden = frame.scrollWidth - frame.clientWidth;
    words.hidden = hidden < 2;
    frame.dataset.more = hidden - frame.scrollLeft < 2 ? '' : 'right';
    frame.tabIndex = hidden < 2 ? -1 : 0;
  }

  frame.addEventListener('scroll', look, {passive: true});
  new ResizeObserver(look).observe(frame);
  look();
});
