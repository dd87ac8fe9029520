/* Copyright 2026 DDCT team
 * SPDX-License-Identifier: Apache-2.0 */
// Draws the maps of the data in #data: cells on a grid, points of samples, one scale of colours.
(() => {
  const {maps: data, ramp, replay} = JSON.parse(document.getElementById('data').textContent);
  if (!data) return;
  // A map of samples draws the points of all maps, or those at the places that it gives.
  const part = (values, places) => (places && values ? places.map((place) => values[place]) : values);
  data.maps.filter((map) => !map.cells).forEach((map) => {
    map.panels = map.panels.map((places, group) => {
      const {at, values, ...others} = data.points[group];
      const columns = Object.entries(others).map(([name, each]) => [name, part(each, places)]);
      return {
        ...Object.fromEntries(columns),
        at: map.keys.map((key) => part(at[data.numbers.indexOf(key)], places)),
        values: Object.fromEntries(Object.entries(values).map(([key, each]) => [key, part(each, places)])),
      };
    });
  });
  const SVG = 'http://www.w3.org/2000/svg';
  const HEIGHT = 300, LEFT = 62, RIGHT = 8, TOP = 6, BOTTOM = 44, LINE = 13;
  const STEP = 6;
  const HATCHES = [['rising'], ['falling'], ['level'], ['upright'], ['rising', 'falling'], ['level', 'upright']];
  const UNDEFINED = 'no value';
  const choice = Object.fromEntries(['map', 'quantity'].map((name) => [name, document.getElementById(name)]));
  const places = [...document.querySelectorAll('.map')];
  const detail = document.querySelector('.detail');
  const advice = detail.textContent;

  const words = [...new Set(data.maps.flatMap((map) => map.panels.flatMap((panel) => panel.state)))]
    .filter((state) => state !== 'engaged').sort();
  const state_text = (state) => state.replace('_', ' ');
  const number = (value, digits = 12) => String(Number(value.toPrecision(digits))).replace('-', '\u2212');

  function element(name, attributes = {}, text = '') {
    const made = document.createElementNS(SVG, name);
    Object.entries(attributes).forEach(([key, value]) => made.setAttribute(key, value));
    if (text) made.textContent = text;
    return made;
  }

  // The lines of a box that is not engaged, cut off at its edges: a pattern stops the printing.
  function hatched(word, {x, y, width, height}) {
    const right = x + width, bottom = y + height;
    const lines = {
      rising: [x + y, right + bottom, (at) => [Math.max(x, at - bottom), Math.min(bottom, at - x), Math.min(right, at - y), Math.max(y, at - right)]],
      falling: [y - right, bottom - x, (at) => [Math.max(x, y - at), Math.max(y, x + at), Math.min(right, bottom - at), Math.min(bottom, right + at)]],
      level: [y, bottom, (at) => [x, at, right, at]],
      upright: [x, right, (at) => [at, y, at, bottom]],
    };
    const kinds = word === UNDEFINED ? [] : HATCHES[words.indexOf(word) % HATCHES.length];
    const path = kinds.flatMap((kind) => {
      const [from, to, line] = lines[kind];
      const drawn = [];
      for (let at = Math.ceil(from / STEP) * STEP; at < to; at += STEP) {
        const [x1, y1, x2, y2] = line(at).map((each) => each.toFixed(1));
        drawn.push(`M${x1} ${y1}L${x2} ${y2}`);
      }
      return drawn;
    });
    return element('path', {d: path.join(''), class: 'hatch'});
  }

  function colourOf(value, {low, high}) {
    const place = high > low ? Math.min(Math.max((Math.abs(value) - low) / (high - low), 0), 1) : 0;
    return ramp[Math.round(place * (ramp.length - 1))];
  }

  function inkOn(colour) {
    const [red, green, blue] = [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16));
    return 0.3 * red + 0.6 * green + 0.1 * blue > 128 ? '#000000' : '#ffffff';
  }

  // What there is to say of one cell or point.
  function cellOf(map, panel, place, quantity) {
    const runs = panel.runs[place], failed = panel.failed[place], invalid = panel.invalid[place];
    const share = quantity.key === 'failed_share';
    const value = share ? (runs > invalid ? failed / (runs - invalid) : null) : panel.values[quantity.key][place];
    const lost = invalid > 0 || (!share && failed > 0);
    const count = invalid ? invalid : failed;
    const state = panel.state[place];
    const word = lost ? (runs > 1 ? `${count} of ${runs} ${invalid ? 'invalid' : 'failed'}` : state_text(state)) : value === null ? UNDEFINED : '';
    const index = lost || share || !panel.rows ? panel.index[place] : panel.rows[quantity.key][place] ?? panel.index[place];
    const at = map.keys.map((key, axis) => `${key} ${number(panel.at[axis][place])}`);
    const worth = value === null ? `${quantity.title}: no value` : `${quantity.title}: ${number(value, 4)}`;
    const interval = panel.intervals?.[place].map((end) => number(100 * end, 3)).join(' to ');
    const came = runs > 1 ? `${failed} of ${runs} runs failed (95 % interval ${interval} %)${invalid ? `, ${invalid} invalid` : ''}` : state_text(state);
    return {value, word, alone: runs === 1, state: lost ? state : value === null ? UNDEFINED : '', index, text: `${data.groups[panel.group]}, ${at.join(', ')}: ${came}. ${worth}. Run ${index}.`};
  }

  function axisOf(values, start, length, cells) {
    if (cells) {
      const distinct = [...new Set(values)].sort((a, b) => a - b);
      const step = length / distinct.length;
      return {step, place: (value) => start + (distinct.indexOf(value) + 0.5) * step, ticks: distinct};
    }
    const low = Math.min(...values), high = Math.max(...values), span = high - low || 1;
    const raw = span / 5, power = 10 ** Math.floor(Math.log10(raw));
    const step = [1, 2, 5, 10].map((factor) => factor * power).find((each) => each >= raw);
    const ticks = [];
    for (let tick = Math.ceil(low / step); tick * step <= high; tick++) ticks.push(Number((tick * step).toPrecision(12)));
    return {step: 0, place: (value) => start + length * (0.03 + 0.94 * (value - low) / span), ticks};
  }

  function draw(place, map, panel, quantity) {
    const width = Math.max(place.clientWidth, 260);
    const height = map.keys[1] ? HEIGHT : 120;
    const all = (axis) => map.panels.flatMap((each) => each.at[axis]);
    const x = axisOf(all(0), LEFT, width - LEFT - RIGHT, map.cells);
    const length = height - TOP - BOTTOM;
    const upward = map.keys[1] ? axisOf(all(1), 0, length, map.cells) : {step: length, place: () => length / 2, ticks: []};
    const up = (value) => TOP + length - upward.place(value);
    const svg = element('svg', {viewBox: `0 0 ${width} ${height}`, role: 'img', 'aria-label': `${quantity.title}, ${data.groups[panel.group]}`});
    const cells = panel.index.map((_, at) => ({
      ...cellOf(map, panel, at, quantity),
      x: x.place(panel.at[0][at]),
      y: map.keys[1] ? up(panel.at[1][at]) : TOP + length / 2,
    }));
    cells.forEach((cell) => {
      svg.append(...(map.cells ? tile(cell, x.step, upward.step, quantity) : dot(cell, quantity)));
    });
    if (map.cells) svg.append(...captions(cells, x.step, upward.step, quantity));
    axes(svg, map, x, upward, up, width, height);
    place.querySelector('.field').replaceChildren(svg);
  }

  function listening(shape, cell) {
    shape.append(element('title', {}, cell.text));
    ['pointerenter', 'click'].forEach((event) => shape.addEventListener(event, () => tell(shape, cell)));
    return shape;
  }

  function tell(shape, cell) {
    document.querySelectorAll('.chosen').forEach((each) => each.classList.remove('chosen'));
    shape.classList.add('chosen');
    const command = document.createElement('code');
    command.textContent = replay.replaceAll('INDEX', cell.index);
    detail.replaceChildren(cell.text, document.createElement('br'), command);
  }

  function tile(cell, width, height, quantity) {
    const box = {x: cell.x - width / 2, y: cell.y - height / 2, width, height};
    const rect = listening(element('rect', {...box, class: 'cell', 'stroke-width': Math.min(width, height) < LINE ? 0 : 1}), cell);
    if (cell.state) return [rect, hatched(cell.state, box)];
    rect.setAttribute('fill', colourOf(cell.value, quantity));
    return [rect];
  }

  // The word of all neighbours in a row that share it, where there is room; rows too low for text have
  // it now and then. Values stand in the cells where there is room for all of them.
  function captions(cells, width, height, quantity) {
    const every = height < LINE ? Math.ceil(3 * LINE / height) : 1;
    const shown = [];
    [...cells].sort((a, b) => a.y - b.y || a.x - b.x).forEach((cell) => {
      const last = shown.at(-1);
      const near = last && last.y === cell.y && cell.x - last.to < 1.5 * width;
      if (cell.word && cell.alone && near && last.text === cell.word) last.to = cell.x;
      else shown.push({text: cell.word || number(cell.value, 3), colour: cell.state ? '' : colourOf(cell.value, quantity), y: cell.y, from: cell.x, to: cell.x});
    });
    const row = ({y}) => Math.floor((y - TOP) / height);
    const fits = ({text, from, to}) => text.length * 5.8 + 4 <= to - from + width;
    const valued = every === 1 && shown.filter((each) => each.colour).every(fits);
    return shown.filter((each) => (each.colour ? valued : fits(each) && row(each) % every === every >> 1))
      .map(({text, colour, y, from, to}) => element('text', {
        x: (from + to) / 2, y: y + 3.5, 'text-anchor': 'middle', 'font-size': 10, 'pointer-events': 'none',
        ...(colour ? {style: `fill:${inkOn(colour)}`} : {class: 'word'}),
      }, text));
  }

  function dot(cell, quantity) {
    const {x, y} = cell;
    if (!cell.state) {
      return [listening(element('circle', {cx: x, cy: y, r: 4.5, fill: colourOf(cell.value, quantity), class: 'cell'}), cell)];
    }
    const box = {x: x - 5, y: y - 5, width: 10, height: 10};
    return [listening(element('rect', {...box, class: 'cell lost'}), cell), hatched(cell.state, box)];
  }

  function axes(svg, map, x, upward, up, width, height) {
    const bottom = height - BOTTOM;
    svg.append(element('path', {d: `M${LEFT} ${TOP}V${bottom}H${width - RIGHT}`, fill: 'none', style: 'stroke:var(--soft)'}));
    const label = (at, y, text, anchor) => element('text', {x: at, y, 'text-anchor': anchor, class: 'axis-text', 'font-size': 11}, text);
    const longest = Math.max(...x.ticks.map((tick) => number(tick, 4).length));
    const every = map.cells ? Math.ceil((longest * 7 + 6) / x.step) : 1;
    x.ticks.filter((_, at) => at % every === 0).forEach((tick) => svg.append(label(x.place(tick), bottom + 15, number(tick, 4), 'middle')));
    const rows = map.cells ? Math.ceil(LINE / upward.step) : 1;
    upward.ticks.filter((_, at) => at % rows === 0).forEach((tick) => svg.append(label(LEFT - 6, up(tick) + 4, number(tick, 4), 'end')));
    svg.append(label((LEFT + width - RIGHT) / 2, height - 8, map.keys[0], 'middle'));
    if (map.keys[1]) {
      const title = element('text', {transform: `translate(12 ${(TOP + bottom) / 2}) rotate(-90)`, 'text-anchor': 'middle', class: 'axis-text', 'font-size': 11}, map.keys[1]);
      svg.append(title);
    }
  }

  function legend(map, quantity) {
    const drawn = new Set(map.panels.flatMap((panel, group) => panel.index.map(
      (_, at) => cellOf(map, {...panel, group}, at, quantity).state)));
    document.getElementById('low').textContent = number(quantity.low, 4);
    document.getElementById('high').textContent = number(quantity.high, 4);
    document.querySelector('.ramp').style.background = `linear-gradient(to right, ${ramp.join(',')})`;
    document.getElementById('states').replaceChildren(...[...words, UNDEFINED].filter((word) => drawn.has(word)).map((word) => {
      const item = document.createElement('span');
      item.className = 'item';
      const svg = element('svg', {viewBox: '0 0 26 14', 'aria-hidden': 'true'});
      svg.append(hatched(word, {x: 0, y: 0, width: 26, height: 14}));
      item.append(svg, state_text(word));
      return item;
    }));
  }

  function show() {
    const map = data.maps[choice.map.value];
    const quantity = data.quantities[choice.quantity.value];
    detail.textContent = advice;
    const others = Object.entries(map.others).map(([key, value]) => `${key} ${number(value)}`);
    document.getElementById('others').textContent = `Drawn: ${map.extent}${others.length ? `, those with ${others.join(', ')}` : ''}.`;
    places.forEach((place, group) => draw(place, map, {...map.panels[group], group}, quantity));
    legend(map, quantity);
  }

  Object.values(choice).forEach((select) => {
    select.disabled = false;
    select.addEventListener('change', show);
  });
  addEventListener('resize', show);
  show();
})();

addEventListener('beforeprint', () => document.querySelectorAll('details').forEach((each) => { each.open = true; }));
requestAnimationFrame(() => { window.reportReady = performance.now(); });
