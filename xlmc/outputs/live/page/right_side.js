"use strict";
// The right side: tabs with the charts, what matters, pairs, tables, scenarios, and what is handed over.

const TABS = { charts: "Answers", matters: "What matters", pairs: "Pairs", tables: "Tables", step: "Single step", scenarios: "Scenarios",
  studies: "Hand over" };

const MANY = 6; // answers and sentences; more of them would leave no room for the charts

const ALL = ""; // is seen where the ranges of all charts are

class RightSide {
  constructor(wire) {
    this.wire = wire;
    this.tab = "charts";
    this.panels = new Map();
    this.seen = new Set();
    this.open = null;
    this.forecasts = [];
    this.places = {};
    const bar = document.getElementById("tabs");
    const all = document.getElementById("panels");
    for (const [key, label] of Object.entries(TABS)) {
      const tab = make("button", { type: "button", role: "tab", id: `tab-${key}`, "aria-controls": `panel-${key}`,
        text: label, on: { click: () => this.choose(key) } });
      bar.append(tab);
      this.places[key] = make("div", { role: "tabpanel", id: `panel-${key}`, "aria-labelledby": `tab-${key}`, tabindex: "0" });
      all.append(this.places[key]);
    }
    bar.addEventListener("keydown", (event) => this.walk(event));
    this.sentences = make("ul", { class: "statements" });
    this.meaning = make("p", { class: "remark" });
    this.choice = make("fieldset", { class: "which" }, make("legend", { text: "Answers" }));
    this.choosing = make("summary");
    this.choices = make("details", { class: "choosing", open: true }, this.choosing, this.choice);
    this.charts = make("div", { class: "live-charts" });
    this.trend = new TrendView(ALL);
    const split = make("input", { type: "checkbox", checked: true, on: { change: ({ target }) => {
      this.charts.classList.toggle("alone", !target.checked);
    } } });
    this.places.charts.append(this.sentences, this.choices,
      make("p", { class: "choices" }, make("label", {}, split, "Numbers beside the charts")), this.charts, this.trend.root, this.meaning);
    this.tables = Object.fromEntries(["matters", "tables"].map((key) => [key, make("div", { class: "made" })]));
    for (const [key, place] of Object.entries(this.tables)) this.places[key].append(place);
    this.pairs = new PairView(this.places.pairs, (pair) => {
      this.pair = pair;
      this.look();
    });
    LivePanel.set = (name, key, value) => wire.set("forecast", name, key, value, false);
    LivePanel.back = (name) => wire.say({ kind: "reset", of: "forecast", name });
    this.step = new StepView(this.places.step, () => this.look());
    this.scenarios = new ScenarioView(this.places.scenarios, wire);
    this.hand = new HandView(this.places.studies, wire);
    this.watch = new IntersectionObserver((entries) => {
      for (const { target, isIntersecting } of entries) {
        const { name } = /** @type {HTMLElement} */ (target).dataset;
        if (isIntersecting) this.seen.add(name);
        else this.seen.delete(name);
      }
      this.look();
    });
    this.choose("charts", false);
  }

  choose(key, tell = true) {
    this.tab = key;
    for (const each of Object.keys(TABS)) {
      const tab = document.getElementById(`tab-${each}`);
      tab.setAttribute("aria-selected", String(each === key));
      tab.tabIndex = each === key ? 0 : -1;
      this.places[each].hidden = each !== key;
    }
    if (["charts", "matters", "pairs", "tables"].includes(key)) this.places[key].prepend(...(key === "charts" ? [this.sentences] : []), this.choices);
    if (tell) this.look();
  }

  /** Arrow keys go from tab to tab. */
  walk(event) {
    const keys = Object.keys(TABS);
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step) return;
    event.preventDefault();
    const next = keys[(keys.indexOf(this.tab) + step + keys.length) % keys.length];
    this.choose(next);
    document.getElementById(`tab-${next}`).focus();
  }

  /** Tell the server what can be seen, once things have come to rest. */
  look() {
    clearTimeout(this.looking);
    this.looking = setTimeout(() => {
      const isSeen = (name) => this.seen.has(name) || this.seen.has(ALL);
      const names = this.forecasts.map((each) => each.name).filter((name) => this.open.has(name) && isSeen(name));
      const { first = "", second = "" } = this.pair ?? {};
      this.wire.say({ kind: "view", forecasts: names, chosen: [...this.open], tab: this.tab, first, second,
        trial: this.step.trial, fits: Boolean(this.fits) });
    }, 60);
  }

  book({ forecasts, z }) {
    this.z = z;
    this.forecasts = forecasts;
    const known = new Set(forecasts.map((each) => each.name));
    this.open = new Set([...(this.open ?? forecasts.slice(0, 3).map((each) => each.name))].filter((name) => known.has(name)));
    this.choice.replaceChildren(this.choice.firstElementChild, ...forecasts.map(({ name }) => make("label", {},
      make("input", { type: "checkbox", checked: this.open.has(name), on: { change: ({ target }) => {
        if (target.checked) this.open.add(name);
        else this.open.delete(name);
        this.arrange();
      } } }), named(name))));
    this.watch.observe(this.trend.root);
    this.choices.hidden = forecasts.length < 2;
    this.choices.open = forecasts.length <= MANY;
    this.choosing.hidden = forecasts.length <= MANY;
    this.arrange();
  }

  /** A place for each open forecast, in the order of the workbook. */
  arrange() {
    const wanted = this.forecasts.filter(({ name }) => this.open.has(name));
    for (const [name, { place }] of this.panels) {
      if (wanted.some((each) => each.name === name)) continue;
      this.watch.unobserve(place);
      place.remove();
      this.seen.delete(name);
      this.panels.delete(name);
    }
    for (const forecast of wanted) {
      if (!this.panels.has(forecast.name)) {
        const place = make("div", { class: "place", "data-name": forecast.name });
        this.panels.set(forecast.name, { place, panel: null });
        this.watch.observe(place);
      }
      this.charts.append(this.panels.get(forecast.name).place);
    }
    this.compareRanges();
    this.choosing.textContent = `Shown: ${wanted.length} of ${this.forecasts.length} answers`;
    this.tell();
    this.look();
  }

  frame({ forecasts, stage }) {
    for (const [name, forecast] of Object.entries(forecasts)) {
      const entry = this.panels.get(name);
      if (!entry) continue;
      if (forecast === null) {
        entry.panel = null;
        entry.place.replaceChildren(make("h3", {}, named(name)), make("p", { class: "alarm", text: "Too few accepted trials have a number to draw a chart." }));
      } else if (forecast.shares) {
        entry.panel = null;
        entry.place.replaceChildren(sharesElement(forecast));
      } else if (entry.panel) {
        entry.panel.update(forecast, stage === "moving");
      } else {
        const element = forecastElement(forecast, Numbered.id("forecast"));
        entry.place.replaceChildren(element);
        entry.panel = new LivePanel(element, forecast, this.z);
        entry.panel.stated(this.stated.get(name));
        element.querySelector(".fit").addEventListener("focus", () => {
          if (this.fits) return;
          this.fits = true;
          this.look();
        });
      }
    }
    this.compareRanges();
  }

  /** The ranges of the charts that are open, in their order. */
  compareRanges() {
    const open = this.forecasts.map(({ name }) => this.panels.get(name)?.panel);
    this.trend.show(open.filter(Boolean));
  }

  rest({ sentences, meaning, sampling, warnings, notices }) {
    this.said = { sentences, warnings };
    this.tell();
    this.meaning.replaceChildren(meaning, make("br"), sampling, ...notices.flatMap((text) => [make("br"), text]));
  }

  /** The answers in sentences; where there are many, those without a chart stand behind their number. */
  tell() {
    if (!this.said) return;
    const { sentences, warnings } = this.said;
    const first = sentences.find((text) => this.forecasts.some(({ name }) => this.open.has(name) && text.startsWith(`${name}: `)));
    document.getElementById("answer").replaceChildren(named(warnings.length ? warnings[0] : first ?? sentences[0] ?? ""));
    const many = sentences.length > MANY;
    const without = this.forecasts.filter(({ name }) => !this.open.has(name)).map(({ name }) => name);
    const isAside = (text) => many && without.some((name) => text.startsWith(`${name}: `) || text.startsWith(`P(${name} `));
    const line = (text) => sentence(text, this.forecasts);
    const aside = sentences.filter(isAside);
    const wasOpen = this.sentences.querySelector("details")?.open ?? false;
    this.sentences.replaceChildren(...warnings.map((text) => make("li", { class: "warning", text })),
      ...sentences.filter((text) => !isAside(text)).map(line));
    if (!aside.length) return;
    const count = aside.length === 1 ? "One sentence" : `${aside.length} sentences`;
    this.sentences.append(make("li", { class: "further" }, make("details", { open: wasOpen },
      make("summary", { text: `${count} on answers without a chart` }), make("ul", {}, ...aside.map(line)))));
  }

  part({ tab, html, pair, matrix, trial, trials }) {
    if (tab === "scenarios") this.scenarios.part(html);
    else if (tab === "step") this.step.part(html, trial, trials);
    else if (html !== undefined) showTables(this.tables[tab], html);
    if (pair !== undefined) this.pairs.show(pair);
    if (matrix !== undefined) this.pairs.matrix.show(matrix);
  }

  state(message) {
    LivePanel.behind = message.behind;
    this.stated = new Map(message.forecasts.map((row) => [row.name, row]));
    for (const [name, { panel }] of this.panels) if (this.stated.has(name)) panel?.stated(this.stated.get(name));
    this.scenarios.state(message);
    this.hand.state(message);
    const drawn = message.assumptions.filter(({ status }) => status === "drawn").map(({ name }) => name);
    const names = [...this.forecasts.map(({ name }) => name), ...drawn];
    if (names.join("\n") === this.offered) return;
    this.offered = names.join("\n");
    this.pairs.offer(names);
  }
}

/** A sentence with the name before its colon in bold. */
function sentence(text, forecasts) {
  const found = forecasts.find(({ name }) => text.startsWith(`${name}: `));
  if (!found) return make("li", {}, named(text));
  return make("li", {}, make("b", {}, named(found.name)), text.slice(found.name.length));
}

/** Tables that the server wrote, which escapes every name; with buttons that copy them. */
function showTables(place, html) {
  const open = [...place.querySelectorAll("details")].map((each) => each.open);
  place.innerHTML = html;
  place.querySelectorAll("details").forEach((each, i) => { if (i in open) each.open = open[i]; });
  for (const table of place.querySelectorAll("table")) {
    table.before(Copies.row(Copies.button("Copy table", (button) => Copies.say(button, Copies.copy(table))),
      Copies.button("Save table", () => Copies.saveTable(table))));
  }
  for (const drawn of place.querySelectorAll("svg.drawn")) {
    drawn.after(Copies.row(
      Copies.button("Copy picture", (button) => Copies.say(button, Copies.copyPicture(() => Copies.painted(drawn)))),
      Copies.button("Save SVG", () => Copies.save(Copies.standalone(drawn), Copies.name(drawn, "svg")))));
  }
}
