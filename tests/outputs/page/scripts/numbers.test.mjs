// Numbers as people read and type them.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { runInThisContext } from "node:vm";

runInThisContext(readFileSync(new URL("../../../../xlmc/outputs/page/numbers.js", import.meta.url), "utf8"));
/* global SIGNS, computed, countText, countedText, decimalText, decimalsOf, estimateText, formText, percentText, plainNumber, typed, whyNoNumber */

const PLAIN = { factor: 1, before: "", after: "" };

test("what is counted has its noun", () => {
  assert.deepEqual([0, 1, 3542].map((count) => countedText(count, "trial")), ["0 trials", "1 trial", "3,542 trials"]);
});

test("a step of an axis is written with all its decimals, and with no more", () => {
  for (const [step, decimals] of [[1, 0], [2, 0], [5, 0], [10, 0], [25, 0], [2.5, 1], [0.5, 1], [0.2, 1], [0.25, 2], [0.025, 3],
    [0.1, 1], [0.001, 3], [1e-9, 9], [0, 0], [NaN, 0], [undefined, 0]]) assert.equal(decimalsOf(step), decimals, `${step}`);
  for (let power = -8; power <= 6; power++) {
    for (const first of [1, 2, 2.5, 5]) {
      const step = first * 10 ** power;
      for (const times of [1, 3, 7]) {
        const text = formText(times * step, decimalsOf(step), PLAIN);
        assert.ok(Math.abs(Number(text.replaceAll(",", "")) / (times * step) - 1) < 1e-9, `${times} × ${step}: ${text}`);
      }
    }
  }
});

test("an error has two digits, and its value as many decimals", () => {
  assert.equal(estimateText(51.234, 0.8412), "51.23 ± 0.84");
  assert.equal(estimateText(51.234, 0.0996), "51.23 ± 0.10");
  assert.equal(estimateText(51234, 841), "51230 ± 840");
});

test("no digit is written that a number does not have", () => {
  for (const [value, decimals, text] of [[20, 17, "20"], [20.5, 17, "20.5"], [-0.3, 18, "-0.3"], [0.1 + 0.2, 17, "0.3"], [0, 18, "0"],
    [1234567.25, 12, "1,234,567.25"], [20, 3, "20.000"], [100, 14, "100"], [0.5, 2, "0.50"]]) {
    assert.equal(formText(value, decimals, PLAIN), text, `${value} to ${decimals}`);
  }
  assert.equal(formText(0.2, 17, { factor: 100, before: "", after: " %" }), "20 %");
});

test("a share of all or none of the trials has no error", () => {
  assert.equal(percentText({ value: 1, error: 0.001 }), "100");
  assert.equal(percentText({ value: 0, error: 0.001 }), "0");
  assert.equal(percentText({ value: 0.5, error: 0.001 }), "50.00 ± 0.10");
});

test("numbers are written, and read again, with the signs of the run", () => {
  for (const [thousands, decimal, count, value, estimate, read] of [
    [".", ",", "3.542", "1.234,5", "51,23 ± 0,84", [["1.234", 1234], ["1,234", 1.234], ["0.7", 0.7]]],
    ["\u00a0", ",", "3\u00a0542", "1\u00a0234,5", "51,23 ± 0,84", [["1\u00a0234", 1234], ["1,234", 1.234]]],
    ["'", ".", "3'542", "1'234.5", "51.23 ± 0.84", [["1'234", 1234], ["1.234", 1.234]]],
    ["", ".", "3542", "1234.5", "51.23 ± 0.84", [["1.234", 1.234]]],
    [",", ".", "3,542", "1,234.5", "51.23 ± 0.84", [["1,234", 1234], ["1.234", 1.234]]],
  ]) {
    Object.assign(SIGNS, { thousands, decimal });
    assert.equal(countText(3542), count);
    assert.equal(formText(1234.5, 1, PLAIN), value);
    assert.equal(estimateText(51.234, 0.8412), estimate);
    for (const [text, number] of [...read, [value, 1234.5], [count, 3542]]) assert.equal(plainNumber(text), number, text);
  }
});

test("a number is read as people write it, or refused", () => {
  for (const [text, value] of [["6700", 6700], ["6,700", 6700], ["6 700,5", 6700.5], ["6.700,5", 6700.5], ["1.5e3", 1500], ["0,7", 0.7],
    [".5", 0.5], ["1,234.5", 1234.5], ["1.234.567", 1234567]]) assert.equal(plainNumber(text), value, text);
  for (const text of ["", "1,23,4", "1.2.3", "12e", "x"]) assert.ok(Number.isNaN(plainNumber(text)), text);
  assert.equal(typed("−3", null), -3);
  assert.equal(typed("51 %", null), 51);
  assert.equal(typed(" ", 7), 7);
  assert.equal(typed("1e999", null), null);
  assert.equal(typed("9".repeat(400), null), null);
  assert.match(whyNoNumber("9".repeat(400)), /characters/);
});

test("what is computed follows Excel's order", () => {
  for (const [text, value] of [["6600+100", 6700], ["2+3*4", 14], ["(2+3)*4", 20], ["-2^2", 4], ["2^-1", 0.5], ["50%*8", 4], ["8/4/2", 1]]) {
    assert.equal(computed(text), value, text);
  }
  for (const text of ["", "2+", "(2", "2 3", "A1", "1//2"]) assert.ok(Number.isNaN(computed(text)), text);
});

test("a slider's numbers have no power of ten", () => {
  for (const [value, text] of [[1e-9, "0.000000001"], [2.64382112080697e-9, "0.00000000264382112080697"], [1.5e21, "1500000000000000000000"],
    [-0.25, "-0.25"], [0, "0"], [1234567.5, "1234567.5"]]) assert.equal(decimalText(value), text);
});
