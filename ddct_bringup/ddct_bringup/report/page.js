'use strict';

// Charts come from the Bokeh document in #data; this file switches lines, time range and colours.
(async () => {
  const root = document.documentElement;
  const chips = [...document.querySelectorAll('.chip')];
  const shown = new Set(chips.filter(isPressed).map(runOf));

  function isPressed(chip) { return chip.getAttribute('aria-pressed') === 'true'; }
  function runOf(element) { return Number(element.dataset.run); }

  const views = await drawCharts();
  const charts = views.map((view) => view.model);
  const drawn = charts.flatMap((chart) => chart.renderers).filter((item) => item.tags.length);

  async function drawCharts() {
    const {document: json, roots} = JSON.parse(document.getElementById('data').textContent);
    const places = Object.entries(roots).map(([key, id]) => [id, `chart-${key}`]);
    const item = {docid: 'report', root_ids: Object.values(roots), roots: Object.fromEntries(places)};
    const [manager] = await Bokeh.embed.embed_items({report: json}, [item]);
    return Object.values(roots).map((id) => manager.get_by_id(id));
  }

  // Lines

  function show(runs) {
    shown.clear();
    runs.forEach((run) => shown.add(run));
    chips.forEach((chip) => chip.setAttribute('aria-pressed', shown.has(runOf(chip))));
    drawn.forEach((item) => { item.visible = item.tags[0].runs.some((run) => shown.has(run)); });
    count();
  }

  function count() {
    document.getElementById('count').textContent = `${shown.size} of ${chips.length} runs shown`;
  }

  function toggled(run) {
    return shown.has(run) ? [...shown].filter((other) => other !== run) : [...shown, run];
  }

  const groups = {
    all: () => chips.map(runOf),
    none: () => [],
    thesis: () => chips.filter((chip) => 'thesis' in chip.dataset).map(runOf),
  };
  chips.forEach((chip) => chip.addEventListener('click', () => show(toggled(runOf(chip)))));
  document.querySelectorAll('[data-show]').forEach((button) => {
    button.addEventListener('click', () => show(groups[button.dataset.show]()));
  });

  // A line stands out while the pointer is on its chip.
  function emphasise(run) {
    drawn.forEach(({glyph, tags}) => {
      const faint = run !== null && !tags[0].runs.includes(run);
      glyph.line_alpha = {value: faint ? 0.15 : 1.0};
    });
  }
  if (matchMedia('(hover: hover)').matches) {
    chips.forEach((chip) => {
      chip.addEventListener('pointerenter', () => shown.has(runOf(chip)) && emphasise(runOf(chip)));
      chip.addEventListener('pointerleave', () => emphasise(null));
    });
  }

  // Time axis, one for all charts

  const axis = charts[0].x_range;
  const whole = {start: axis.start, end: axis.end};
  document.querySelectorAll('[data-range]').forEach((button) => {
    const [start, end] = button.dataset.range.split(' ').map(Number);
    button.addEventListener('click', () => {
      axis.setv({start: Math.max(start, whole.start), end: Math.min(end, whole.end)});
    });
  });
  // A finger scrolls the page until a tool of the chart is chosen.
  if (matchMedia('(pointer: coarse)').matches) {
    charts.forEach((chart) => chart.toolbar.tools.forEach((tool) => {
      if (tool.type === 'BoxZoomTool') tool.active = false;
    }));
  }

  // Colours

  const systemDark = matchMedia('(prefers-color-scheme: dark)');
  const themes = ['auto', 'light', 'dark'];
  const themeButton = document.getElementById('theme');

  function paint() {
    const style = getComputedStyle(root);
    drawn.forEach(({glyph, tags}) => {
      const {colour} = tags[0];
      glyph.line_color = style.getPropertyValue(colour === null ? '--soft' : `--run-${colour}`).trim();
    });
  }

  function setTheme(theme) {
    if (theme === 'auto') delete root.dataset.theme; else root.dataset.theme = theme;
    themeButton.firstElementChild.textContent = theme;
  }

  function storedTheme() {
    try { return localStorage.getItem('report-theme'); } catch { return null; }
  }

  themeButton.addEventListener('click', () => {
    const theme = themes[(themes.indexOf(root.dataset.theme ?? 'auto') + 1) % themes.length];
    setTheme(theme);
    paint();
    try { localStorage.setItem('report-theme', theme); } catch { /* a page without storage */ }
  });
  systemDark.addEventListener('change', paint);

  // Paper gets light copies of the charts, which fit its width.

  const TURNS = 200;
  let themeOnScreen = null;
  addEventListener('beforeprint', async () => {
    themeOnScreen ??= root.dataset.theme ?? 'auto';
    setTheme('light');
    paint();
    // Bokeh takes over new colours in promises; these, unlike timers, still run before printing.
    for (let turn = 0; turn < TURNS; turn++) await null;
    views.forEach((view) => {
      const {canvas} = view.export('png', true);
      view.el.closest('figure').querySelector('.paper').replaceChildren(canvas);
    });
  });
  addEventListener('afterprint', () => {
    document.querySelectorAll('.paper').forEach((paper) => paper.replaceChildren());
    setTheme(themeOnScreen ?? 'auto');
    paint();
    themeOnScreen = null;
  });

  // Tables sort by the column whose heading is pressed.

  function sortKey(row, column) {
    const cell = row.children[column];
    const value = cell?.querySelector('data')?.value;
    return value === undefined ? cell?.textContent.trim() ?? '' : Number(value);
  }

  function compare(a, b) {
    if (typeof a !== typeof b) return typeof a === 'number' ? -1 : 1;
    return typeof a === 'number' ? a - b : a.localeCompare(b, 'en', {numeric: true});
  }

  document.querySelectorAll('.sort').forEach((button) => button.addEventListener('click', () => {
    const heading = button.closest('th');
    const body = heading.closest('table').tBodies[0];
    const column = [...heading.parentElement.children].indexOf(heading);
    const descending = heading.getAttribute('aria-sort') === 'ascending';
    [...heading.parentElement.children].forEach((other) => other.removeAttribute('aria-sort'));
    heading.setAttribute('aria-sort', descending ? 'descending' : 'ascending');
    const rows = [...body.rows].sort((a, b) => compare(sortKey(a, column), sortKey(b, column)));
    body.append(...(descending ? rows.reverse() : rows));
  }));

  count();
  setTheme(themes.includes(storedTheme()) ? storedTheme() : 'auto');
  // The document comes in the colours of the light page.
  if (root.dataset.theme === 'dark' || (!root.dataset.theme && systemDark.matches)) paint();
  const [{document: bokehDocument}] = charts;
  while (!bokehDocument.is_idle) await new Promise(requestAnimationFrame);
  await new Promise(requestAnimationFrame);
  window.reportReady = performance.now();
})();
