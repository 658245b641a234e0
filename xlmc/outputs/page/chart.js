"use strict";
// One forecast drawn: bars or curves, dark between the grabbers, light outside.

const INK = "#1F3044", GRID = "#E3E8EE", DARK = "#2F6DA8", LIGHT = "#BCD3E8", BAND = "#F3EFE2";
const MARKS = { "Mean": [], "Base case": [7, 4], "Threshold": [2, 3] }, PERCENTILE = [1, 4]; // dashes
const FITTED = "#B3261E", SECOND = "#7B3FA0", MOST_BARS = 150;
const FONT = "12px system-ui, sans-serif";
const WIDEST = 660, HIGHEST = 300, POINTS = 600;

/** How wide a chart is: what its element has room for, but never wider than a printed page. */
function widthOf(element) {
  return Math.max(260, Math.min(WIDEST, Math.floor(element.clientWidth)));
}

/**
 * Draw a forecast with its bars into `element`; `state` has `view`, `low`, `high` and is read whenever the chart is drawn
 * again. `drawn()` is called then, and `pointed(value)` when the pointer is somewhere else; null when it has left.
 * `marks()` are the upright lines, `line` is a fitted distribution, `second` the
 * line of a second run, if they are drawn.
 */
function drawForecast(element, forecast, trials, bins, state, { drawn, pointed, marks, line, second }) {
  const { edges, counts } = bins;
  /** @type {[number, number]} */
  const ends = [edges[0], edges[edges.length - 1]];
  const highest = Math.max(...counts, ...[...(line ?? []), ...(second ?? [])].map(([, y]) => y));
  const top = state.view === "frequency" ? highest * 1.08 : 100;
  const shape = state.view === "frequency" ? bars(edges, counts) : curve(trials, ends, state.view);
  const options = chartOptions(widthOf(element), ends, top, forecast, state.view);
  if (bins.whole) options.axes[0].incrs = [1, 2, 5, 10, 20, 50, 100];
  options.hooks = {
    drawClear: [(chart) => band(chart, forecast.range)],
    draw: [
      (chart) => paint(chart, shape, marks(), bins.covered(state.low, state.high)),
      (chart) => line && trace(chart, line, FITTED, []),
      (chart) => second && trace(chart, second, SECOND, [8, 4]),
      drawn,
    ],
    setCursor: [(chart) => pointed(chart.cursor.left < 0 ? null : chart.posToVal(chart.cursor.left, "x"))],
  };
  return new uPlot(options, [ends, [0, top]], element);
}

/**
 * The bars of a forecast, and what part of the chart a range covers. Those of whole numbers stand over their numbers: a
 * range that ends at 6 holds the trials of 6.
 */
function barsOf({ bins, values }) {
  if (bins.width !== 1 || !values.every(Number.isInteger)) {
    return { ...bins, whole: false, covered: (low, high) => [low, high] };
  }
  return {
    ...bins,
    whole: true,
    edges: bins.edges.map((edge) => edge - 0.5),
    covered: (low, high) => [Math.ceil(low) - 0.5, Math.floor(high) + 0.5],
  };
}

/** The bars drawn so many as one, from the left on; the last may be of fewer. */
function merged(bins, together) {
  if (together === 1) return bins;
  const starts = [...bins.counts.keys()].filter((i) => i % together === 0);
  const groups = starts.map((i) => [i, bins.counts.slice(i, i + together)]);
  return {
    ...bins,
    edges: [...groups.map(([i]) => bins.edges[i]), bins.edges.at(-1)],
    counts: groups.map(([, counts]) => counts.reduce((sum, count) => sum + count, 0)),
    numbers: together,
  };
}

/** The bars with empty ones on either side, so that the trials of a second run have room. */
function widened(bins, second) {
  const edges = [...bins.edges], counts = [...bins.counts];
  const room = () => counts.length < MOST_BARS;
  for (; edges[0] > second.values[0] && room(); counts.unshift(0)) edges.unshift(edges[0] - bins.width);
  for (; edges.at(-1) <= second.values.at(-1) && room(); counts.push(0)) edges.push(edges.at(-1) + bins.width);
  return { ...bins, edges, counts };
}

/** A second run as bars of its own, as if it had as many trials; or its curve. */
function secondLine(second, { edges }, trials, view) {
  if (view !== "frequency") return curve(second, [edges[0], edges.at(-1)], view);
  const below = edges.map((edge) => second.reached(edge, false).count);
  const heights = below.slice(1).map((count, i) => ((count - below[i]) * trials) / second.trials);
  return [[edges[0], 0], ...bars(edges, heights), [edges.at(-1), 0]];
}

/** A fitted distribution as the trials it expects in each bar, or as the share that it expects up to a value. */
function fittedLine({ shares, parts }, { edges }, trials, together, view) {
  const at = shares.map((_, i) => {
    const bar = Math.min(Math.floor(i / parts), edges.length - 2);
    return edges[bar] + (edges[bar + 1] - edges[bar]) * (i / parts - bar);
  });
  if (view === "frequency") {
    const scale = trials * parts * together;
    return at.slice(1).map((x, i) => [(at[i] + x) / 2, (shares[i + 1] - shares[i]) * scale]);
  }
  return at.map((x, i) => [x, 100 * (view === "reverse" ? 1 - shares[i] : shares[i])]);
}

function fittedText({ name, parameters, distance }) {
  const off = `its cumulative curve is ${distance} off at most`;
  return `Red line: ${name} (${parameters}), fitted to the accepted trials; ${off}. No number of this page rests on it.`;
}

/** The days between the labels of dates and times, of which uPlot takes the least that has room. */
const INCREMENTS = [
  ...[1, 5, 10, 30, 60, 300, 600, 1800, 3600, 7200, 21600, 43200].map((seconds) => seconds / 86400),
  ...[1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 5000, 10000],
];

/**
 * What all charts of the page have in common.
 * @returns {any} options of uPlot
 */
function chartOptions(width, ends, top, { units, form }, view) {
  const thin = { stroke: "#8994A1", width: 1 };
  const axis = { stroke: INK, font: FONT, labelFont: FONT, labelSize: 22, ticks: { ...thin, size: 5 } };
  const longest = Math.max(...ends.map((end) => formText(end, decimalsOf((ends[1] - ends[0]) / 5), form).length));
  const counted = (_, splits) => splits.map((n) => (Number.isInteger(n) ? countText(n) : ""));
  return {
    width,
    height: Math.round(Math.max(220, Math.min(HIGHEST, width * 0.55))),
    padding: [27, Math.max(14, Math.ceil(3.7 * longest)), 0, 0], // room for half of the last number
    legend: { show: false },
    cursor: { y: false, points: { show: false }, drag: { x: false, y: false } },
    scales: { x: { time: false, range: ends }, y: { range: [0, top] } },
    axes: [
      {
        ...axis,
        label: units || " ",
        space: Math.max(50, 7 * longest + (form.moment ? 8 : 20)), // dates stand close: few of them are round
        values: (_, splits) => splits.map((at) => formText(at, decimalsOf(splits[1] - splits[0]), form)),
        ...(form.moment ? { incrs: INCREMENTS } : {}),
        size: 42,
        gap: 12,
        labelSize: 18,
        grid: { show: false },
        border: { ...thin, show: true },
      },
      {
        ...axis,
        label: view === "frequency" ? "Accepted trials" : "Accepted trials, %",
        size: 58,
        ticks: { show: false },
        grid: { stroke: GRID, width: 1 },
        values: counted,
      },
    ],
    series: [{}, { paths: () => null, points: { show: false } }],
  };
}

/** Corners [x, y] of the bars' outline, which stands on 0. */
function bars(edges, counts) {
  return counts.flatMap((count, i) => [[edges[i], count], [edges[i + 1], count]]);
}

/** The share of trials up to each of many values, or from it on. */
function curve(trials, [first, last], view) {
  return Array.from({ length: POINTS + 1 }, (_, i) => {
    const x = i === POINTS ? last : first + ((last - first) * i) / POINTS;
    const { count } = view === "reverse" ? trials.between(x, Infinity) : trials.between(-Infinity, x);
    return [x, (100 * count) / trials.trials];
  });
}

/** The forecast's own central range, behind everything. */
function band(chart, { low, high }) {
  const { left, right, top, height } = plot(chart);
  const from = Math.max(left, chart.valToPos(low, "x", true));
  const to = Math.min(right, chart.valToPos(high, "x", true));
  chart.ctx.fillStyle = BAND;
  chart.ctx.fillRect(from, top, to - from, height);
}

function paint(chart, shape, marks, [from, to]) {
  const { ctx } = chart;
  const { left, right, top, height } = plot(chart);
  const path = outline(chart, shape);
  const at = (value) => Math.min(right, Math.max(left, chart.valToPos(value, "x", true)));
  ctx.save();
  clip(ctx, left, top, right - left, height);
  ctx.fillStyle = LIGHT;
  ctx.fill(path);
  for (const { label, value } of marks) mark(ctx, chart.valToPos(value, "x", true), top, height, MARKS[label] ?? PERCENTILE);
  ctx.restore();
  ctx.save();
  clip(ctx, at(from), top, Math.max(0, at(to) - at(from)), height);
  ctx.fillStyle = DARK;
  ctx.fill(path);
  for (const { label, value } of marks) mark(ctx, chart.valToPos(value, "x", true), top, height, MARKS[label] ?? PERCENTILE);
  ctx.restore();
}

/** A line through points, within the plot. */
function trace(chart, points, colour, dashes) {
  const { ctx } = chart;
  const { left, right, top, height } = plot(chart);
  ctx.save();
  clip(ctx, left, top, right - left, height);
  ctx.beginPath();
  points.forEach(([x, y]) => ctx.lineTo(chart.valToPos(x, "x", true), chart.valToPos(y, "y", true)));
  ctx.lineWidth = 2 * uPlot.pxRatio;
  ctx.lineJoin = "round";
  ctx.strokeStyle = colour;
  ctx.setLineDash(dashes.map((dash) => dash * uPlot.pxRatio));
  ctx.stroke();
  ctx.restore();
}

function plot(chart) {
  const { left, top, width, height } = chart.bbox;
  return { left, top, height, right: left + width };
}

function clip(ctx, left, top, width, height) {
  ctx.beginPath();
  ctx.rect(left, top, width, height);
  ctx.clip();
}

function outline(chart, shape) {
  const path = new Path2D();
  const ground = chart.valToPos(0, "y", true);
  path.moveTo(chart.valToPos(shape[0][0], "x", true), ground);
  for (const [x, y] of shape) path.lineTo(chart.valToPos(x, "x", true), chart.valToPos(y, "y", true));
  path.lineTo(chart.valToPos(shape[shape.length - 1][0], "x", true), ground);
  path.closePath();
  return path;
}

function mark(ctx, x, top, height, dashes) {
  ctx.beginPath();
  ctx.setLineDash(dashes.map((dash) => dash * uPlot.pxRatio));
  ctx.lineWidth = 1.5 * uPlot.pxRatio;
  ctx.strokeStyle = INK;
  ctx.moveTo(x, top);
  ctx.lineTo(x, top + height);
  ctx.stroke();
  ctx.setLineDash([]);
}
