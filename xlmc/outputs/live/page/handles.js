"use strict";
// Handles on an axis: the numbers of one assumption or filter, which are dragged or moved with the arrow keys.

const RISING = [["low", "low_likeliest", "likeliest", "high_likeliest", "high"], ["lower_cutoff", "upper_cutoff"],
  ["at_least", "above", "at_most", "below"]];
const KNOB_SIDE = { low: "lower", lower_cutoff: "lower", at_least: "lower", above: "lower",
  high: "upper", upper_cutoff: "upper", at_most: "upper", below: "upper" };
const WIDE = 100, TALL = 26;

/** A number with the decimals of its step, and no more than it has; dates, percentages and money in their form. */
function stepText(value, step, form = null) {
  if (value === null || value === undefined) return "";
  if (form?.moment) return momentText(value, form);
  const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  if (form) {
    const known = decimalText(Number((value * form.factor).toPrecision(12))).split(".")[1]?.length ?? 0;
    return formText(value, Math.max(decimals, known + Math.round(Math.log10(form.factor))), form);
  }
  const rounded = Number(value.toFixed(Math.min(decimals, 12)));
  return Math.abs(rounded - value) <= 1e-9 * Math.abs(value) ? valueText(value, decimals) : shortText(value, 12);
}

/** A value on the grid of its step. */
function onStep(value, step) {
  return Number((Math.round(value / step) * step).toPrecision(12));
}

/**
 * The axis with its knobs. `moved(key, value, held, event)` is told of each move; `numbers` are those with a handle:
 * `key`, `heading`, `value`, `own`.
 */
class Track {
  constructor(about, units, moved) {
    this.about = about;
    this.units = units;
    this.moved = moved;
    this.held = null;
    this.knobs = new Map();
    this.numbers = [];
    this.ticks = [];
    this.step = 1;
    this.shape = this.own = this.mark = this.form = null;
    this.off = false;
    this.drawing = makeSvg("svg", { viewBox: `0 0 ${WIDE} ${TALL}`, preserveAspectRatio: "none", "aria-hidden": "true" });
    this.root = make("div", { class: "track" }, this.drawing);
    this.ends = make("p", { class: "ends", "aria-hidden": "true" }, make("span"), make("span"));
    this.box = make("div", { class: "axis" }, this.root, this.ends);
  }

  /**
   * Bring it up to date: the numbers, the step, the distribution now and in the workbook, a value to be marked, values
   * with a tick each, and the form of dates and times.
   */
  update({ numbers, step, shape, own, mark, off, ticks = [], form = null }) {
    Object.assign(this, { numbers, step, shape, own, mark, off, ticks, form });
    this.ends.classList.toggle("dated", Boolean(form?.moment));
    if (this.held === null) this.fit();
    for (const number of numbers) this.place(this.knob(number), number);
    for (const [key, knob] of this.knobs) {
      if (!numbers.some((each) => each.key === key)) {
        knob.remove();
        this.knobs.delete(key);
      }
    }
    this.draw();
  }

  /** Choose an axis with room on both sides; one that is still good stays, so that nothing jumps. */
  fit() {
    const values = this.numbers.flatMap(({ value, own }) => [value, own]).filter((each) => each !== null);
    for (const each of [this.shape, this.own]) if (each) values.push(each.low, each.high);
    if (this.mark !== null && this.mark !== undefined) values.push(this.mark);
    values.push(...this.ticks);
    if (!values.length) values.push(0, 1);
    const [low, high] = [Math.min(...values), Math.max(...values)];
    const span = high - low || Math.abs(low) * 0.2 || 1;
    const [from, to] = this.axis ?? [0, 0];
    const good = from < low - 0.08 * span && to > high + 0.08 * span && to - from < 4 * span;
    if (!good) this.axis = [low - 0.3 * span, high + 0.3 * span];
    const [first, last] = this.axis;
    const decimals = Math.min(12, decimalsOf(10 ** Math.floor(Math.log10(last - first) - 1))); // the ends differ as they are shown
    const shown = this.axis.map((end) => this.form ? formText(end, decimals, this.form) : styled(`${Number(end.toFixed(decimals))}`, false));
    [...this.ends.children].forEach((place, i) => { place.textContent = shown[i]; });
  }

  at(value) {
    const [from, to] = this.axis;
    return Math.min(100, Math.max(0, (100 * (value - from)) / (to - from)));
  }

  knob(number) {
    if (this.knobs.has(number.key)) return this.knobs.get(number.key);
    const made = make("div", { class: `knob ${KNOB_SIDE[number.key] ?? "middle"}`, role: "slider", tabindex: "0",
      "aria-label": `${number.heading} of ${this.about}` });
    made.addEventListener("pointerdown", (event) => this.grab(made, number.key, event));
    made.addEventListener("keydown", (event) => this.press(number.key, event));
    made.addEventListener("keyup", (event) => {
      if (ARROWS[event.key]) this.moved(number.key, this.number(number.key).value, false, event);
    });
    this.knobs.set(number.key, made);
    this.root.append(made);
    return made;
  }

  number(key) {
    return this.numbers.find((each) => each.key === key);
  }

  place(knob, { value }) {
    knob.hidden = value === null;
    if (value === null) return;
    const [least, most] = this.axis;
    knob.style.left = `${this.at(value)}%`;
    knob.setAttribute("aria-valuemin", decimalText(Math.min(least, value)));
    knob.setAttribute("aria-valuemax", decimalText(Math.max(most, value)));
    knob.setAttribute("aria-valuenow", decimalText(value));
    knob.setAttribute("aria-valuetext", `${stepText(value, this.step, this.form)}${this.units ? ` ${this.units}` : ""}`);
    knob.setAttribute("aria-disabled", String(Boolean(this.off)));
  }

  /** The nearest place where a handle may be: those that rise stay in their order. */
  allowed(key, value) {
    const order = RISING.find((keys) => keys.includes(key));
    if (!order) return value;
    const place = order.indexOf(key);
    let found = value;
    for (const other of this.numbers) {
      const where = order.indexOf(other.key);
      if (where < 0 || other.value === null) continue;
      if (where < place) found = Math.max(found, other.value);
      if (where > place) found = Math.min(found, other.value);
    }
    return found;
  }

  grab(knob, key, event) {
    if (this.off || event.button) return;
    const box = this.root.getBoundingClientRect();
    const away = event.clientX - (box.left + (box.width * this.at(this.number(key).value)) / 100);
    const [from, to] = this.axis;
    const follow = (moved) => {
      const part = Math.min(1, Math.max(0, (moved.clientX - away - box.left) / box.width));
      this.move(key, from + part * (to - from), true, moved);
    };
    const before = this.number(key).value;
    const letGo = (moved) => {
      knob.removeEventListener("pointermove", follow);
      knob.removeEventListener("keydown", giveUp);
      for (const each of ["pointerup", "pointercancel"]) knob.removeEventListener(each, letGo);
      this.held = null;
      this.moved(key, this.number(key).value, false, moved);
    };
    const giveUp = (pressed) => {
      if (pressed.key !== "Escape") return;
      pressed.preventDefault();
      this.number(key).value = before;
      this.show();
      if (knob.hasPointerCapture(event.pointerId)) knob.releasePointerCapture(event.pointerId);
      letGo(pressed);
    };
    event.preventDefault();
    knob.focus({ preventScroll: true });
    knob.setPointerCapture(event.pointerId);
    this.held = key;
    knob.addEventListener("pointermove", follow);
    knob.addEventListener("keydown", giveUp);
    for (const each of ["pointerup", "pointercancel"]) knob.addEventListener(each, letGo);
  }

  press(key, event) {
    const steps = (ARROWS[event.key] ?? 0) * (event.shiftKey ? 10 : 1);
    const [from, to] = this.axis;
    const ends = { Home: from, End: to };
    if (this.off || (!steps && !(event.key in ends))) return;
    const wanted = steps ? this.number(key).value + steps * this.step : ends[event.key];
    event.preventDefault();
    this.move(key, wanted, Boolean(steps), event);
    this.fit();
    this.show();
  }

  move(key, wanted, held, event) {
    const number = this.number(key);
    const value = this.allowed(key, onStep(wanted, this.step));
    if (value === number.value) return;
    number.value = value;
    this.place(this.knob(number), number);
    this.draw();
    this.moved(key, value, held, event);
  }

  show() {
    for (const number of this.numbers) this.place(this.knob(number), number);
    this.draw();
  }

  /** The distribution of the workbook as a line, the one now as an area, the value of the cell as an upright line. */
  draw() {
    const parts = [makeSvg("path", { class: "ground", d: `M0 ${TALL}H${WIDE}` })];
    if (this.shape) parts.push(makeSvg("path", { class: "now", d: this.outline(this.shape) }));
    if (this.own && this.own !== this.shape) parts.push(makeSvg("path", { class: "own", d: this.outline(this.own) }));
    const ticks = this.ticks.map((each) => `M${this.at(each)} ${TALL}V${TALL - 8}`).join("");
    if (ticks) parts.push(makeSvg("path", { class: "ticks", d: ticks }));
    if (this.mark !== null && this.mark !== undefined) {
      parts.push(makeSvg("path", { class: "mark", d: `M${this.at(this.mark)} 0V${TALL}` }));
    }
    this.drawing.replaceChildren(...parts);
  }

  outline({ low, high, heights }) {
    if (!(high > low)) return `M${this.at(low)} ${TALL}V1`;
    const top = (height) => (TALL - (TALL - 2) * height).toFixed(2);
    const end = (i) => this.at(low + ((high - low) * i) / heights.length).toFixed(2);
    const bars = heights.map((height, i) => `V${top(height)}H${end(i + 1)}`).join("");
    return `M${end(0)} ${TALL}${bars}V${TALL}Z`;
  }
}

const BETWEEN = /^(.+?)\s*(?:\b(?:to|bis)\b|\.\.\.?|…|–)\s*(.+)$/i;
const AROUND = /^(.+?)\s*(?:±|\+\/?-)\s*(.+)$/;

/**
 * Two ends in one box, 0.6 to 0.8 or 0.7 ± 10 %: `low`, `high` and with ± `middle`; null where it is no range. `read`
 * gives the number that a text is; null for none. Of percentages ± 1 % is one of them, not a part of the middle.
 */
function typedRange(text, read = (part) => typed(part, null), percentages = false) {
  const plain = text.trim();
  const [, first, second] = (plain.startsWith("=") ? null : plain.match(AROUND) ?? plain.match(BETWEEN)) ?? [];
  if (first === undefined) return null;
  const share = AROUND.test(plain) && second.endsWith("%") && !percentages;
  const [a, b] = [read(first), share ? typed(second, null) : read(second)];
  if (a === null || b === null) return null;
  if (!AROUND.test(plain)) return { low: Math.min(a, b), high: Math.max(a, b), middle: null };
  const off = Math.abs(share ? (a * b) / 100 : b);
  return { low: Number((a - off).toPrecision(12)), high: Number((a + off).toPrecision(12)), middle: a, share };
}

const WHICH_MOMENT = { day: "Type a date, as 2026-03-01.", time: "Type a date and a time, as 2026-03-01 14:30.",
  span: "Type hours and minutes, as 49:15." };

const NONE = "none"; // what is said for a limit that is taken away

/**
 * A box for one number: typed, or stepped with the arrow keys. `set(value, held)` takes it; `setRange(range)` takes two
 * ends that were typed into it; both give why it cannot be taken. A number that `goes` is taken away by a blank box.
 */
class NumberBox {
  constructor(label, units, set, { hidden = "", percent = units === "%", setRange = null, goes = false } = {}) {
    this.set = set;
    this.setRange = setRange;
    this.percent = percent;
    this.goes = goes;
    this.step = 1;
    this.value = this.form = null;
    this.why = make("span", { class: "why", role: "alert", id: Numbered.id("why") });
    this.input = make("input", { type: "text", inputmode: "text", autocomplete: "off", spellcheck: "false",
      "aria-describedby": this.why.id });
    const shown = make("span", { text: label });
    if (hidden) shown.append(make("span", { class: "aside", text: ` of ${hidden}` }));
    this.root = make("span", { class: "number-box" },
      make("label", {}, shown, this.input, make("span", { class: "unit", text: units })), this.why);
    this.hint = [setRange ? "Both ends at once: 0.6 to 0.8, or 0.7 ± 10 %" : "", goes ? "Blank: none" : ""].filter(Boolean).join("; ");
    if (goes) this.input.placeholder = NONE;
    this.input.addEventListener("change", () => this.type());
    this.input.addEventListener("keydown", (event) => this.press(event));
  }

  update(value, step, { off = false, why = "", form = this.form } = {}) {
    Object.assign(this, { value, step, form });
    if (document.activeElement !== this.input || this.input.value === this.shown) {
      this.show(why || stepText(value, step, form));
      this.refuse("");
    }
    this.input.disabled = off;
    this.input.title = why ? `Computed: ${why}; type a number to replace it` : this.hint;
    this.input.classList.toggle("computed", Boolean(why));
    this.input.classList.toggle("dated", Boolean(form?.moment));
  }

  /** Put a text into the box, which has room for all of it: $500,000 must not be the begin of $500,000,000. */
  show(text) {
    this.shown = this.input.dataset.shown = this.input.value = text;
    this.input.style.minWidth = text.length > 7 ? `min(${text.length + 2}ch, 15rem)` : "";
  }

  /** Say why what was typed is not taken; nothing where it is. */
  refuse(why) {
    this.why.textContent = why;
    if (why) this.input.setAttribute("aria-invalid", "true");
    else this.input.removeAttribute("aria-invalid");
  }

  type() {
    const text = this.input.value;
    if (this.goes && !text.trim()) {
      this.refuse("");
      this.show("");
      this.set(NONE, false);
      return;
    }
    const { form } = this;
    const read = (part) => (form ? formTyped(part, null, form) : typed(part, null));
    const range = typedRange(text, read, form?.factor === 100);
    if (range) {
      this.refuse(this.setRange ? this.setRange(range) : "Type one number here.");
      return;
    }
    const value = read(text);
    if (value === null || !Number.isFinite(value)) {
      this.refuse(form?.moment ? WHICH_MOMENT[form.moment] : whyNoNumber(text));
      return;
    }
    const share = !form && text.trim().endsWith("%") && !text.trim().startsWith("=") && !this.percent;
    this.take(share ? Number((value / 100).toPrecision(15)) : value);
  }

  press(event) {
    const direction = { ArrowUp: 1, ArrowDown: -1, PageUp: 10, PageDown: -10 }[event.key];
    if (!direction || this.value === null) return;
    event.preventDefault();
    this.take(onStep(this.value + direction * (event.shiftKey ? 10 : 1) * this.step, this.step));
  }

  take(value) {
    this.value = value;
    this.refuse("");
    this.show(stepText(value, this.step, this.form));
    this.refuse(this.set(value, false) ?? "");
  }
}
