// Numbers as people read and type them.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { runInThisContext } from "node:vm";

runInThisContext(readFileSync(new URL("../../../../xlmc/outputs/page/numbers.js", import.meta.url), "utf8"));
/* global computed, decimalsOf, estimateText, formText, plainNumber, typed, whyNoNumber */

const PLAIN = { factor: 1, before: "", after: "", thousands: ",", decimal: "." };

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
