"use strict";
// Numbers as people read and type them.

/** The signs of thousands and decimals, which the page or the window sets to those of its run. */
const SIGNS = { thousands: ",", decimal: "." };

/** "1234.5", as JavaScript writes it -> "1.234,5", or "1234,5" without groups, in the signs of the run. */
function styled(plain, grouped = true) {
  const [whole, part] = plain.split(".");
  const groups = grouped && !plain.includes("e") ? whole.replace(/\B(?=(\d{3})+$)/g, SIGNS.thousands) : whole;
  return part === undefined ? groups : `${groups}${SIGNS.decimal}${part}`;
}

/** 51.23, 0.84 -> "51.23 ± 0.84": the error to two digits, the value to the same decimal, as everywhere in xlmc. */
function estimateText(value, error) {
  const decimals = 1 - exponentOf(error);
  const unit = 10 ** -decimals;
  const rounded = (number) => styled(decimals >= 0 ? number.toFixed(decimals) : `${Math.round(number / unit) * unit}`, false);
  return `${rounded(value)} ± ${rounded(error)}`;
}

/** A share in percent with its error; all or none of the trials have none. */
function percentText({ value, error }) {
  return value === 0 || value === 1 ? String(100 * value) : estimateText(100 * value, 100 * error);
}

const MOST_DIGITS = 15; // of a double; what lies below is rounding

/** A number with so many decimals; where more were wanted than it can have, without the zeros at its end. */
function fixed(number, decimals, wanted) {
  const text = number.toFixed(decimals);
  return wanted > decimals && text.includes(".") ? text.replace(/\.?0+$/, "") : text;
}

/** The power of ten of a number rounded to two digits: 0.00996 -> -2. */
function exponentOf(number) {
  return Number(number.toExponential(1).split("e")[1]);
}

/** The decimals that write multiples of a step, which are 1, 2, 2.5 or 5 times a power of ten: 0.25 -> 2, 2.5 -> 1. */
function decimalsOf(step) {
  if (!(step > 0)) return 0;
  const first = Math.max(0, Math.ceil(-Math.log10(step) - 1e-9));
  const units = step * 10 ** first;
  return first + (Math.abs(units - Math.round(units)) > 1e-6 * units ? 1 : 0);
}

/** 3542 -> "3,542". */
function countText(count) {
  return styled(Math.round(count).toString());
}

/** 1, "trial" -> "1 trial"; 3542, "trial" -> "3,542 trials". */
function countedText(count, noun) {
  return `${countText(count)} ${noun}${count === 1 ? "" : "s"}`;
}

/** A number with some decimals, or with a power of ten where it is very large or small. */
function valueText(value, decimals) {
  if (value === Infinity) return "∞";
  if (value === -Infinity) return "−∞";
  if (decimals > 6 || Math.abs(value) >= 1e9) return shortText(value, 7);
  return styled(value.toFixed(Math.max(decimals, 0)), false);
}

/** A number with all of its digits and without a power of ten, which the attributes of a slider must not have. */
function decimalText(value) {
  return value.toLocaleString("en-US", { useGrouping: false, maximumSignificantDigits: 17 });
}

/** A number in so many digits at most, as it can be typed. */
function shortText(value, digits) {
  return styled(String(Number(value.toPrecision(digits))), false);
}

/**
 * A number in the form of its forecast: 31.9 %, $48,210, 2026-03-01. `form` has what it is multiplied by, what stands
 * before and after it, and of dates whether the `day` or the `time` is shown.
 */
function formText(value, decimals, form) {
  if (!Number.isFinite(value)) return valueText(value, decimals);
  if (form.moment) return momentText(value, form);
  const scaled = Math.abs(value * form.factor);
  const wanted = Math.max(0, decimals - Math.round(Math.log10(form.factor)));
  const most = scaled > 0 ? Math.max(0, Math.min(wanted, MOST_DIGITS - 1 - exponentOf(scaled))) : Math.min(wanted, MOST_DIGITS);
  const plain = scaled >= 1e15 || (scaled > 0 && scaled < 1e-4) ? String(Number(scaled.toPrecision(7))) : fixed(scaled, most, wanted);
  const text = styled(plain);
  return `${value < 0 && /[1-9]/.test(text) ? "-" : ""}${form.before}${text}${form.after}`;
}

const DAYS_OF_EXCEL = 2958466; // up to the end of the year 9999

/** A date as 2026-03-01, with or without its time; a span of time as 49:15; a number where Excel has no such date. */
function momentText(value, { moment, epoch }) {
  if (moment !== "span" && !(value >= 0 && value < DAYS_OF_EXCEL)) return shortText(value, 7);
  const seconds = Math.round(value * 86400);
  const two = (number) => String(number).padStart(2, "0");
  if (moment === "span") {
    const [hours, rest] = [Math.floor(Math.abs(seconds) / 3600), Math.abs(seconds) % 3600];
    return `${seconds < 0 ? "-" : ""}${hours}:${two(Math.floor(rest / 60))}${rest % 60 ? `:${two(rest % 60)}` : ""}`;
  }
  const at = new Date((seconds - epoch * 86400) * 1000).toISOString();
  return moment === "day" ? at.slice(0, 10) : at.slice(0, 16).replace("T", " ");
}

const CLOCK = /^(\d+):(\d\d)(?::(\d\d))?(?:\s*([ap])m)?$/i;
const MONTHS = ["jan", "feb", "mar", "apr", "may", "jun", "jul", "aug", "sep", "oct", "nov", "dec"];

/** 14:30, 49:15 or 2:30 PM as a share of a day; null for anything else. */
function clockTyped(text) {
  const [, hours, minutes, seconds, half] = text.trim().match(CLOCK) ?? [];
  if (hours === undefined || (half && !(hours >= 1 && hours <= 12))) return null;
  const at = half ? (hours % 12) + (half.toLowerCase() === "p" ? 12 : 0) : Number(hours);
  return (at + minutes / 60 + (seconds ?? 0) / 3600) / 24;
}

/** 2026-03-01, or 1 Mar 2026 and 01/03/2026 where the cell has its parts in the `order` dmy, as days since 1970. */
function dayTyped(text, order) {
  const parts = (text.match(/\d+|[a-z]+/gi) ?? []).filter((part) => !/^(?:mon|tue|wed|thu|fri|sat|sun)/i.test(part));
  if (parts.length !== 3) return null;
  const found = {};
  [...(/^\d{4}$/.test(parts[0]) ? "ymd" : order)].forEach((which, i) => { found[which] = parts[i]; });
  const named = MONTHS.indexOf(found.m.slice(0, 3).toLowerCase()) + 1;
  const [year, month, day] = [found.y, named || found.m, found.d].map(Number);
  const whole = found.y.length === 2 ? year + (year < 30 ? 2000 : 1900) : year; // as Excel reads two digits
  const at = new Date(Date.UTC(whole, month - 1, day));
  return at.getUTCMonth() === month - 1 && at.getUTCDate() === day ? at.getTime() / 86400000 : null;
}

/** A date, a time or both, as a serial number; null for anything else. */
function momentTyped(text, { epoch, order = "ymd" }) {
  const span = clockTyped(text);
  if (span !== null) return span;
  const [, date, time] = text.match(/^(.*?)(?:(?:T|\s+)(\d+:[\d:]+(?:\s*[ap]m)?))?$/i);
  const [day, clock] = [dayTyped(date, order), time ? clockTyped(time) : 0];
  return day === null || clock === null ? null : day + clock + epoch;
}

/** What was typed in the form of a forecast, as `typed` gives it: 32 % is 0.32, 2026-03-01 is a serial number. */
function formTyped(text, open, form) {
  let plain = text.trim();
  if (form.moment) return momentTyped(plain, form) ?? typed(plain, open);
  if (plain.startsWith("=")) return typed(plain, open);
  for (const affix of [form.before, form.after].map((each) => each.trim()).filter(Boolean)) plain = plain.replace(affix, "");
  if (form.factor === 1 && form.before + form.after && plain.endsWith("%")) return null;
  const value = typed(plain, open);
  if (value === null || !Number.isFinite(value)) return value;
  return Number((value / form.factor).toPrecision(15));
}

const MOST_TYPED = 200; // characters
const GROUPS = [
  /^[1-9]\d{0,2}(?:,\d{3})+(?:\.\d*)?$/, // 6,700 and 1,234.5
  /^\d{1,3}(?:[ \u00a0\u2009\u202f'\u2019]\d{3})+(?:[.,]\d*)?$/, // 6 700 and 6 700,5
  /^\d{1,3}(?:\.\d{3})+,\d*$/, // 6.700,5
  /^\d{1,3}(?:\.\d{3}){2,}$/, // 1.234.567
];
const DECIMAL = /^(?:\d+[.,]?\d*|[.,]\d+)$/; // a comma that separates no thousands is a decimal comma: 0,7

/**
 * A number without a sign as people write it: 6700, 6,700, 6 700, 1.5e3, 0,7; NaN where it is none. What the signs of
 * the run say comes first: 1.234 is a thousand and more in the style 1.234,5.
 */
function plainNumber(text) {
  const [, digits, power] = text.match(/^(.*?)(e[+-]?\d{1,4})?$/is);
  if (SIGNS.thousands === "." && /^\d{1,3}(?:\.\d{3})+$/.test(digits)) return Number(digits.replaceAll(".", "") + (power ?? ""));
  if (SIGNS.decimal === "," && /^\d+,\d+$/.test(digits)) return Number(digits.replace(",", ".") + (power ?? ""));
  const grouped = GROUPS.findIndex((groups) => groups.test(digits));
  if (grouped < 0) return DECIMAL.test(digits) ? Number(digits.replace(",", ".") + (power ?? "")) : NaN;
  const whole = digits.replace(grouped < 1 ? /,/g : grouped < 2 ? /[ \u00a0\u2009\u202f'\u2019]/g : /\./g, "");
  return Number(whole.replace(",", ".") + (power ?? ""));
}

/** 6600+100: numbers, + - * / ^, parentheses and percent, in Excel's order; NaN where it is something else. */
function computed(text) {
  const parts = text.match(/(?:\d[\d.,'\u2019]*|[.,]\d+)(?:e[+-]?\d+)?|\S/gi) ?? [];
  let at = 0;
  const take = (...signs) => (signs.includes(parts[at]) ? parts[at++] : null);
  const single = () => {
    if (take("-")) return -single();
    if (take("+")) return single();
    let value = NaN;
    if (take("(")) {
      value = sum();
      if (!take(")")) return NaN;
    } else if (at < parts.length) value = plainNumber(parts[at++]);
    while (take("%")) value /= 100;
    return value;
  };
  const row = (of, acts) => {
    let value = of();
    for (let sign = take(...Object.keys(acts)); sign; sign = take(...Object.keys(acts))) value = acts[sign](value, of());
    return value;
  };
  const power = () => row(single, { "^": (a, b) => a ** b });
  const product = () => row(power, { "*": (a, b) => a * b, "/": (a, b) => a / b });
  const sum = () => row(product, { "+": (a, b) => a + b, "-": (a, b) => a - b });
  const value = sum();
  return at === parts.length ? value : NaN;
}

/** What was typed, as a number; null where it is none. Nothing, "-inf" and "∞" are the open end. */
function typed(text, open) {
  const plain = text.trim().replaceAll("−", "-");
  if (plain === "") return open;
  if (/^-(∞|inf|infinity)$/i.test(plain)) return -Infinity;
  if (/^\+?(∞|inf|infinity)$/i.test(plain)) return Infinity;
  if (plain.length > MOST_TYPED) return null;
  const [, sign, number] = plain.replace(/\s*%$/, "").match(/^([+-]?)\s*(.*)$/s);
  const value = plain.startsWith("=") ? computed(plain.slice(1)) : plainNumber(number) * (sign === "-" ? -1 : 1);
  return Number.isFinite(value) ? value : null;
}

/** Why a text is refused where a number is wanted. */
function whyNoNumber(text) {
  const plain = text.trim();
  if (!plain) return "Type a number.";
  if (plain.length > MOST_TYPED) return `Type at most ${MOST_TYPED} characters.`;
  if (/^[=+−-]?[\d.,e+\s]+$/i.test(plain) && /\d{300}|e\+?\d{3,}/i.test(plain)) return "This number is too large.";
  if (/^[+−-]?(∞|inf|infinity)$/i.test(plain)) return "This must be a finite number.";
  if (plain.startsWith("=")) return "This cannot be computed: type numbers with + - * / ^ and parentheses, as =6600+100.";
  if (/^[+−-]?[\d.,\s]+$/.test(plain)) return "This may be read in several ways: type it as 6700 or 0.7.";
  return "This is no number: type 6700, 6,700, 1.5e3 or =6600+100.";
}
