/* Copyright 2026 DDCT team
 * SPDX-License-Identifier: Apache-2.0 */
'use strict';

// Charts of a page: the Bokeh document, with the id of each chart by that of its place on the page.
async function drawCharts({document: json, roots}) {
  const places = Object.fromEntries(Object.entries(roots).map(([place, id]) => [id, place]));
  const item = {docid: 'page', root_ids: Object.values(roots), roots: places};
  const [manager] = await Bokeh.embed.embed_items({page: json}, [item]);
  const views = Object.values(roots).map((id) => manager.get_by_id(id));
  // A finger scrolls the page until a tool of the chart is chosen.
  if (matchMedia('(pointer: coarse)').matches) {
    views.forEach(({model}) => model.toolbar.tools.forEach((tool) => {
      if (tool.type === 'BoxZoomTool') tool.active = false;
    }));
  }
  return views;
}

// Paper gets light copies of the charts.
function printCharts(views) {
  const WIDTH_PX = 500;
  const DENSITY = 2;
  const TURNS = 200;
  const density = Object.getOwnPropertyDescriptor(window, 'devicePixelRatio');
  let before = null;

  function place(view) { return view.el.closest('.chart'); }

  addEventListener('beforeprint', async () => {
    before ??= colours.theme();
    colours.set('light');
    views.forEach((view) => {
      place(view).style.width = `${WIDTH_PX}px`;
      view.after_resize();
    });
    // Bokeh takes over new colours in promises; these, unlike timers, still run before printing.
    for (let turn = 0; turn < TURNS; turn++) await null;
    // It draws as finely as the screen is, and paper is finer.
    Object.defineProperty(window, 'devicePixelRatio', {value: DENSITY, configurable: true});
    views.forEach((view) => {
      const {canvas} = view.export('png', true);
      place(view).nextElementSibling.replaceChildren(canvas);
    });
    Object.defineProperty(window, 'devicePixelRatio', density);
  });

  addEventListener('afterprint', () => {
    document.querySelectorAll('.paper').forEach((paper) => paper.replaceChildren());
    views.forEach((view) => { place(view).style.width = ''; });
    colours.set(before ?? 'auto');
    before = null;
  });
}
