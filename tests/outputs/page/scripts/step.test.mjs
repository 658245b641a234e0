// The trial that a person steps to.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { runInThisContext } from "node:vm";

for (const script of ["page/numbers.js", "live/page/further_tabs.js"]) {
  runInThisContext(readFileSync(new URL(`../../../../xlmc/outputs/${script}`, import.meta.url), "utf8"));
}
/* global steppedTo */

test("a trial is counted from 1 where it is typed, and is one of those there are", () => {
  for (const [text, trial] of [["1", 0], ["17", 16], ["1,000", 999], ["1e3", 999], ["5000", 4095], ["0", null], ["-3", null], ["2.5", null],
    ["", null], ["first", null]]) assert.equal(steppedTo(text, 4096), trial, text);
});
