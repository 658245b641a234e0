"use strict";
// A forecast's chart that is brought up to date without being made anew, with the state that is compared behind it.

const BEHIND = "#6B4F9E", MOST_DRAWN = 500;

/** The elements of one forecast; `Panel` of the page of results works on them. */
function forecastElement({ name, units, marks }, number) {
  const lines = marks.map(({ label }) => label);
  const about = `chart-${number}`;
  const view = (key, label) => make("label", {},
    make("input", { type: "radio", name: `${about}-view`, value: key, checked: key === "frequency" }), label);
  const box = (label, key, unit) => make("label", {}, make("span", { text: label }),
    make("input", { type: "text", inputmode: "text", autocomplete: "off", spellcheck: "false", class: key }),
    make("span", { class: "unit", text: unit }));
  const count = make("input", { type: "text", inputmode: "numeric", autocomplete: "off", class: "bar-count", size: 4,
    "aria-label": `Number of bars of ${name}`, title: "Blank: as many as suit the trials" });
  const views = make("div", { class: "views-and-bars" },
    make("fieldset", { class: "views" }, make("legend", { text: "Chart" }), view("frequency", "Frequency"),
      view("cumulative", "Cumulative"), view("reverse", "Reverse cumulative")),
    make("p", { class: "choices" }, make("label", {}, "Bars ", count, " ", make("output", { class: "bars-drawn" })),
      make("button", { type: "button", class: "zoom", "aria-pressed": "false", text: "Zoom to the range",
        "aria-label": `Zoom to the range of ${name}` }),
      ...lines.map((label) => make("label", {}, make("input", { type: "checkbox", class: "line", value: label, checked: true }),
        label)),
      make("label", {}, "Mark at ", make("input", { type: "text", class: "percentiles", placeholder: "5, 50, 95", size: 8,
        autocomplete: "off" }), " %"),
      make("label", {}, "Fit ", make("select", { class: "fit" }, make("option", { text: "none" })))));
  const ends = make("div", { class: "grabbed" },
    make("div", { class: "boxes" }, box("Lower end", "low", units), box("Upper end", "high", units),
      box("Certainty", "share", "%"), make("button", { type: "button", class: "reset", text: "Central range" })),
    make("p", { class: "threshold" }, make("label", {}, "Above ", make("input", { type: "text", autocomplete: "off",
      spellcheck: "false", class: "above", "aria-label": `Threshold of ${name}` }), units ? ` ${units}` : ""),
    " ", make("output", { class: "beyond" }), " ",
    make("label", {}, "Central range ", make("input", { type: "text", autocomplete: "off", spellcheck: "false",
      class: "central", "aria-label": `Central range of ${name}, in percent` }), " %"), " ",
    make("button", { type: "button", class: "back", hidden: true, text: "As in the workbook",
      "aria-label": `Threshold and central range of ${name} as in the workbook` })),
    make("p", { class: "fault", role: "alert" }), make("p", { class: "certainty" }));
  const chart = make("div", { class: "chart", role: "group", "aria-label": `Chart of ${name}, with two grabbers` });
  return make("article", { class: "forecast", id: about },
    make("h3", {}, named(name)),
    make("p", { class: "moved" }),
    make("div", { class: "figure" },
      make("div", { class: "drawing" }, views, chart, make("p", { class: "readout" }),
        make("p", { class: "fitted" }), ends),
      make("div", { class: "beside-chart" }, make("table", { class: "beside" },
        make("caption", { text: "Accepted trials" }), make("thead"), make("tbody")),
        pictures(chart, name, () => chart.dispatchEvent(new Event("svg"))))),
  );
}

/** An answer that is yes or no, or a text: the share of each, and that of the state behind it. */
function sharesElement({ name, shares }) {
  const compared = shares.some(([, , , before]) => before !== null);
  const heads = ["", "", "Now", ...(compared ? ["Before"] : [])];
  const bar = (value) => make("meter", { min: 0, max: 100, value, "aria-hidden": "true" });
  return make("article", { class: "forecast shares" }, make("h3", {}, named(name)),
    make("table", { class: "beside" }, make("caption", { text: "Share of the accepted trials" }),
      make("thead", {}, make("tr", {}, ...heads.map((text) => (text ? make("th", { scope: "col", text }) : make("td"))))),
      make("tbody", {}, ...shares.map(([label, text, now, before]) => make("tr", {},
        make("th", { scope: "row" }, named(label)), make("td", {}, bar(now)), make("td", { class: "number", text }),
        ...(compared ? [make("td", { class: "number", text: `${styled(before.toFixed(2))} %` })] : []))))));
}

class LivePanel extends Panel {
  static behind = "";
  /** How many bars of a forecast were asked for; null for as many as suit the trials. */
  static bars = {
    place: (name) => `bars ${location.pathname} ${name}`,
    of: (name) => Number(sessionStorage.getItem(LivePanel.bars.place(name))) || null,
    keep: (name, count) => {
      if (count === null) sessionStorage.removeItem(LivePanel.bars.place(name));
      else sessionStorage.setItem(LivePanel.bars.place(name), String(count));
    },
  };
  /** @type {(...given: any[]) => void} tells the server how a forecast is stated: name, key and value */
  static set = () => {};
  /** @type {(name: string) => void} that it is stated as in the workbook */
  static back = () => {};

  constructor(element, forecast, z) {
    super(element, forecast, z);
    this.article = element;
    for (const box of [this.box("low"), this.box("high"), this.find(".above")]) box.classList.toggle("dated", Boolean(forecast.form.moment));
    this.find(".bar-count").value = String(LivePanel.bars.of(forecast.name) ?? "");
    this.divide();
    if (this.bins !== this.bars) this.draw();
    this.find(".chart").addEventListener("svg", () => saveSvg(this.chart, this.find(".chart")));
    this.tell();
  }

  listen(element) {
    super.listen(element);
    this.find(".zoom").addEventListener("click", () => this.toggleZoom());
    this.find(".above").addEventListener("change", () => this.typeThreshold());
    this.find(".central").addEventListener("change", () => this.typeCentral());
    this.find(".back").addEventListener("click", () => LivePanel.back(this.forecast.name));
  }

  /** How many bars are drawn can be typed, and is kept until the tab is closed. */
  listenToBars() {
    const box = this.find(".bar-count");
    box.addEventListener("change", () => {
      const wanted = box.value.trim() ? typed(box.value, null) : null;
      const wrong = box.value.trim() !== "" && !(Number.isInteger(wanted) && wanted >= 1 && wanted <= MOST_DRAWN);
      box.toggleAttribute("aria-invalid", wrong);
      this.find(".fault").textContent = wrong ? `Type a whole number of bars, from 1 to ${countText(MOST_DRAWN)}.` : "";
      if (wrong) return;
      LivePanel.bars.keep(this.forecast.name, wanted);
      this.divide();
      this.draw();
    });
  }

  /** Take as many bars as were asked for, or nearly: they hold equal numbers of the parts that were counted. */
  divide() {
    const wanted = LivePanel.bars.of(this.forecast.name);
    this.bins = divided(this.bars, wanted);
    const drawn = this.bins.counts.length;
    this.find(".bar-count").placeholder = String(this.bars.counts.length);
    this.find(".bars-drawn").textContent = wanted !== null && drawn !== wanted ? `(${countText(drawn)} drawn)` : "";
  }

  /** How the forecast is stated now; what is being typed stays. */
  stated({ threshold, central, changed }) {
    const texts = { ".above": threshold === null ? "" : this.kept("above", threshold), ".central": shortText(central, 12) };
    for (const [place, text] of Object.entries(texts)) {
      const box = this.find(place);
      if (document.activeElement === box && box.value !== box.dataset.shown) continue;
      box.value = box.dataset.shown = text;
      box.removeAttribute("aria-invalid");
    }
    this.find(".back").hidden = !changed;
    this.tellAbove();
  }

  /** The threshold that was typed; a blank box is none. */
  typeThreshold() {
    const box = this.find(".above");
    const value = box.value.trim() ? formTyped(box.value, null, this.forecast.form) : NONE;
    this.tellAbove();
    if (value !== NONE && !Number.isFinite(value)) return;
    box.dataset.shown = box.value;
    LivePanel.set(this.forecast.name, "threshold", value);
  }

  /** The central range that was typed; a blank box is the workbook's. */
  typeCentral() {
    const box = this.find(".central");
    const value = box.value.trim() ? typed(box.value, null) : undefined;
    const wrong = value !== undefined && !(value > 1 && value < 100);
    box.toggleAttribute("aria-invalid", wrong);
    this.find(".fault").textContent = wrong ? "A central range lies above 1 and below 100 %." : "";
    if (wrong) return;
    box.dataset.shown = box.value;
    LivePanel.set(this.forecast.name, "central", value ?? null);
  }

  /** The fitted distributions of a run at rest; there are none while a handle moves. */
  offerFits() {
    const choice = this.find(".fit");
    const { fits } = this.forecast;
    const wanted = choice.value;
    this.fit = fits.find(({ name }) => name === wanted) ?? null;
    if (!fits.length) return;
    choice.replaceChildren(new Option("none"), ...fits.map(({ name }) => new Option(name)));
    choice.value = this.fit ? wanted : "none";
    choice.closest("label").hidden = false;
    this.find(".fitted").textContent = this.fit ? fittedText(this.fit) : "";
  }

  listenToFits(choice) {
    choice.addEventListener("change", () => {
      this.offerFits();
      this.draw();
    });
    this.offerFits();
  }

  /** Take another run's numbers; `held`: while a handle is held, the axes only grow. */
  update(forecast, held) {
    const before = this.bars;
    this.forecast = forecast;
    this.trials = new Trials(forecast);
    this.own = this.bars = barsOf(forecast);
    this.divide();
    this.step = stepOf(this.bins);
    this.decimals = Math.max(0, -Math.round(Math.log10(this.step)));
    this.percentiles = this.percentiles.map(({ label }) => this.percentile(parseFloat(label)));
    this.offerFits();
    if (before.whole !== this.bars.whole) this.draw();
    this.reach(held);
    this.chart.setData([this.ends, [0, this.top]]);
    if (this.following) this.toOwnRange();
    else if (this.state.share !== null) this.toCentral(this.state.share);
    else this.show();
    this.read(null);
    this.tell();
    this.tellAbove();
  }

  draw() {
    this.chart?.destroy();
    this.reach(false);
    const { state, bins } = this;
    const options = chartOptions(widthOf(this.find(".chart")), this.ends, this.top, this.forecast, state.view);
    options.scales = { x: { time: false, range: () => this.ends }, y: { range: () => [0, this.top] } };
    if (bins.whole) options.axes[0].incrs = [1, 2, 5, 10, 20, 50, 100];
    options.hooks = {
      drawClear: [(chart) => band(chart, this.forecast.range)],
      draw: [(chart) => this.paint(chart), () => this.element()],
      setCursor: [(chart) => this.read(chart.cursor.left < 0 ? null : chart.posToVal(chart.cursor.left, "x"))],
    };
    this.chart = new uPlot(options, [this.ends, [0, this.top]], this.find(".chart"));
    const grid = {
      get step() { return panel.step; }, get min() { return panel.ends[0]; }, get max() { return panel.ends[1]; },
    };
    const panel = this;
    const toLow = (value) => this.set(Math.min(value, state.high), state.high);
    const toHigh = (value) => this.set(state.low, Math.max(value, state.low));
    this.grabbers = {
      low: addGrabber(this.chart, "low", `Lower end of the range of ${this.forecast.name}`, grid, () => state.low, toLow),
      high: addGrabber(this.chart, "high", `Upper end of the range of ${this.forecast.name}`, grid, () => state.high, toHigh),
    };
    this.read(null);
    if (state.low !== undefined) this.show();
  }

  /** Draw what lies between the grabbers, with some room; or the whole again. */
  toggleZoom() {
    this.zoomed = this.zoomed ? null : zoomedTo(this.state, this.bins);
    this.find(".zoom").setAttribute("aria-pressed", String(Boolean(this.zoomed)));
    this.draw();
  }

  /**
   * How far the axes reach: both states have room, and while a handle is held nothing shrinks; where they are zoomed,
   * the bars that can be seen fill the height.
   */
  reach(held) {
    const { behind } = this.forecast;
    if (this.zoomed) {
      this.ends = [...this.zoomed];
      const seen = [highestIn(this.ends, this.bins.edges, this.bins.counts),
        behind ? highestIn(this.ends, behind.edges, this.heights(behind)) : 0];
      this.top = this.state.view === "frequency" ? Math.max(1, ...seen) * 1.08 : 100;
      return;
    }
    const ends = [this.bins.edges[0], this.bins.edges.at(-1)];
    if (behind) {
      ends[0] = Math.min(ends[0], behind.edges[0]);
      ends[1] = Math.max(ends[1], behind.edges.at(-1));
    }
    const heights = [...this.bins.counts, ...(behind ? this.heights(behind) : [])];
    const top = this.state.view === "frequency" ? Math.max(...heights) * 1.08 : 100;
    const old = held && this.ends ? this.ends : ends;
    this.ends = [Math.min(old[0], ends[0]), Math.max(old[1], ends[1])];
    this.top = this.state.view === "frequency" && held && this.top > 0.6 * top ? Math.max(top, this.top * 0.98) : top;
  }

  /** The bars behind, as high as if they held as many trials as those now. */
  heights({ counts, trials, parts }) {
    const factor = (this.forecast.trials / trials) * parts * (this.bins.numbers ?? 1);
    return counts.map((count) => count * factor);
  }

  paint(chart) {
    const { state, bins, forecast: { behind } } = this;
    const shape = state.view === "frequency" ? bars(bins.edges, bins.counts) : curve(this.trials, this.ends, state.view);
    paint(chart, shape, this.marks(), bins.covered(state.low, state.high));
    if (this.fit) {
      trace(chart, fittedLine(this.fit, this.own, this.forecast.trials, bins.numbers ?? 1, state.view), FITTED, []);
    }
    if (!behind) return;
    const line = state.view === "frequency"
      ? [[behind.edges[0], 0], ...bars(behind.edges, this.heights(behind)), [behind.edges.at(-1), 0]]
      : behind.curve.map(([x, y]) => [x, state.view === "reverse" ? 100 - y : y]);
    trace(chart, line, BEHIND, []);
  }

  toOwnRange() {
    super.toOwnRange();
    this.following = true;
  }

  set(low, high, texts = {}) {
    this.following = false;
    super.set(low, high, texts);
  }

  /** The probability of more than what was typed as a threshold. */
  tellAbove() {
    const text = this.find(".above").value;
    const place = this.find(".beyond");
    const threshold = text.trim() ? formTyped(text, null, this.forecast.form) : null;
    this.find(".above").toggleAttribute("aria-invalid", Boolean(text.trim()) && threshold === null);
    if (threshold === null) {
      place.textContent = text.trim() ? whyNoNumber(text) : "";
      return;
    }
    const { trials } = this.forecast;
    const { count: upto, doubt } = this.trials.reached(threshold, true);
    const share = shareOf(trials - upto, trials, this.z);
    const about = doubt ? "about " : "";
    place.textContent = `P = ${percentText(share)} % (${about}${countText(trials - upto)} of ${countText(trials)})`;
  }

  /** The numbers beside the chart, now and behind, and how the mean has moved. */
  tell() {
    const { beside, said } = this.forecast;
    const compared = beside.some(([, , before]) => before);
    const table = this.find(".beside");
    const heads = compared ? ["", "Now", "Before", "Difference"] : ["", "Now"];
    table.tHead.replaceChildren(make("tr", {}, ...heads.map((text) => (text
      ? make("th", { scope: "col", class: "number", text }) : make("td")))));
    table.tBodies[0].replaceChildren(...beside.map(([label, now, before, apart]) => make("tr", {},
      make("th", { scope: "row", text: label }),
      ...(compared ? [now, before, apart] : [now]).map((text) => make("td", { class: "number", text })))));
    table.caption.textContent = compared ? `Accepted trials. Violet line: ${LivePanel.behind}` : "Accepted trials";
    this.find(".moved").textContent = said ?? "";
    this.find(".reset").textContent = `Central ${this.forecast.range.said} range`;
  }

  legend() {
    return `${super.legend()}${this.forecast.behind ? "    violet line: the state for comparison" : ""}`;
  }
}

/** The bars made of other numbers of the equal parts of all bars, so that there are about so many; the last may be of fewer. */
function divided(bars, wanted) {
  if (wanted === null) return bars;
  const parts = bars.parts.flat();
  const each = parts.length / bars.counts.length;
  const together = Math.max(1, Math.round(parts.length / wanted));
  const width = (bars.width * together) / each;
  const starts = [...parts.keys()].filter((i) => i % together === 0);
  return {
    ...bars,
    edges: [...starts.map((i) => bars.edges[Math.floor(i / each)] + (bars.width * (i % each)) / each), bars.edges.at(-1)],
    counts: starts.map((i) => parts.slice(i, i + together).reduce((sum, count) => sum + count, 0)),
    decimals: [0, 1, 2].map((more) => bars.decimals + more).find((d) => isWhole(width * 10 ** d)) ?? bars.decimals + 2,
    numbers: together / each,
  };
}

function isWhole(number) {
  return Math.abs(number - Math.round(number)) < 1e-9 * Math.max(1, number);
}

/** Where a chart begins and ends that shows a range, which may be open or very narrow. */
function zoomedTo({ low, high }, { edges, width }) {
  const [from, to] = [Math.max(low, edges[0]), Math.min(high, edges.at(-1))];
  const room = Math.max(0.15 * (to - from), 2 * width);
  return [from - room, to + room];
}

/** The highest of the bars of which a part lies between two ends; 0 where none does. */
function highestIn([from, to], edges, counts) {
  return Math.max(0, ...counts.filter((_, i) => edges[i] < to && edges[i + 1] > from));
}

/** Buttons that copy and save a chart; `svg` saves it as vectors. */
function pictures(chart, name, svg) {
  const button = (text, act) => make("button", { type: "button", class: "copy", text, "aria-label": `${text} of ${name}`,
    on: { click: act } });
  const painted = () => Copies.onWhite(chart.querySelector("canvas"));
  const png = () => painted().toBlob((picture) => Copies.save(picture, Copies.name(chart, "png")));
  return make("p", { class: "pictures" },
    button("Copy picture", ({ target }) => Copies.say(target, Copies.copyPicture(async () => painted()))),
    button("Save PNG", png), button("Save SVG", svg));
}
