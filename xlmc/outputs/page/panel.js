"use strict";
// One forecast: its chart, its grabbers, its boxes and its certainty, which always say the same.

class Panel {
  constructor(element, forecast, z) {
    this.forecast = forecast;
    this.z = z;
    this.trials = new Trials(forecast);
    this.own = barsOf(forecast);
    this.second = forecast.second && new Trials(forecast.second);
    this.bars = this.bins = this.second ? widened(this.own, this.second) : this.own;
    this.step = stepOf(this.bins);
    this.percentiles = [];
    this.hidden = new Set();
    this.fit = null;
    this.decimals = Math.max(0, -Math.round(Math.log10(this.step)));
    this.find = (selector) => element.querySelector(selector);
    this.box = (key) => element.querySelector(`.boxes .${key}`);
    /** @type {any} `low`, `high` and their texts are set with the first range */
    this.state = { view: "frequency" };
    this.listen(element);
    this.draw();
    this.toOwnRange();
  }

  listen(element) {
    for (const radio of element.querySelectorAll(".views input")) {
      radio.addEventListener("change", () => {
        this.state.view = radio.value;
        this.draw();
      });
    }
    this.listenToBars();
    this.find(".percentiles").addEventListener("change", () => this.markPercentiles());
    for (const box of element.querySelectorAll(".line")) {
      box.addEventListener("change", () => {
        this.hidden[box.checked ? "delete" : "add"](box.value);
        this.draw();
      });
    }
    this.listenToFits(this.find(".fit"));
    for (const key of ["low", "high", "share"]) {
      this.box(key).addEventListener("change", () => this.type(key));
    }
    this.find(".reset").addEventListener("click", () => this.toOwnRange());
    new ResizeObserver(() => {
      if (this.chart.width !== widthOf(this.find(".chart"))) this.draw();
    }).observe(this.find(".chart"));
  }

  /** Some bars can be drawn as one. */
  listenToBars() {
    this.find(".together").addEventListener("change", ({ target }) => {
      this.bins = merged(this.bars, Number(target.value));
      this.draw();
    });
  }

  /** A distribution fitted to the trials is drawn where one is chosen. */
  listenToFits(choice) {
    const { fits } = this.forecast;
    choice.append(...fits.map(({ name }) => new Option(name)));
    choice.closest("label").hidden = !fits.length;
    choice.addEventListener("change", () => {
      this.fit = fits[choice.selectedIndex - 1] ?? null;
      this.find(".fitted").textContent = this.fit ? fittedText(this.fit) : "";
      this.draw();
    });
  }

  /** Lines at the percentages that were typed. */
  markPercentiles() {
    const box = this.find(".percentiles");
    const percents = box.value.split(/[\s,;%]+/).filter(Boolean).map(Number);
    const wrong = percents.some((percent) => !(percent >= 0 && percent <= 100));
    if (wrong) box.setAttribute("aria-invalid", "true");
    else box.removeAttribute("aria-invalid");
    this.find(".fault").textContent = wrong ? "Type percentages from 0 to 100, such as 5, 50, 95." : "";
    if (wrong) return;
    this.percentiles = percents.map((percent) => this.percentile(percent));
    this.draw();
  }

  /** Draw everything again, as for another view or width. */
  draw() {
    this.chart?.destroy();
    this.chart = drawForecast(this.find(".chart"), this.forecast, this.trials, this.bins, this.state, {
      drawn: () => this.element(),
      pointed: (value) => this.read(value),
      marks: () => this.marks(),
      line: this.fit && fittedLine(this.fit, this.own, this.forecast.trials, this.bins.numbers ?? 1, this.state.view),
      second: this.second && secondLine(this.second, this.bins, this.trials.trials, this.state.view),
    });
    const { step, state, bins } = this;
    const grid = { step, min: bins.edges[0], max: bins.edges.at(-1) };
    const toLow = (value) => this.set(Math.min(value, state.high), state.high);
    const toHigh = (value) => this.set(state.low, Math.max(value, state.low));
    this.grabbers = {
      low: addGrabber(this.chart, "low", "Lower end of the range", grid, () => state.low, toLow),
      high: addGrabber(this.chart, "high", "Upper end of the range", grid, () => state.high, toHigh),
    };
    this.read(null);
    if (state.low !== undefined) this.show();
  }

  /** A line at a percentile. */
  percentile(percent) {
    const value = this.trials.quantile(percent / 100);
    return { label: `${percent} %`, value, text: this.written(value, this.decimals + 1) };
  }

  marks() {
    return [...this.forecast.marks.filter(({ label }) => !this.hidden.has(label)), ...this.percentiles];
  }

  /** The forecast's own central range, with the texts that the sheets have. */
  toOwnRange() {
    const { low, high, share, lowText, highText } = this.forecast.range;
    this.set(low, high, { share, lowText, highText });
  }

  /** The central range of a share of the trials. */
  toCentral(share) {
    if (share === this.forecast.range.share) this.toOwnRange();
    else this.set(this.trials.quantile((1 - share) / 2), this.trials.quantile(1 - (1 - share) / 2), { share });
  }

  /** What was typed into a box. */
  type(key) {
    const { low, high, lowText, highText } = this.state;
    const open = { low: -Infinity, high: Infinity, share: null }[key], { value: text } = this.box(key);
    const value = key === "share" ? typed(text, open) : formTyped(text, open, this.forecast.form);
    const why = this.whyNot(key, value);
    if (why) this.refuse(key, why);
    else if (key === "share") this.toCentral(value / 100);
    else if (key === "low") this.set(value, high, { lowText: this.kept(key, value), highText });
    else this.set(low, value, { lowText, highText: this.kept(key, value) });
  }

  /** Why this cannot stand in a box; nothing where it can. */
  whyNot(key, value) {
    if (value === null) return "Type a number.";
    if (key === "share") return value >= 0 && value <= 100 ? "" : "A certainty lies between 0 and 100 %.";
    const crossed = key === "low" ? value > this.state.high : value < this.state.low;
    return crossed ? "The lower end must not lie above the upper end." : "";
  }

  refuse(key, why) {
    this.box(key).setAttribute("aria-invalid", "true");
    this.find(".fault").textContent = why;
  }

  set(low, high, { share = null, lowText = null, highText = null } = {}) {
    Object.assign(this.state, { low, high, share });
    const finer = [low, high].some((end) => Number.isFinite(end) && !this.isOnStep(end)); // both with as many decimals
    this.state.lowText = Number.isFinite(low) && lowText ? lowText : this.text(low, finer);
    this.state.highText = Number.isFinite(high) && highText ? highText : this.text(high, finer);
    this.show();
  }

  isOnStep(value) {
    return Math.abs(value / this.step - Math.round(value / this.step)) < 1e-6;
  }

  /** An end as text, one digit finer than the step where it is not on it. */
  text(value, finer) {
    return this.written(value, finer ? this.decimals + 1 : this.decimals);
  }

  /** A number in the form of the forecast. */
  written(value, decimals) {
    return formText(value, decimals, this.forecast.form);
  }

  /** A typed end as it was typed, but in the form of the forecast. */
  kept(key, value) {
    const { form } = this.forecast;
    if (form.moment || !Number.isFinite(value)) return this.text(value, true);
    const digits = String(Number((value * form.factor).toPrecision(12))).split(".")[1]?.length ?? 0;
    return this.written(value, digits + Math.round(Math.log10(form.factor)));
  }

  /** Bring chart, grabbers, boxes and certainty up to date. */
  show() {
    const { share, lowText, highText } = this.state;
    this.chart.redraw(false);
    const found = this.certainty();
    this.box("low").value = lowText;
    this.box("high").value = highText;
    this.box("share").value = share === null ? found.text.split(" ")[0] : shortText(100 * share, 12);
    for (const box of ["low", "high", "share"]) this.box(box).removeAttribute("aria-invalid");
    this.find(".fault").textContent = "";
    this.say(found);
  }

  /** Put the grabbers where the chart, which is drawn a moment later than asked, has room for them. */
  element() {
    const { low, high, lowText, highText } = this.state;
    if (low === undefined) return;
    this.grabbers.low(low, lowText);
    this.grabbers.high(high, highText);
  }

  /** The share of trials between the grabbers. */
  certainty() {
    const { count, doubt } = this.trials.between(this.state.low, this.state.high);
    const share = shareOf(count, this.trials.trials, this.z);
    return { count, doubt, share, text: percentText(share) };
  }

  say({ count, doubt, share, text }) {
    const { low, high, lowText, highText } = this.state;
    const { units, trials } = this.forecast;
    const element = this.find(".certainty");
    const decimals = Math.max(0, 1 - exponentOf(100 * share.error));
    const ends = [share.low, share.high].map((end) => styled((100 * end).toFixed(decimals)));
    const about = doubt ? `about ${countText(count)}` : countText(count);
    const off = doubt ? `, off by ${countText(Math.ceil(doubt))} at most` : "";
    const unit = units ? ` ${units}` : "";
    const range = low === -Infinity && high === Infinity ? "everywhere" : `from ${lowText} to ${highText}${unit}`;
    const main = document.createElement("strong");
    main.textContent = `${text} %`;
    const detail = document.createElement("span");
    const counted = `${about} of ${countText(trials)}${off}`;
    detail.textContent = `of the accepted trials lie ${range}: ${counted}; 95 % interval ${ends.join(" to ")} %.`;
    element.replaceChildren(main, " ", detail);
    if (this.second) element.append(this.besides());
    element.dataset.count = String(count);
    element.dataset.low = String(low);
    element.dataset.high = String(high);
  }

  /** The certainty of the same range in the second run. */
  besides() {
    const { count, doubt } = this.second.between(this.state.low, this.state.high);
    const share = shareOf(count, this.second.trials, this.z);
    const said = document.createElement("span");
    const counted = `${doubt ? "about " : ""}${countText(count)} of ${countText(this.second.trials)}`;
    said.className = "second";
    said.textContent = `Second run: ${percentText(share)} % (${counted}).`;
    return said;
  }

  /** What the pointer is at. */
  read(value) {
    this.find(".readout").textContent = value === null ? this.legend() : this.readout(value);
  }

  readout(value) {
    const { bins, forecast: { units, trials } } = this;
    const unit = units ? ` ${units}` : "";
    if (this.state.view === "frequency") {
      const i = Math.min(Math.max(lastUpTo(bins.edges, value), 0), bins.counts.length - 1);
      const inside = bins.whole ? 0.5 : 0; // the bars of whole numbers begin between two of them
      const [from, to] = [bins.edges[i] + inside, bins.edges[i + 1] - inside].map((edge) => this.written(edge, bins.decimals));
      const bar = from === to ? from : `${from} to ${bins.whole ? "" : "below "}${to}`;
      const percent = styled(((100 * bins.counts[i]) / trials).toFixed(2));
      return `${bar}${unit}: ${countedText(bins.counts[i], "trial")}, ${percent} %`;
    }
    const reverse = this.state.view === "reverse";
    const { count } = reverse ? this.trials.between(value, Infinity) : this.trials.between(-Infinity, value);
    const share = percentText(shareOf(count, trials, this.z));
    return `${reverse ? "From" : "Up to"} ${this.written(value, this.decimals)}${unit}: ${share} %`;
  }

  /** What the lines stand for. */
  legend() {
    const { units } = this.forecast;
    const lines = { "Mean": "—", "Base case": "– –", "Threshold": "····" };
    const unit = units ? ` ${units}` : "";
    const said = this.marks().map(({ label, text }) => `${lines[label] ?? "· ·"} ${label} ${text}${unit}`);
    return [...said, ...(this.second ? ["purple – – Second run"] : [])].join("    ");
  }
}
