/* Copyright 2026 DDCT team
 * SPDX-License-Identifier: Apache-2.0 */
'use strict';

addEventListener('beforeprint', () => document.querySelectorAll('details').forEach((each) => { each.open = true; }));
requestAnimationFrame(() => { window.reportReady = performance.now(); });
