// The bars of a chart in the window, where more or fewer were asked for.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { runInThisContext } from "node:vm";

globalThis.Panel = class {};
runInThisContext(readFileSync(new URL("../../../../xlmc/outputs/live/page/live_chart.js", import.meta.url), "utf8"));
/* global divided */

const BARS = {
  edges: [0, 1, 2, 3], counts: [6, 10, 3], width: 1, decimals: 0, whole: false, parts: [[1, 2, 2, 1], [1, 4, 4, 1], [0, 0, 1, 2]],
};

test("with no number wanted the bars are as they were", () => {
  assert.equal(divided(BARS, null), BARS);
});

test("more and fewer bars hold the same trials, in equal numbers of parts", () => {
  const { edges, counts, numbers, decimals } = divided(BARS, 6);
  assert.deepEqual(edges, [0, 0.5, 1, 1.5, 2, 2.5, 3]);
  assert.deepEqual(counts, [3, 3, 5, 5, 0, 3]);
  assert.equal(numbers, 0.5);
  assert.equal(decimals, 1);
  assert.deepEqual(divided(BARS, 1).counts, [19]);
  assert.deepEqual(divided(BARS, 3).counts, BARS.counts);
  assert.equal(divided(BARS, 500).counts.length, 12);
});

test("the last bar may be of fewer parts, and a width takes the decimals that it needs", () => {
  const { edges, counts, numbers, decimals } = divided(BARS, 2.4);
  assert.deepEqual(edges, [0, 1.25, 2.5, 3]);
  assert.deepEqual(counts, [7, 9, 3]);
  assert.equal(numbers, 1.25);
  assert.equal(decimals, 2);
});

test("bars of whole numbers are not divided, but several are one", () => {
  const whole = { ...BARS, whole: true, edges: [-0.5, 0.5, 1.5, 2.5], parts: [[6], [10], [3]] };
  assert.deepEqual(divided(whole, 40).edges, whole.edges);
  assert.deepEqual(divided(whole, 2).edges, [-0.5, 1.5, 2.5]);
});
