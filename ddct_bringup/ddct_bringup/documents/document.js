/* Copyright 2026 DDCT team
 * SPDX-License-Identifier: Apache-2.0 */
'use strict';

// Draws the charts of a document; `drawn` tells scripts of charts with controls their views by place.
(async () => {
  const data = JSON.parse(document.getElementById('data').textContent);
  const places = Object.keys(data.roots);
  if (places.length) {
    const views = await drawCharts(data);
    const byPlace = Object.fromEntries(places.map((place, at) => [place, views[at]]));
    dispatchEvent(new CustomEvent('drawn', {detail: byPlace}));
    printCharts(views);
  }
  requestAnimationFrame(() => { window.reportReady = performance.now(); });
})();
