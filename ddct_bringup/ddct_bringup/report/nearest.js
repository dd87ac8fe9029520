/* Copyright 2026 DDCT team
 * SPDX-License-Identifier: Apache-2.0 */
'use strict';

// Beside the pointer stands the value of the nearest curve, with its run, time and unit.
function showNearest(views) {
  const REACH_PX = 40;
  const tip = document.getElementById('tip');
  const dot = document.getElementById('tip-dot');

  function hide() { tip.hidden = dot.hidden = true; }

  views.forEach((view) => {
    const place = view.el.closest('.chart');
    if (!('symbol' in place.dataset)) return;
    place.addEventListener('pointermove', (event) => {
      const found = nearest(view, event);
      if (found) show(place, found); else hide();
    });
    place.addEventListener('pointerleave', hide);
  });
  addEventListener('scroll', hide, {passive: true});

  // The curve and its sample closest to the pointer, none where all are further than REACH_PX.
  function nearest({el, frame, model}, {clientX, clientY}) {
    const box = el.getBoundingClientRect();
    const [x, y] = [clientX - box.left, clientY - box.top];
    const {left, right, top, bottom} = frame.bbox;
    if (x < left || x > right || y < top || y > bottom) return null;
    let best = {distance: REACH_PX};
    model.renderers.filter((line) => line.visible && line.name).forEach((line) => {
      const times = line.data_source.data.t;
      const values = line.data_source.data[line.glyph.y.field];
      const at = (index) => [frame.x_scale.compute(times[index]), frame.y_scale.compute(values[index])];
      const [first, last] = [x - REACH_PX, x + REACH_PX].map((px) => sampleAt(times, frame.x_scale.invert(px)));
      for (let index = Math.max(0, first - 1); index < Math.min(last + 1, times.length - 1); index++) {
        const [here, next] = [at(index), at(index + 1)];
        const {distance, share} = fromSegment([x, y], here, next);
        if (distance < best.distance) {
          const sample = share < 0.5 ? index : index + 1;
          const [sx, sy] = share < 0.5 ? here : next;
          best = {distance, line, sample, left: box.left + sx, top: box.top + sy};
        }
      }
    });
    return best.line ? best : null;
  }

  // The last sample at or before a time.
  function sampleAt(times, time) {
    let [low, high] = [0, times.length - 1];
    while (low < high) {
      const middle = Math.ceil((low + high) / 2);
      if (times[middle] <= time) low = middle; else high = middle - 1;
    }
    return low;
  }

  function fromSegment([x, y], [x0, y0], [x1, y1]) {
    const [dx, dy] = [x1 - x0, y1 - y0];
    const along = ((x - x0) * dx + (y - y0) * dy) / (dx * dx + dy * dy || 1);
    const share = Math.min(1, Math.max(0, along));
    return {distance: Math.hypot(x - x0 - share * dx, y - y0 - share * dy), share};
  }

  function show(place, {line, sample, left, top}) {
    const {t: times, ...columns} = line.data_source.data;
    const {symbol, unit} = place.dataset;
    const field = line.glyph.y.field;
    const value = (name) => `${columns[name][sample].toPrecision(4)} ${unit}`.replace('-', '−');
    const [run] = line.tags[0].runs;
    const sampleOf = document.querySelector(`.chip[data-run="${run}"] .sample`);
    const name = document.createElement('b');
    name.append(sampleOf.cloneNode(true), line.name);
    const thin = `${field}_thin` in columns ? [document.createElement('br'), `${place.dataset.thin} = ${value(`${field}_thin`)}`] : [];
    tip.replaceChildren(name, `${symbol} = ${value(field)}`, ...thin,
      document.createElement('br'), `at ${times[sample].toFixed(2)} s`);
    tip.hidden = dot.hidden = false;
    const room = document.documentElement.clientWidth - tip.offsetWidth - 8;
    tip.style.left = `${Math.max(8, Math.min(left + 14, room))}px`;
    tip.style.top = `${Math.max(8, top - tip.offsetHeight - 14)}px`;
    Object.assign(dot.style, {left: `${left}px`, top: `${top}px`, borderColor: line.glyph.line_color.value ?? line.glyph.line_color});
  }
}
