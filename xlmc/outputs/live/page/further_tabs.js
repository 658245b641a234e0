"use strict";
// The tabs beside the charts: pairs of quantities, scenarios, and what is handed over.

const MOST_DOTS = 2000;

/** All chosen answers two at a time: below the diagonal scatters, above it rank correlation and share above both limits. */
class PairMatrix {
  constructor(place, chosen) {
    this.chosen = chosen;
    this.said = make("p", { class: "remark" });
    this.table = make("table", { class: "matrix" });
    this.root = make("section", { hidden: true }, make("h3", { text: "All chosen answers two at a time" }), this.said,
      make("div", { class: "wide", tabindex: "0", role: "group", "aria-label": "Matrix of scatters" }, this.table));
    place.append(this.root);
  }

  show(matrix) {
    this.root.hidden = !matrix;
    if (!matrix) return;
    const { names, said, looked, accepted, left } = matrix;
    const first = looked < accepted ? ` Of the first ${countText(looked)} of ${countText(accepted)} accepted trials.` : "";
    const more = left ? ` ${countText(left)} further answers are left out.` : "";
    this.said.textContent = `Above the diagonal: rank correlation, and the share of the trials above both limits (lines): ${said.join("; ")}.${first}${more}`;
    const head = (name, scope) => make("th", { scope }, named(name));
    this.table.replaceChildren(make("thead", {}, make("tr", {}, make("td"), ...names.map((name) => head(name, "col")))),
      make("tbody", {}, ...names.map((name, row) => make("tr", {}, head(name, "row"),
        ...names.map((_, column) => this.cell(matrix, row, column))))));
  }

  cell({ names, points, limits, cells }, row, column) {
    if (row === column) return make("td", { class: "same" });
    const [low, high] = [Math.min(row, column), Math.max(row, column)];
    const { correlation, above } = cells.find(({ first, second }) => first === names[low] && second === names[high]);
    if (row < column) {
      return make("td", { class: "shares" },
        make("b", { text: correlation === null ? "–" : styled(correlation.toFixed(2)) }), make("br"), `${styled(above.toFixed(1))} %`);
    }
    const picture = scatterPicture(points[column], points[row], limits[column], limits[row]);
    return make("td", {}, make("button", { type: "button", "aria-label": `Show ${names[row]} against ${names[column]}`,
      on: { click: () => this.chosen(names[column], names[row]) } }, picture));
  }
}

const SMALL = 90; // width and height of a scatter in the matrix

/** Points of two quantities, and a line at the limit of each. */
function scatterPicture(x, y, right, upper) {
  const at = scaleTo(x, SMALL), up = scaleTo(y, SMALL);
  const dots = x.flatMap((value, i) => (value === null || y[i] === null ? [] : [`M${at(value)} ${(SMALL - up(y[i])).toFixed(1)}h1.6`])).join("");
  const lines = `M${at(right)} 0V${SMALL}M0 ${(SMALL - up(upper)).toFixed(1)}H${SMALL}`;
  return makeSvg("svg", { viewBox: `0 0 ${SMALL} ${SMALL}`, "aria-hidden": "true" },
    makeSvg("path", { class: "limit", d: lines }), makeSvg("path", { class: "dots", d: dots }));
}

/** What puts values between the ends of a picture, with some room; all in its middle where they do not differ. */
function scaleTo(values, size) {
  const known = values.filter((value) => value !== null);
  const [low, high] = [Math.min(...known), Math.max(...known)];
  return (value) => Number((high > low ? Math.min(size, Math.max(0, size * (0.04 + (0.92 * (value - low)) / (high - low)))) : size / 2).toFixed(1));
}

/** A scatter of two quantities in the same accepted trials, and both in one chart where they have one unit. */
class PairView {
  constructor(place, chosen) {
    this.chosen = chosen;
    this.selects = [0, 1].map((i) => make("select", { "aria-label": i ? "upwards" : "to the right",
      on: { change: () => this.choose() } }));
    this.said = make("p", { class: "pair-said" });
    this.quadrants = make("p", { class: "remark" });
    this.chart = make("div", { class: "chart", role: "img", "aria-label": "No trials yet" });
    this.overlay = make("div", { class: "overlay" });
    const save = pictures(this.chart, "the pair", () => this.scatter && saveSvg(this.scatter, this.chart));
    new ResizeObserver(() => {
      if (this.pair && this.scatter && this.chart.clientWidth && this.scatter.width !== widthOf(this.chart)) this.draw(this.pair);
    }).observe(this.chart);
    place.append(make("p", { class: "choices" }, make("label", {}, "To the right ", this.selects[0]),
      make("label", {}, "Upwards ", this.selects[1])), this.said, this.quadrants, this.chart, save, this.overlay);
    this.matrix = new PairMatrix(place, (first, second) => {
      this.selects[0].value = first;
      this.selects[1].value = second;
      this.choose();
      this.chart.scrollIntoView({ block: "nearest" });
    });
  }

  /** Names to choose from: forecasts first. */
  offer(names) {
    const before = this.selects.map((select) => select.value);
    this.selects.forEach((select, i) => {
      select.replaceChildren(...names.map((name) => new Option(name)));
      select.value = names.includes(before[i]) ? before[i] : names[Math.min(i, names.length - 1)] ?? "";
    });
    this.choose();
  }

  choose() {
    const [first, second] = this.selects.map((select) => select.value);
    this.chosen({ first, second });
  }

  show(pair) {
    if (!pair || pair.first !== this.selects[0].value || pair.second !== this.selects[1].value) {
      if (!pair) this.said.textContent = "This quantity is not drawn now.";
      return;
    }
    const shown = Math.min(pair.x.length, MOST_DOTS);
    const first = pair.looked < pair.accepted ? `the first ${countText(pair.looked)} of ${countedText(pair.accepted, "accepted trial")}`
      : countedText(pair.trials, "accepted trial");
    const related = pair.correlation === null ? "" : `; rank correlation ${styled(pair.correlation.toFixed(2))}`;
    this.said.textContent = `${countText(shown)} of ${first}${related}`;
    this.quadrants.textContent = pair.quadrants;
    this.chart.setAttribute("aria-label", `${pair.second} against ${pair.first}: ${this.said.textContent}`);
    this.pair = pair;
    this.draw(pair);
    this.layOver(pair.together);
  }

  draw({ x, y, first, second, units, forms }) {
    this.scatter?.destroy();
    if (!x.length) return;
    const reach = (values) => {
      const [low, high] = [Math.min(...values), Math.max(...values)];
      const room = 0.04 * (high - low || Math.abs(low) || 1);
      return [low - room, high + room];
    };
    const [ends, sides] = [reach(x), reach(y)];
    const options = chartOptions(widthOf(this.chart), ends, 1, { units: "", form: forms[0] }, "frequency");
    const named = (name, unit) => (unit ? `${name}, ${unit}` : name);
    options.scales.y.range = sides;
    options.axes[0].label = named(first, units[0]);
    options.axes[1].label = named(second, units[1]);
    options.axes[1].values = (_, splits) => splits.map((at) => formText(at, decimalsOf(splits[1] - splits[0]), forms[1]));
    options.hooks = { draw: [(chart) => {
      const { ctx } = chart;
      ctx.fillStyle = "rgba(47, 109, 168, .45)";
      for (let i = 0; i < Math.min(x.length, MOST_DOTS); i++) {
        ctx.fillRect(chart.valToPos(x[i], "x", true) - 2, chart.valToPos(y[i], "y", true) - 2, 4, 4);
      }
    }] };
    this.scatter = new uPlot(options, [ends, sides], this.chart);
  }

  layOver(together) {
    if (!together.length) {
      this.overlay.replaceChildren();
      return;
    }
    const about = Numbered.id("together");
    const view = (value, label) => make("label", {}, make("input", { type: "radio", name: about, value,
      checked: value === "frequency" }), label);
    const chart = make("div", { class: "chart", role: "img", "aria-label": `Chart of ${together.map(({ name }) => name).join(", ")}` });
    this.overlay.replaceChildren(make("h3", { text: "Both in one chart" }),
      make("fieldset", { class: "views" }, make("legend", { text: "Chart" }), view("frequency", "Frequency"),
        view("cumulative", "Cumulative"), view("reverse", "Reverse cumulative")),
      chart, make("ul", { class: "legend" }));
    new Overlay(this.overlay, together.map((forecast) => ({ forecast, trials: new Trials(forecast), bins: barsOf(forecast) })));
  }
}

/** Kept states of the window, and all of them in one table. */
class ScenarioView {
  constructor(place, wire) {
    this.wire = wire;
    this.now = make("p");
    this.name = make("input", { type: "text", id: "scenario-name", autocomplete: "off", maxlength: 200 });
    const form = make("form", { class: "keep", on: { submit: (event) => {
      event.preventDefault();
      if (this.name.value.trim()) wire.say({ kind: "keep", name: this.name.value });
      this.name.value = "";
    } } }, make("label", { for: "scenario-name", text: "Keep this state as " }), this.name, make("button", { text: "Keep" }));
    const button = (text, kind) => make("button", { type: "button", text, on: { click: () => wire.say({ kind }) } });
    const about = make("p", { class: "remark", text: "A scenario is a state with a name: move something, and keep it. The usual variants are "
      + "every range half and one and a half times as wide, and every limit halved and doubled." });
    this.list = make("ul", { class: "scenarios" });
    this.table = make("div");
    this.compare = button("Compare all in one table", "compare");
    place.append(about, this.now, form, this.list, make("p", { class: "actions-left" }, this.compare,
      button("Add the usual variants", "variants")), this.table);
  }

  state({ changes, scenarios, shown }) {
    this.now.replaceChildren(make("b", { text: shown ? `Shown: ${shown}. ` : "Shown: " }),
      changes.length ? named(changes.join("; ")) : "the workbook as it is");
    const act = (kind, name, text) => make("button", { type: "button", text, "aria-label": `${text} ${name || "the workbook"}`,
      on: { click: () => this.wire.say({ kind, name }) } });
    const lines = [{ name: "", changes: [], own: true, shows: true }, ...scenarios].map(({ name, changes: said, own, shows }) => make("li",
      { class: name === shown ? "shown" : null },
      name ? make("b", {}, named(name)) : make("b", { text: "The workbook as it is" }), " ",
      changesOf(said), " ", ...(shows ? [act("show", name, "Show")] : []),
      ...(own ? [name ? make("small", { text: " of the workbook" }) : ""] : [" ", act("drop", name, "Forget")])));
    this.list.replaceChildren(...lines);
    this.compare.disabled = !scenarios.length;
  }

  part(html) {
    showTables(this.table, html);
  }
}

/** One trial of the run, with all its cells; `chosen()` is called when another one is wanted. */
class StepView {
  constructor(place, chosen) {
    this.trial = 0;
    this.trials = 1;
    this.chosen = chosen;
    this.box = make("input", { type: "text", inputmode: "numeric", autocomplete: "off", size: 8, value: "1",
      on: { change: () => this.go(steppedTo(this.box.value, this.trials) ?? this.trial) } });
    this.of = make("span");
    const step = (text, by) => make("button", { type: "button", text, on: { click: () => this.go(this.trial + by) } });
    this.back = step("Previous trial", -1);
    this.on = step("Next trial", 1);
    this.table = make("div", { class: "made" });
    place.append(make("p", { class: "remark", text: "One trial of the run: what was drawn, what every formula that the answers need gave, "
      + "and whether the filters accept it." }),
    make("p", { class: "choices" }, this.back, " ", make("label", {}, "Trial ", this.box), this.of, " ", this.on), this.table);
    this.bound();
  }

  go(trial) {
    this.trial = Math.max(0, Math.min(trial, this.trials - 1));
    this.bound();
    this.chosen();
  }

  /** Say where this is; the ends lead no further, and a button that has the focus keeps it. */
  bound() {
    this.box.value = countText(this.trial + 1);
    this.back.setAttribute("aria-disabled", String(this.trial === 0));
    this.on.setAttribute("aria-disabled", String(this.trial >= this.trials - 1));
  }

  part(html, trial, trials) {
    this.trials = Math.max(1, trials);
    this.of.textContent = ` of the first ${countText(trials)}`;
    if (trial !== this.trial && this.trial < trials) return; // another one is wanted already
    this.trial = trial;
    this.bound();
    showTables(this.table, html);
  }
}

/** The trial that was typed, from 0 and among those there are; null for what is no whole number above 0. */
function steppedTo(text, trials) {
  const value = typed(text, null);
  return Number.isInteger(value) && value > 0 ? Math.min(value, trials) - 1 : null;
}

/** What a scenario changes; much of it behind its number. */
function changesOf(changes) {
  const said = make("span", { class: "about" }, named(changes.join("; ")));
  if (changes.length <= 4) return said;
  return make("details", {}, make("summary", { text: `${changes.length} changes` }), said);
}

/** The button of each study, its command, and what it answers. */
const STUDIES = [
  ["Verify against Excel", "verify", "Do the formulas give the values that Excel saved?"],
  ["Stability", "stability", "Where does a number lose digits, or is not what it seems?"],
  ["Screen", "screen", "Which assumptions may be held, and which filters left out, without changing the answers?"],
  ["Methods", "methods", "Which method of uncertainty analysis is exact enough, and how long does each take?"],
];

/** Files to hand over, and further questions on the workbook. */
class HandView {
  constructor(place, wire) {
    this.wire = wire;
    const save = (text, what) => make("button", { type: "button", text, on: { click: () => wire.say({ kind: "save", what }) } });
    const ask = (text, what) => make("button", { type: "button", text, on: { click: () => this.ask(what) } });
    this.other = make("select", { "aria-label": "workbook to compare with" });
    this.stand = make("p", { role: "status" });
    this.cancel = make("button", { type: "button", text: "Cancel", hidden: true, on: { click: () => wire.say({ kind: "cancel" }) } });
    this.answer = make("pre", { tabindex: "0", hidden: true, "aria-label": "Answer of the study" });
    this.comparing = make("span", { hidden: true }, ask("Compare with", "compare"), " ", this.other);
    this.changes = make("p", { class: "remark" });
    this.still = make("p", { class: "remark", text: "Nothing is changed yet." });
    this.copy = save("A copy of the workbook", "copy");
    this.into = make("button", { type: "button", text: "The workbook itself …", on: { click: () => this.confirm(true) } });
    this.sure = make("p", { class: "notice", hidden: true, role: "group", "aria-label": "Type the changes into the workbook" },
      "This types the changes into the workbook's own cells. The workbook as it was is kept beside it. ",
      make("button", { type: "button", text: "Type them in", on: { click: () => {
        this.confirm(false);
        wire.say({ kind: "save", what: "into" });
      } } }), " ", make("button", { type: "button", text: "Leave it", on: { click: () => this.confirm(false) } }));
    place.append(
      make("h2", { text: "Files" }), this.changes,
      make("p", { class: "actions-left" }, save("Result workbook", "book"), save("Page", "page"), save("JSON", "json"),
        save("Saved run", "run"), make("button", { type: "button", text: "Print", on: { click: () => wire.say({ kind: "print" }) } })),
      make("h2", { text: "Type the changes into" }),
      this.still, make("p", { class: "actions-left" }, this.copy, this.into), this.sure,
      make("h2", { text: "Further studies" }),
      make("p", { class: "remark", text: "They examine the state that is shown, in a copy; Verify examines the workbook's own file. "
        + "You can go on while they run." }),
      make("dl", { class: "studies" }, ...STUDIES.flatMap(([text, what, about]) => [
        make("dt", {}, ask(text, what)), make("dd", { text: about })])),
      make("p", { class: "actions-left" }, this.comparing),
      make("p", { class: "actions-left" }, this.stand, this.cancel), this.answer);
  }

  /** What the files will be of. */
  state({ changes, shown }) {
    const of = changes.length ? [shown ? `of ${shown}: ` : "with these changes: ", named(changes.join("; ")),
      ". The results say so first, and their record says what differs."] : ["of the workbook as it is."];
    this.changes.replaceChildren("Written beside the workbook, ", ...of);
    for (const button of [this.copy, this.into]) button.disabled = !changes.length;
    this.still.hidden = changes.length > 0;
    if (!changes.length) this.sure.hidden = true;
  }

  /** Print the page of results, in a frame that goes when another one is printed. */
  page({ path }) {
    document.querySelector("iframe.printed")?.remove();
    const frame = make("iframe", { class: "printed", title: "Page to be printed", tabindex: "-1", "aria-hidden": "true", src: path });
    frame.addEventListener("load", () => this.print(frame.contentWindow), { once: true });
    document.body.append(frame);
  }

  print(view) {
    view.focus();
    view.print();
  }

  /** Ask once more before a file of the user's own is written to. */
  confirm(asked) {
    this.sure.hidden = !asked;
    if (asked) this.sure.querySelector("button").focus();
    else this.into.focus();
  }

  ask(what) {
    this.wire.say({ kind: "study", what, other: this.other.value });
  }

  others({ books }) {
    this.other.replaceChildren(...books.map(({ name, key }) => new Option(name, key)));
    this.comparing.hidden = !books.length;
  }

  study({ what, of, state, step, seconds, text }) {
    const how = { running: `xlmc ${what} is running, ${Math.round(seconds)} s`, done: `xlmc ${what}, ${seconds} s`,
      cancelled: `xlmc ${what} was cancelled`, failed: `xlmc ${what} has failed` }[state];
    const said = step && state === "running" ? `${how}: ${step}` : how;
    this.stand.replaceChildren(said, ...(of ? [" (", named(of), ")"] : []));
    this.cancel.hidden = state !== "running";
    this.answer.hidden = !text;
    this.answer.textContent = text;
  }
}
