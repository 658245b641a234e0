"use strict";
// The left side: a card for each row of the workbook's tables, the list of checks, and trials and seed.

/** Set several numbers of one assumption or filter at once; gives the number of the change, as `Wire.set`. */
function setAll(wire, of, name, values) {
  wire.seq += 1;
  wire.say({ kind: "numbers", of, name, values, seq: wire.seq });
  return wire.seq;
}

const ENDS = ["low", "high", "likeliest"]; // boxes that take a range

const PICTURES = { // heights of a kind's curve, from its lower end to its upper one
  Uniform: "M2 20V6H30V20", Triangular: "M2 20L16 4L30 20", BetaPERT: "M2 20C10 20 11 4 16 4S22 20 30 20",
  Normal: "M1 20C11 20 10 4 16 4S21 20 31 20", Lognormal: "M2 20C6 20 5 4 9 4S14 19 31 20" };

/** The kinds of distribution that an assumption can have, each with a picture; `choose(kind)`: null for its own. */
class KindMenu {
  constructor({ name }, choose) {
    this.name = name;
    this.choose = choose;
    this.kinds = "";
    this.named = make("span");
    this.gallery = make("div", { class: "gallery" });
    this.root = make("details", { class: "kinds" },
      make("summary", {}, this.named, make("span", { class: "aside", text: `: kind of ${name}` })), this.gallery);
  }

  update({ kind, kinds, frozen }) {
    if (this.kinds !== kinds.join()) this.gallery.replaceChildren(...kinds.map((each, i) => this.button(each, i ? each : null)));
    this.kinds = kinds.join();
    this.root.hidden = !kinds.length;
    this.named.textContent = kind;
    kinds.forEach((each, i) => {
      const button = this.gallery.children[i];
      button.setAttribute("aria-pressed", String(each === kind));
      button.disabled = frozen;
    });
  }

  button(kind, chosen) {
    const picture = makeSvg("svg", { viewBox: "0 0 32 22", "aria-hidden": "true" });
    picture.append(makeSvg("path", { d: PICTURES[kind] ?? "M2 20H30" }));
    return make("button", { type: "button", "aria-label": `${kind}, as the kind of ${this.name}`,
      on: { click: () => this.choose(chosen) } }, picture, make("span", { text: kind }));
  }
}

class AssumptionCard {
  constructor(row, wire, sent) {
    this.row = row;
    this.wire = wire;
    this.sent = sent;
    this.boxes = new Map();
    this.shape = this.own = null;
    this.track = new Track(row.name, row.units, (key, value, held, event) => this.set(key, value, held, event));
    this.numbers = make("div", { class: "numbers" });
    this.kinds = new KindMenu(row, (kind) => this.sent(wire.set("assumption", row.name, "kind", kind, false), null));
    const end = (label, key) => new NumberBox(label, "%", (value) => this.set(key, value, false, null),
      { hidden: `the band of ${row.name}` });
    this.band = { band_low: end("Band from", "band_low"), band_high: end("to", "band_high") };
    this.bands = make("details", { class: "band" },
      make("summary", {}, "Band", make("span", { class: "aside", text: ` of ${row.name}` })),
      ...Object.values(this.band).map((box) => box.root));
    this.frozen = make("input", { type: "checkbox", role: "switch" });
    this.frozen.addEventListener("change", (event) => this.set("frozen", this.frozen.checked, false, event));
    this.base = new NumberBox("at", "", (value) => this.set("base", value, false, null),
      { hidden: row.name, percent: row.units === "%" });
    this.back = make("button", { type: "button", class: "back", text: "As in the workbook",
      "aria-label": `${row.name} as in the workbook`,
      on: { click: () => wire.say({ kind: "reset", of: "assumption", name: row.name }) } });
    this.status = make("span", { class: "status" });
    this.about = make("p", { class: "about" });
    this.root = make("article", { class: "card", "aria-label": row.name },
      make("h3", {}, named(row.name), make("span", { class: "units", text: row.units ? `, ${row.units}` : "" }),
        this.status, this.back),
      this.track.box, this.kinds.root, this.numbers, this.about);
    this.held = make("div", { class: "frozen" }, make("label", {}, this.frozen, " Frozen ",
      make("span", { class: "aside", text: `: ${row.name}` })), this.base.root);
    this.numbers.append(this.held, this.bands);
  }

  set(key, value, held, event) {
    const number = this.row.numbers.find((each) => each.key === key);
    if (number) {
      number.value = value === NONE ? null : value;
      this.boxes.get(key)?.update(number.value, this.stepOf(number));
    }
    this.sent(this.wire.set("assumption", this.row.name, key, value, held), event);
  }

  /** Both ends at once; with ± the likeliest value is the middle. */
  setRange({ low, high, middle, share }) {
    const { name, units, numbers } = this.row;
    const keys = numbers.map(({ key }) => key);
    if (!keys.includes("low") || !keys.includes("high")) return "This distribution has no two ends: type its numbers one by one.";
    if (share && units === "%") return "± of a quantity in % may be read in two ways: type its two ends.";
    const values = middle !== null && keys.includes("likeliest") ? { low, high, likeliest: middle } : { low, high };
    this.sent(setAll(this.wire, "assumption", name, values), null);
    return "";
  }

  stepOf(number) {
    return number.drags ? this.row.step : number.step;
  }

  /** Another window moved a handle, or this one did. */
  moved(key, value) {
    if (this.track.held !== null) return;
    const number = this.row.numbers.find((each) => each.key === key);
    if (!number) return;
    number.value = value;
    this.update(this.row, this.shape, this.own);
  }

  reshape(shape) {
    this.shape = shape;
    this.track.shape = shape;
    this.track.draw();
  }

  update(row, shape, own) {
    if (this.track.held !== null) return;
    Object.assign(this, { row, shape, own });
    const off = row.frozen || row.status === "not needed";
    this.track.update({
      numbers: row.numbers.filter((each) => each.drags), step: row.step, shape: off ? null : shape, own,
      mark: row.base, off: row.frozen, form: row.form,
    });
    this.kinds.update(row);
    for (const [key, box] of this.boxes) {
      if (row.numbers.some((number) => number.key === key)) continue;
      box.root.remove();
      this.boxes.delete(key);
    }
    for (const number of row.numbers) {
      if (!this.boxes.has(number.key)) {
        const box = new NumberBox(number.heading, "", (value) => this.set(number.key, value, false, null),
          { hidden: row.name, percent: row.units === "%", goes: number.goes, setRange: ENDS.includes(number.key) ? (range) => this.setRange(range) : null });
        this.boxes.set(number.key, box);
        this.held.before(box.root);
      }
      const why = number.cell; // 12 (Inputs!J8: =eta)
      this.boxes.get(number.key).update(number.value, this.stepOf(number), { off: row.frozen, why, form: number.form });
    }
    this.bands.hidden = row.band === null;
    if (row.band?.some((end, i) => end !== 100 * i)) this.bands.open = true;
    Object.values(this.band).forEach((box, i) => box.update(row.band?.[i] ?? null, 1, { off: row.frozen }));
    this.frozen.checked = row.frozen;
    this.base.update(row.base, row.step, { off: !row.frozen, form: row.form });
    this.root.classList.toggle("changed", row.changed);
    this.back.hidden = !row.changed;
    this.status.textContent = row.status === "not needed" ? " not needed by any answer" : "";
    this.about.textContent = [row.distribution, row.cell, row.source].filter(Boolean).join(" · ");
  }
}

class FilterCard {
  constructor(row, wire, sent) {
    this.row = row;
    this.wire = wire;
    this.sent = sent;
    this.boxes = new Map();
    this.track = new Track(row.name, "", (key, value, held, event) => this.set(key, value, held, event));
    this.numbers = make("div", { class: "numbers" });
    this.rejected = make("p", { class: "rejected" });
    this.back = make("button", { type: "button", class: "back", text: "As in the workbook",
      "aria-label": `${row.name} (filter) as in the workbook`,
      on: { click: () => wire.say({ kind: "reset", of: "filter", name: row.name }) } });
    this.about = make("p", { class: "about" });
    this.used = make("input", { type: "checkbox", role: "switch" });
    this.used.addEventListener("change", (event) => this.sent(this.wire.set("filter", this.row.name, "used", this.used.checked, false), event));
    this.switch = make("label", { class: "switch" }, this.used, " Use", make("span", { class: "aside", text: ` ${row.name}` }));
    this.root = make("article", { class: "card", "aria-label": `Filter ${row.name}` },
      make("h3", {}, named(row.name), this.back), this.rejected, this.track.box, this.numbers, this.about);
    this.numbers.append(this.switch);
  }

  set(key, value, held, event) {
    const limit = this.row.limits.find((each) => each.key === key);
    limit.value = value === NONE ? null : value;
    this.boxes.get(key)?.update(limit.value, this.stepOf(limit));
    this.sent(this.wire.set("filter", this.row.name, key, value, held), event);
  }

  stepOf(limit) {
    return limit.drags ? this.row.step : limit.step;
  }

  /** Both limits at once, or a reading with its error. */
  setRange({ low, high, middle, share }) {
    const given = this.row.limits.map(({ key }) => key);
    if (given.includes("reading")) return this.setReading(given, low, high, middle, share);
    const [lower, upper] = [["at_least", "above"], ["at_most", "below"]].map((keys) => keys.find((key) => given.includes(key)));
    if (!lower || !upper) return "This filter has one limit: type one number.";
    this.sent(setAll(this.wire, "filter", this.row.name, { [lower]: low, [upper]: high }), null);
    return "";
  }

  /** 30 ± 2 and 28 to 32 are a reading of 30, plus or minus 2; 30 ± 5 % is one with an error in percent. */
  setReading(given, low, high, middle, share) {
    const reading = middle ?? Number(((low + high) / 2).toPrecision(12));
    const off = Number((Math.abs(high - low) / 2).toPrecision(12));
    const percent = share && given.includes("percent");
    if (!percent && !given.includes("plus_minus")) return "This error is given in another way: type its numbers one by one.";
    const error = percent ? { percent: Number(((100 * off) / Math.abs(reading)).toPrecision(12)) } : { plus_minus: off };
    this.sent(setAll(this.wire, "filter", this.row.name, { reading, ...error }), null);
    return "";
  }

  moved(key, value) {
    if (this.track.held !== null) return;
    const limit = this.row.limits.find((each) => each.key === key);
    if (!limit) return;
    limit.value = value;
    this.update(this.row);
  }

  update(row) {
    if (this.track.held !== null) return;
    this.row = row;
    const numbers = row.limits.filter((each) => each.drags && each.value !== null);
    this.track.box.hidden = !numbers.length;
    this.track.update({ numbers, step: row.step, shape: row.shape ?? null, own: null, mark: null, off: !row.used, form: row.form });
    this.switch.hidden = !row.switches;
    this.used.checked = row.used;
    this.root.classList.toggle("off", !row.used);
    this.rejected.hidden = !row.used;
    for (const limit of row.limits) {
      if (!this.boxes.has(limit.key)) {
        const heading = limit.heading[0].toUpperCase() + limit.heading.slice(1);
        const box = new NumberBox(heading, "", (value) => this.set(limit.key, value, false, null),
          { hidden: row.name, goes: limit.goes, setRange: limit.drags ? (range) => this.setRange(range) : null });
        this.boxes.set(limit.key, box);
        this.numbers.append(box.root);
      }
      const why = limit.cell;
      this.boxes.get(limit.key).update(limit.value, this.stepOf(limit), { off: !row.used, why, form: limit.form });
    }
    this.root.classList.toggle("changed", row.changed);
    this.back.hidden = !row.changed;
    this.about.textContent = [row.used ? row.says : "not used", row.cell, row.because].filter(Boolean).join(" · ");
  }

  count(rejected, trials) {
    const [all, only] = rejected;
    const share = trials ? ` (${styled(((100 * all) / trials).toPrecision(3))} %)` : "";
    this.rejected.textContent = `rejects ${countText(all)} of ${countedText(trials, "trial")}${share}, ${countText(only)} of them alone`;
  }
}

const MANY_CARDS = 8; // with more assumptions they can be looked for

/** The rank correlation of two assumptions. */
class CorrelationCard {
  constructor(row, wire, sent) {
    this.row = row;
    this.wire = wire;
    this.box = new NumberBox("Rank correlation", "", (value) => {
      if (value < -1 || value > 1) return "Type a number from -1 to 1.";
      sent(wire.set("correlation", row.name, "correlation", value, false), null);
      return "";
    }, { hidden: row.name });
    this.back = make("button", { type: "button", class: "back", text: "As in the workbook", "aria-label": `${row.name} as in the workbook`,
      on: { click: () => wire.say({ kind: "reset", of: "correlation", name: row.name }) } });
    this.root = make("article", { class: "card", "aria-label": row.name }, make("h3", {}, named(row.name), this.back),
      make("div", { class: "numbers" }, this.box.root));
  }

  update(row) {
    this.row = row;
    this.box.update(row.value, 0.01);
    this.root.classList.toggle("changed", row.changed);
    this.back.hidden = !row.changed;
  }

  moved(_, value) {
    this.box.update(value, 0.01);
  }
}

/** A row whose numbers are typed into cells: a decision, or a cell that is solved for. */
class TypedCard {
  constructor(of, row, wire, sent) {
    this.of = of;
    this.row = row;
    this.wire = wire;
    this.sent = sent;
    this.boxes = new Map();
    this.numbers = make("div", { class: "numbers" });
    this.about = make("p", { class: "about" });
    this.back = make("button", { type: "button", class: "back", text: "As in the workbook", "aria-label": `${row.name} as in the workbook`,
      on: { click: () => wire.say({ kind: "reset", of, name: row.name }) } });
    this.head = make("h3", {}, named(row.name), make("span", { class: "units", text: row.units ? `, ${row.units}` : "" }), this.back);
    this.root = make("article", { class: "card", "aria-label": row.name }, this.head, this.numbers, this.about);
  }

  set(key, value, held, event) {
    const number = this.row.numbers.find((each) => each.key === key);
    number.value = value;
    this.boxes.get(key).update(value, this.row.step ?? number.step);
    this.sent(this.wire.set(this.of, this.row.name, key, value, held), event);
  }

  /** Another window moved a handle, or this one did. */
  moved(key, value) {
    const number = this.row.numbers.find((each) => each.key === key);
    if (!number) return;
    number.value = value;
    this.update(this.row);
  }

  update(row) {
    this.row = row;
    for (const number of row.numbers) {
      if (!this.boxes.has(number.key)) {
        const box = new NumberBox(number.heading, row.units ?? "", (value) => this.set(number.key, value, false, null),
          { hidden: row.name, percent: row.units === "%" });
        this.boxes.set(number.key, box);
        this.numbers.append(box.root);
      }
      this.boxes.get(number.key).update(number.value, row.step ?? number.step, { off: Boolean(number.cell), why: number.cell, form: number.form });
    }
    this.root.classList.toggle("changed", row.changed);
    this.back.hidden = !row.changed;
    this.about.textContent = [row.says, row.cell].join(" · ");
  }
}

/** A decision: what stands in its cell, on an axis with the values that studies try; of texts, a menu. */
class DecisionCard extends TypedCard {
  constructor(row, wire, sent) {
    super("decision", row, wire, sent);
    this.track = new Track(row.name, row.units, (key, value, held, event) => this.set(key, value, held, event));
    this.head.after(this.track.box);
    this.menu = make("select", { "aria-label": `Value of ${row.name}`, on: { change: (event) => {
      this.sent(wire.set("decision", row.name, "value", Number(this.menu.value), false), event);
    } } });
    this.numbers.append(this.menu);
  }

  moved(key, value) {
    if (this.track.held === null) super.moved(key, value);
  }

  update(row) {
    if (this.track.held !== null) return;
    super.update(row);
    const isText = row.choices.length > 0;
    this.track.box.hidden = this.boxes.get("value").root.hidden = isText;
    this.menu.hidden = !isText;
    if (isText) {
      const { value: place } = row.numbers[0];
      this.menu.replaceChildren(...(place === null ? [new Option("another", "")] : []), ...row.choices.map((text, i) => new Option(text, String(i))));
      this.menu.value = place === null ? "" : String(place);
      return;
    }
    const ticks = row.tried.length ? row.tried : row.ends;
    const [{ value, own }] = row.numbers;
    this.track.update({ numbers: row.numbers, step: row.step, shape: null, own: null, mark: value === own ? null : own, off: false, ticks,
      form: row.form });
  }
}

class SolveCard extends TypedCard {
  constructor(row, wire, sent) {
    super("solve", row, wire, sent);
  }
}

class LeftSide {
  constructor(wire, sent) {
    this.wire = wire;
    this.sent = sent;
    this.own = {};
    this.shapes = {};
    this.assumptions = new Map();
    this.filters = new Map();
    this.correlations = new Map();
    this.decisions = new Map();
    this.solves = new Map();
    this.find = document.getElementById("find");
    for (const control of this.find.querySelectorAll("input")) control.addEventListener("input", () => this.sift());
    this.makeRun();
  }

  /** Whether a handle is held. */
  get isHeld() {
    const cards = [...this.decisions.values(), ...this.assumptions.values(), ...this.filters.values()];
    return cards.some(({ track }) => track.held !== null);
  }

  /** Show the assumptions that are looked for: by a part of the name or the source, or those that were changed. */
  sift() {
    this.find.hidden = this.assumptions.size <= MANY_CARDS;
    const [words, changed] = this.find.querySelectorAll("input");
    const wanted = this.find.hidden ? "" : words.value.trim().toLocaleLowerCase();
    let shown = 0;
    for (const { root, row } of this.assumptions.values()) {
      const said = `${row.name} ${row.source} ${row.cell}`.toLocaleLowerCase();
      root.hidden = !said.includes(wanted) || (!this.find.hidden && changed.checked && !row.changed);
      shown += root.hidden ? 0 : 1;
    }
    const all = this.assumptions.size;
    this.find.lastElementChild.textContent = shown < all ? `${shown} of ${all}` : "";
  }

  /** Trials and seed of the runs at rest. */
  makeRun() {
    const whole = (least, take) => (value) => {
      if (!Number.isSafeInteger(value) || value < least) return `Type a whole number of at least ${least}.`;
      take(value);
      return "";
    };
    const ask = (key) => (value) => this.wire.say({ kind: "run", trials: this.run.trials, seed: this.run.seed, [key]: value });
    this.trials = new NumberBox("Trials", "", whole(1, ask("trials")));
    this.seed = new NumberBox("Seed", "", whole(0, ask("seed")));
    this.back = make("button", { type: "button", class: "back", text: "As in the workbook", "aria-label": "Trials and seed as in the workbook",
      on: { click: () => this.wire.say({ kind: "run", trials: null, seed: null }) } });
    document.getElementById("run").append(make("div", { class: "numbers" }, this.trials.root, this.seed.root), this.back);
  }

  /** A workbook that was read, again perhaps. */
  book({ shapes }) {
    this.own = shapes;
    this.shapes = { ...shapes };
  }

  state({ assumptions, filters, correlations, decisions, solves, run }) {
    for (const [what, Card, rows] of [["decisions", DecisionCard, decisions], ["correlations", CorrelationCard, correlations],
      ["solves", SolveCard, solves]]) {
      this.rows(what, Card, rows, (card, row) => card.update(row));
      document.getElementById(`${what}-head`).hidden = !rows.length;
    }
    this.run = run;
    this.trials.update(run.trials, 1);
    this.seed.update(run.seed, 1);
    this.back.hidden = !run.changed;
    this.rows("assumptions", AssumptionCard, assumptions, (card, row) => {
      if (!row.changed) this.shapes[row.name] = this.own[row.name];
      card.update(row, this.shapes[row.name] ?? null, this.own[row.name] ?? null);
    });
    this.sift();
    this.rows("filters", FilterCard, filters, (card, row) => card.update(row));
    document.getElementById("filters-head").hidden = !filters.length;
  }

  rows(what, Card, rows, update) {
    const cards = this[what];
    const names = new Set(rows.map((row) => row.name));
    for (const [name, card] of cards) {
      if (names.has(name)) continue;
      card.root.remove();
      cards.delete(name);
    }
    for (const row of rows) {
      if (!cards.has(row.name)) cards.set(row.name, new Card(row, this.wire, this.sent));
      const card = cards.get(row.name);
      update(card, row);
      if (!card.root.isConnected) document.getElementById(what).append(card.root);
    }
  }

  moved({ of, name, key, value }) {
    this[`${of}s`]?.get(name)?.moved(key, value);
  }

  /** The distributions that differ from the workbook's, with an answer. */
  reshape(shapes) {
    for (const [name, shape] of Object.entries(shapes ?? {})) {
      this.shapes[name] = shape;
      this.assumptions.get(name)?.reshape(shape);
    }
  }

  rest({ rejected, checks, evaluated }) {
    for (const [name, counts] of Object.entries(rejected)) this.filters.get(name)?.count(counts, evaluated);
    document.getElementById("checks-head").hidden = !checks.length;
    document.getElementById("checks").replaceChildren(...checks.map(({ name, cell, failing }) => make("li",
      { class: failing.length ? "fails" : "holds" }, make("b", { text: failing.length ? "Fails: " : "Holds: " }),
      named(name), make("span", { class: "about", text: ` · ${cell}` }),
      ...failing.map((text) => make("p", { text })))));
  }
}
