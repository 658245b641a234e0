// Numbers of handles: steps, ranges that are typed into one box, and what may stand where on an axis.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { runInThisContext } from "node:vm";

for (const path of ["page/numbers.js", "live/page/handles.js"]) {
  runInThisContext(readFileSync(new URL(`../../../../xlmc/outputs/${path}`, import.meta.url), "utf8"));
}
const { formTyped, onStep, stepText, typedRange, Track } = runInThisContext("({ formTyped, onStep, stepText, typedRange, Track })");
const DAYS = { factor: 1, before: "", after: "", moment: "day", epoch: 25569 };

test("a value lies on the grid of its step, without the dust of binary fractions", () => {
  for (const [value, step, found] of [[0.31, 0.1, 0.3], [0.7000000000000001, 0.01, 0.7], [54, 10, 50], [-2.6, 0.5, -2.5],
    [1e-7, 1e-8, 1e-7], [123456.4, 1, 123456]]) assert.equal(onStep(value, step), found, `${value} by ${step}`);
  for (let i = -1000; i <= 1000; i++) assert.equal(onStep(i / 100, 0.01), i / 100);
});

test("a number has the decimals of its step, or more where it needs them", () => {
  for (const [value, step, text] of [[0.7, 0.01, "0.70"], [50, 10, "50"], [0.123456, 0.01, "0.123456"], [null, 1, ""],
    [undefined, 1, ""], [2, 0.5, "2.0"]]) assert.equal(stepText(value, step), text, `${value} by ${step}`);
});

test("dates are written and read as such", () => {
  assert.equal(stepText(46082, 1, DAYS), "2026-03-01");
  assert.equal(stepText(null, 1, DAYS), "");
  for (const [value, text] of [[1e308, "1e+308"], [-1, "-1"], [2958465, "9999-12-31"], [2958466, "2958466"]]) {
    assert.equal(stepText(value, 1, DAYS), text);
  }
  const read = (text) => formTyped(text, null, DAYS);
  const { low, high, middle } = typedRange("2026-03-01 to 2026-04-01", read);
  assert.deepEqual([low, high, middle], [46082, 46113, null]);
  assert.deepEqual(typedRange("2026-03-11 ± 10", read), { low: 46082, high: 46102, middle: 46092, share: false });
  assert.equal(typedRange("2026-03-01", read), null);
});

const PERCENT = { factor: 100, before: "", after: " %", moment: null };
const MONEY = { factor: 1, before: "$", after: "", moment: null };

test("percentages and money are written as their cells show them, and read so", () => {
  for (const [value, step, form, text] of [[0.12, 0.001, PERCENT, "12.0 %"], [0.1234567, 0.001, PERCENT, "12.34567 %"], [0.05, 0.01, PERCENT, "5 %"],
    [180000, 1000, MONEY, "$180,000"], [-1.25, 1, MONEY, "-$1.25"], [1e-9, 1e-10, PERCENT, "1e-7 %"]]) {
    assert.equal(stepText(value, step, form), text);
    if (!text.includes("e")) assert.equal(formTyped(text, null, form), value, text);
  }
  for (const [text, value] of [["12 %", 0.12], ["12%", 0.12], ["12", 0.12], ["=6%*2", 0.12], ["0.5 %", 0.005], ["twelve", null]]) {
    assert.equal(formTyped(text, null, PERCENT), value, text);
  }
  for (const [text, value] of [["$1,200", 1200], ["1200", 1200], ["-$5", -5], ["12 %", null], ["=600*2", 1200]]) {
    assert.equal(formTyped(text, null, MONEY), value, text);
  }
  const ends = (text, form) => { const found = typedRange(text, (part) => formTyped(part, null, form), form.factor === 100); return [found.low, found.high]; };
  assert.deepEqual(ends("4 % to 12 %", PERCENT), [0.04, 0.12]);
  assert.deepEqual(ends("12 % ± 1 %", PERCENT), [0.11, 0.13]);
  assert.deepEqual(ends("$200 ± 10 %", MONEY), [180, 220]);
  assert.deepEqual(ends("$180,000 to $200,000", MONEY), [180000, 200000]);
});

test("dates are read in the order of their cell, and times of day with AM and PM", () => {
  const day = (order) => ({ ...DAYS, order });
  for (const [text, order, value] of [["1 Mar 2026", "dmy", 46082], ["01/03/2026", "dmy", 46082], ["3/1/26", "mdy", 46082], ["March 1, 2026", "mdy", 46082],
    ["Sun 1-Mar-26", "dmy", 46082], ["2026-03-01", "dmy", 46082], ["1 Mar 2026 6:00 AM", "dmy", 46082.25], ["2026-03-01 18:00", "ymd", 46082.75],
    ["7:30 PM", "ymd", 19.5 / 24], ["12:00 AM", "ymd", 0], ["49:15", "ymd", 49.25 / 24]]) {
    assert.ok(Math.abs(formTyped(text, null, day(order)) - value) < 1e-9, text);
  }
  for (const text of ["31/02/2026", "1 Mar", "13:00 PM", "soon", "99/99/9999"]) assert.equal(formTyped(text, null, day("dmy")), null, text);
});

test("two ends are read from one box", () => {
  const ends = (text) => { const found = typedRange(text); return found && [found.low, found.high]; };
  for (const text of ["0.6 to 0.8", "0.8 to 0.6", "0.6 … 0.8", "0.6..0.8", "0.6–0.8", "0.7 ± 0.1", "0.7 +/- 0.1", "0.7 +- 0.1",
    "0,6 bis 0,8"]) assert.deepEqual(ends(text), [0.6, 0.8], text);
  assert.deepEqual(ends("200 ± 10 %"), [180, 220]);
  assert.deepEqual(ends("-5 to -2"), [-5, -2]);
  assert.equal(typedRange("0.7 ± 0.1").middle, 0.7);
  assert.equal(typedRange("0.6 to 0.8").middle, null);
  assert.equal(typedRange("200 ± 10 %").share, true);
  for (const text of ["0.7", "to 0.8", "0.6 to", "a to b", "", "=0.7+-0.1"]) assert.equal(typedRange(text), null, text);
});

test("handles that rise stay in their order, others go where they like", () => {
  const track = (numbers) => Object.assign(Object.create(Track.prototype), { numbers });
  const triangle = track([["low", 1], ["likeliest", 2], ["high", 3]].map(([key, value]) => ({ key, value })));
  for (const [key, wanted, found] of [["low", 2.5, 2], ["low", 0, 0], ["likeliest", 5, 3], ["likeliest", 0, 1], ["high", 1.5, 2]]) {
    assert.equal(triangle.allowed(key, wanted), found, `${key} ${wanted}`);
  }
  assert.equal(track([{ key: "at_least", value: 1 }, { key: "at_most", value: null }]).allowed("at_least", 9), 9);
  assert.equal(track([{ key: "value", value: 50 }]).allowed("value", 1e6), 1e6);
});

test("an axis has room on both sides, and stays while it is good", () => {
  const track = Object.assign(Object.create(Track.prototype), {
    numbers: [{ value: 50, own: 50 }], ticks: [30, 70], shape: null, own: null, mark: null, ends: { children: [{}, {}] } });
  track.fit();
  assert.deepEqual(track.axis, [18, 82]);
  assert.equal(track.at(50), 50);
  assert.equal(track.at(1e9), 100);
  track.numbers[0].value = 60;
  track.fit();
  assert.deepEqual(track.axis, [18, 82]);
  track.numbers[0].value = 200;
  track.fit();
  assert.ok(track.axis[1] > 200);
});
