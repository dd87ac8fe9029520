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

  // Pareto view: every place and every front is in the data; a choice only looks them up.

  const [across, up] = document.querySelectorAll('.pareto-choice select');

  function placeRuns() {
    const {figures, fronts} = data.pareto;
    const [x, y] = [figures[across.value], figures[up.value]];
    const front = fronts[[across.value, up.value].sort().join(' ')];
    document.querySelectorAll('.pareto .point').forEach((point) => {
      const run = runOf(point);
      point.hidden = !(run in x.places && run in y.places);
      if (point.hidden) return;
      point.style.left = `${100 * x.places[run]}%`;
      point.style.bottom = `${100 * y.places[run]}%`;
      point.classList.toggle('left', x.places[run] > 0.6);
      point.classList.toggle('best', front.includes(run));
      point.title = `${x.values[run]}, ${y.values[run]}`;
    });
    [[x, 'across', 'left'], [y, 'up', 'bottom']].forEach(([figure, name, side]) => {
      document.querySelector(`.pareto .title.${name}`).textContent = figure.title;
      document.querySelector(`.pareto .ticks.${name}`).replaceChildren(
        ...figure.ticks.map(([text, place]) => {
          const tick = document.createElement('i');
          tick.textContent = text;
          tick.style[side] = `${100 * place}%`;
          return tick;
        }));
    });
    partParetoLabels();
  }

  function partParetoLabels() {
    const points = [...document.querySelectorAll('.pareto .point:not([hidden])')];
    const parts = points.map((point) => [point.querySelector('b'), point.querySelector('.dot')]);
    partLabels(document.querySelector('.pareto .field'), parts, 1);
  }

  // A drawing has its own unit of length, which is `scale` pixels.
  function partFrontLabels(drawing) {
    const points = [...drawing.querySelectorAll('[data-run]')];
    const parts = points.map((point) => [point.querySelector('text'), point.querySelector('circle')]);
    partLabels(drawing, parts, drawing.getBoundingClientRect().width / drawing.viewBox.baseVal.width);
  }

  // A label that would cover another one or a dot moves to the nearest free place above or below,
  // within the place where there is one.
  function partLabels(place, parts, scale) {
    const field = place.getBoundingClientRect();
    const taken = parts.map(([, dot]) => dot.getBoundingClientRect());
    parts.forEach(([label]) => {
      label.style.translate = '';
      const {left, right, top, height} = label.getBoundingClientRect();
      const free = (next) => {
        const covered = (y) => taken.find((box) => left < box.right && right > box.left
          && y < box.bottom && y + height > box.top);
        let y = top;
        for (let box = covered(y); box; box = covered(y)) y = next(box);
        return y;
      };
      const above = free((box) => box.top - height);
      const below = free((box) => box.bottom);
      const nearest = top - above <= below - top ? [above, below] : [below, above];
      const found = nearest.find((each) => each >= field.top && each + height <= field.bottom)
        ?? above;
      label.style.translate = `0 ${(found - top) / scale}px`;
      taken.push({left, right, top: found, bottom: found + height});
    });
  }

  if (across) partParetoLabels();
  document.querySelectorAll('.floor-front').forEach(partFrontLabels);
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
