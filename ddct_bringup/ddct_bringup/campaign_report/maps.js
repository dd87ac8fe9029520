/* Copyright 2026 DDCT team
 * SPDX-License-Identifier: Apache-2.0 */
// Fills the maps of Bokeh with the cells or points of the chosen numbers and quantity.
addEventListener('drawn', ({detail: views}) => {
  const {maps: data, ramp, replay} = JSON.parse(document.getElementById('maps-data').textContent);
  const LINE = 14, LETTER = 6.2;
  const HATCHES = {rising: '/', falling: '\\', level: '-', upright: '|', crossed: 'x', grid: '+'};
  const UNDEFINED = 'no value';
  // Readable on a light and on a dark page, and on paper from either.
  const GROUND = '#80808020', INK = '#000000', PAPER = '#ffffffe0';
  const choice = Object.fromEntries(['map', 'quantity'].map((name) => [name, document.getElementById(name)]));
  const detail = document.querySelector('.detail');
  const advice = detail.textContent;
  const charts = data.groups.map((_, group) => views[`map-${group}`]);
  const shapes = ['cells', 'points'];

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
  const words = [...new Set(data.maps.flatMap((map) => map.panels.flatMap((panel) => panel.state)))]
    .filter((state) => state !== 'engaged').sort();
  const kindOf = (word) => Object.keys(HATCHES)[words.indexOf(word) % Object.keys(HATCHES).length];
  const stateText = (state) => state.replace('_', ' ');
  const number = (value, digits = 12) => String(Number(value.toPrecision(digits))).replace('-', '\u2212');

  function sourceOf(chart, name) {
    return chart.model.renderers.find((each) => each.name === name).data_source;
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
  function cellOf(map, panel, group, place, quantity) {
    const runs = panel.runs[place], failed = panel.failed[place], invalid = panel.invalid[place];
    const share = quantity.key === 'failed_share';
    const value = share ? (runs > invalid ? failed / (runs - invalid) : null) : panel.values[quantity.key][place];
    const lost = invalid > 0 || (!share && failed > 0);
    const count = invalid ? invalid : failed;
    const state = panel.state[place];
    const word = lost ? (runs > 1 ? `${count} of ${runs} ${invalid ? 'invalid' : 'failed'}` : stateText(state)) : value === null ? UNDEFINED : '';
    const index = lost || share || !panel.rows ? panel.index[place] : panel.rows[quantity.key][place] ?? panel.index[place];
    const at = map.keys.map((key, axis) => `${key} ${number(panel.at[axis][place])}`);
    const worth = value === null ? `${quantity.title}: no value` : `${quantity.title}: ${number(value, 4)}`;
    const interval = panel.intervals?.[place].map((end) => number(100 * end, 3)).join(' to ');
    const came = runs > 1 ? `${failed} of ${runs} runs failed (95 % interval ${interval} %)${invalid ? `, ${invalid} invalid` : ''}` : stateText(state);
    return {value, word, alone: runs === 1, state: lost ? state : value === null ? UNDEFINED : '', index, text: `${data.groups[group]}, ${at.join(', ')}: ${came}. ${worth}. Run ${index}.`};
  }

  // Cells stand side by side, whatever their values; points stand at their values.
  function setAxis(range, axis, values, key, cells, length) {
    const distinct = [...new Set(values)].sort((a, b) => a - b);
    axis.axis_label = key;
    if (cells) {
      const longest = Math.max(...distinct.map((value) => number(value, 4).length));
      const every = Math.ceil(((axis.dimension === 0 ? longest * LETTER + 6 : LINE) * distinct.length) / length);
      const shown = distinct.map((value, at) => [at, number(value, 4)]).filter(([at]) => at % every === 0);
      axis.ticker = new (Bokeh.Models.get('FixedTicker'))({ticks: shown.map(([at]) => at)});
      axis.major_label_overrides = new Map(shown);
      range.setv({start: -0.5, end: distinct.length - 0.5, reset_start: -0.5, reset_end: distinct.length - 0.5});
      return (value) => distinct.indexOf(value);
    }
    const low = distinct[0], high = distinct.at(-1), margin = 0.03 * (high - low || 1);
    axis.ticker = new (Bokeh.Models.get('BasicTicker'))();
    axis.major_label_overrides = new Map();
    range.setv({start: low - margin, end: high + margin, reset_start: low - margin, reset_end: high + margin});
    return (value) => value;
  }

  function draw(chart, map, panel, group, quantity) {
    const {model} = chart, box = chart.frame.bbox;
    const all = (axis) => map.panels.flatMap((each) => each.at[axis]);
    const x = setAxis(model.x_range, model.below[0], all(0), map.keys[0], map.cells, box.width);
    const up = map.keys[1] ? all(1) : [0];
    const y = setAxis(model.y_range, model.left[0], up, map.keys[1] ?? '', map.cells || !map.keys[1], box.height);
    model.left[0].visible = Boolean(map.keys[1]);
    const cells = panel.index.map((_, at) => ({
      ...cellOf(map, panel, group, at, quantity),
      x: x(panel.at[0][at]),
      y: y(map.keys[1] ? panel.at[1][at] : 0),
    }));
    const columns = {
      x: cells.map((cell) => cell.x),
      y: cells.map((cell) => cell.y),
      width: cells.map(() => 1),
      height: cells.map(() => 1),
      colour: cells.map((cell) => (cell.state ? GROUND : colourOf(cell.value, quantity))),
      hatch: cells.map((cell) => HATCHES[kindOf(cell.state)] ?? ' '),
      mark: cells.map((cell) => (cell.state ? 'square' : 'circle')),
      text: cells.map((cell) => cell.text),
      place: cells.map((cell) => cell.index),
    };
    const empty = Object.fromEntries(Object.keys(columns).map((name) => [name, []]));
    shapes.forEach((name) => {
      const source = sourceOf(chart, name);
      source.selected.indices = [];
      source.data = (name === 'cells') === map.cells ? columns : empty;
    });
    const across = box.width / (model.x_range.end - model.x_range.start);
    const high = box.height / (model.y_range.end - model.y_range.start);
    const shown = map.cells ? captions(cells, across, high, quantity) : [];
    sourceOf(chart, 'words').data = {
      x: shown.map((each) => (each.from + each.to) / 2),
      y: shown.map((each) => each.y),
      word: shown.map((each) => each.text),
      colour: shown.map((each) => (each.colour ? inkOn(each.colour) : INK)),
      ground: shown.map((each) => each.colour || PAPER),
    };
  }

  // The word of all neighbours in a row that share it, where there is room; rows too low for text have
  // it now and then. Values stand in the cells where there is room for all of them.
  function captions(cells, width, height, quantity) {
    const every = height < LINE ? Math.ceil(3 * LINE / height) : 1;
    const shown = [];
    [...cells].sort((a, b) => a.y - b.y || a.x - b.x).forEach((cell) => {
      const last = shown.at(-1);
      const near = last && last.y === cell.y && cell.x - last.to < 1.5;
      if (cell.word && cell.alone && near && last.text === cell.word) last.to = cell.x;
      else shown.push({text: cell.word || number(cell.value, 3), colour: cell.state ? '' : colourOf(cell.value, quantity), y: cell.y, from: cell.x, to: cell.x});
    });
    const fits = ({text, from, to}) => text.length * LETTER + 4 <= (to - from + 1) * width;
    const valued = every === 1 && shown.filter((each) => each.colour).every(fits);
    return shown.filter((each) => (each.colour ? valued : fits(each) && each.y % every === every >> 1));
  }

  function tell(chart, name) {
    const {data: columns, selected} = sourceOf(chart, name);
    const [chosen] = selected.indices;
    if (chosen === undefined) return;
    const command = document.createElement('code');
    command.textContent = replay.replaceAll('INDEX', columns.place[chosen]);
    detail.replaceChildren(columns.text[chosen], document.createElement('br'), command);
  }

  function legend(map, quantity) {
    const drawn = new Set(map.panels.flatMap((panel, group) => panel.index.map(
      (_, at) => cellOf(map, panel, group, at, quantity).state)));
    document.getElementById('low').textContent = number(quantity.low, 4);
    document.getElementById('high').textContent = number(quantity.high, 4);
    document.querySelector('.ramp').style.background = `linear-gradient(to right, ${ramp.join(',')})`;
    document.getElementById('states').replaceChildren(...[...words, UNDEFINED].filter((word) => drawn.has(word)).flatMap((word) => {
      const sample = document.createElement('i');
      sample.className = `hatch ${kindOf(word) ?? ''}`;
      return [sample, stateText(word)];
    }));
  }

  function show() {
    const map = data.maps[choice.map.value];
    const quantity = data.quantities[choice.quantity.value];
    detail.textContent = advice;
    const others = Object.entries(map.others).map(([key, value]) => `${key} ${number(value)}`);
    document.getElementById('others').textContent = `Drawn: ${map.extent}${others.length ? `, those with ${others.join(', ')}` : ''}.`;
    charts.forEach((chart, group) => draw(chart, map, map.panels[group], group, quantity));
    legend(map, quantity);
  }

  charts.forEach((chart) => shapes.forEach((name) => {
    sourceOf(chart, name).selected.properties.indices.change.connect(() => tell(chart, name));
  }));
  Object.values(choice).forEach((select) => {
    select.disabled = false;
    select.addEventListener('change', show);
  });
  // To print changes the size of the window; the charts on paper are those of the screen.
  let printing = false;
  addEventListener('beforeprint', () => { printing = true; });
  addEventListener('afterprint', () => { printing = false; });
  addEventListener('resize', () => { if (!printing) show(); });
  show();
});
