// Which part of a chart is drawn where it is zoomed.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { runInThisContext } from "node:vm";

globalThis.Panel = class {};
runInThisContext(readFileSync(new URL("../../../../xlmc/outputs/live/page/live_chart.js", import.meta.url), "utf8"));
/* global highestIn, zoomedTo */

const BINS = { edges: [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10], width: 1 };

test("a range has room on both sides, of two bars at least", () => {
  assert.deepEqual(zoomedTo({ low: 4, high: 5 }, BINS), [2, 7]);
  assert.deepEqual(zoomedTo({ low: 4, high: 4 }, BINS), [2, 6]);
  assert.deepEqual(zoomedTo({ low: -Infinity, high: Infinity }, BINS), [-2, 12]);
  assert.deepEqual(zoomedTo({ low: 100, high: 300 }, { edges: [0, 1000], width: 1 }), [70, 330]);
});

test("the height is that of the bars that can be seen", () => {
  const edges = [0, 1, 2, 3, 4], counts = [9, 1, 2, 7];
  assert.equal(highestIn([1, 3], edges, counts), 2);
  assert.equal(highestIn([0.5, 3], edges, counts), 9);
  assert.equal(highestIn([3.9, 8], edges, counts), 7);
  assert.equal(highestIn([40, 80], edges, counts), 0);
});
