"use strict";
// Numbers as people read and type them.

/** 51.23, 0.84 -> "51.23 ± 0.84": the error to two digits, the value to the same decimal, as everywhere in xlmc. */
function estimateText(value, error) {
  const decimals = 1 - exponentOf(error);
  if (decimals >= 0) return `${value.toFixed(decimals)} ± ${error.toFixed(decimals)}`;
  const unit = 10 ** -decimals;
  return `${Math.round(value / unit) * unit} ± ${Math.round(error / unit) * unit}`;
}

/** The power of ten of a number rounded to two digits: 0.00996 -> -2. */
function exponentOf(number) {
  return Number(number.toExponential(1).split("e")[1]);
}

/** 3542 -> "3,542". */
function countText(count) {
  return Math.round(count).toString().replace(/\B(?=(\d{3})+$)/g, ",");
}

/** A number with some decimals, or with a power of ten where it is very large or small. */
function valueText(value, decimals) {
  if (value === Infinity) return "∞";
  if (value === -Infinity) return "−∞";
  if (decimals > 6 || Math.abs(value) >= 1e9) return String(Number(value.toPrecision(7)));
  return value.toFixed(Math.max(decimals, 0));
}

/** What was typed, as a number; null where it is none. Nothing, "-inf" and "∞" are the open end. */
function typed(text, open) {
  const plain = text.trim().replace("−", "-");
  if (plain === "") return open;
  if (/^-(∞|inf|infinity)$/i.test(plain)) return -Infinity;
  if (/^\+?(∞|inf|infinity)$/i.test(plain)) return Infinity;
  const value = Number(plain.replace(/%$/, ""));
  return Number.isFinite(value) ? value : null;
}
