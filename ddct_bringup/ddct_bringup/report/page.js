/* Copyright 2026 DDCT team
 * SPDX-License-Identifier: Apache-2.0 */
// Charts come from the Bokeh document in #data; this file switches lines and time range.
(async () => {
  const data = JSON.parse(document.getElementById('data').textContent);
  const chips = [...document.querySelectorAll('.chip')];
  const shown = new Set(chips.filter(isPressed).map(runOf));

  function isPressed(chip) { return chip.getAttribute('aria-pressed') === 'true'; }
  function runOf(element) { return Number(element.dataset.run); }

  const views = await drawCharts(data);
  const charts = views.map((view) => view.model);
  const drawn = charts.flatMap((chart) => chart.renderers).filter((item) => item.tags.length);

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
    drawn.forEach(({glyph, tags: [{runs, alpha = 1.0, area}]}) => {
      const faint = run !== null && !runs.includes(run);
      if (area) glyph.fill_alpha = faint ? 0.15 * alpha : alpha;
      else glyph.line_alpha = {value: faint ? 0.15 : alpha};
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

  // Pareto view: every magnitude and every front is in the data; a choice only looks them up.

  const [across, up] = document.querySelectorAll('.pareto-choice select');

  function placeRuns() {
    const {figures, fronts} = data.pareto;
    const [x, y] = [figures[across.value], figures[up.value]];
    const front = fronts[[across.value, up.value].sort().join(' ')];
    const {below, left, renderers: [{data_source: source}]} = charts.find((chart) => chart.name === 'pareto');
    const runs = Array.from(source.data.run);
    source.data = {
      ...source.data,
      x: runs.map((run) => x.values[run] ?? NaN),
      y: runs.map((run) => y.values[run] ?? NaN),
      ring: runs.map((run) => Number(front.includes(run))),
    };
    below[0].axis_label = x.title;
    left[0].axis_label = y.title;
  }

  [across, up].filter(Boolean).forEach((select) => {
    select.disabled = false;
    select.addEventListener('change', placeRuns);
  });

  printCharts(views);
  showNearest(views);
  count();
  const [{document: bokehDocument}] = charts;
  while (!bokehDocument.is_idle) await new Promise(requestAnimationFrame);
  await new Promise(requestAnimationFrame);
  window.reportReady = performance.now();
})();
