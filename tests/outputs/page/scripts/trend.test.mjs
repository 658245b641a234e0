// Ranges side by side: what lies on one axis, and how far it reaches.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { runInThisContext } from "node:vm";

runInThisContext(readFileSync(new URL("../../../../xlmc/outputs/live/page/trend.js", import.meta.url), "utf8"));
/* global onOneAxis, trendAxis, trendOf */

const PLAIN = { factor: 1, before: "", after: "" };
const panel = (name, units, form = PLAIN) => ({
  forecast: { name, units, form, range: { low: 2, high: 4, lowText: "2", highText: "4" } }, trials: { quantile: (p) => 10 * p } });

test("quantities of one unit and form lie on one axis, and single ones on none", () => {
  const [a, b, c, d, e] = [panel("a", "mph"), panel("b", "ft"), panel("c", "mph"), panel("d", "mph", { ...PLAIN, moment: "date" }),
    panel("e", "s")];
  assert.deepEqual(onOneAxis([a, b, c, d, e]), [[a, c]]);
  assert.deepEqual(onOneAxis([a]), []);
});

test("a row says where the range, the percentiles and the median lie", () => {
  assert.deepEqual(trendOf(panel("a", "mph")), { name: "a", range: [2, 4], tails: [0.5, 9.5], median: 5, text: "2 to 4 mph" });
  assert.equal(trendOf(panel("a", "")).text, "2 to 4");
});

test("an axis has room for all rows, also where nothing varies", () => {
  assert.deepEqual(trendAxis([{ range: [2, 4], tails: [0, 10] }, { range: [5, 50], tails: [1, 100] }]), [-4, 104]);
  assert.deepEqual(trendAxis([{ range: [5, 5], tails: [5, 5] }]), [4.5, 5.5]);
  assert.deepEqual(trendAxis([{ range: [0, 0], tails: [0, 0] }]), [-1, 1]);
});
