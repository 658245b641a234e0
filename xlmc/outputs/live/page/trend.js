"use strict";
// The ranges of all charts that are shown, side by side: those of one unit on one axis.

/** The parts of a row: where the central range, the 5th and the 95th percentile and the median of a forecast lie. */
function trendOf({ forecast, trials }) {
  return {
    name: forecast.name,
    range: [forecast.range.low, forecast.range.high],
    tails: [trials.quantile(0.05), trials.quantile(0.95)],
    median: trials.quantile(0.5),
    text: `${forecast.range.lowText} to ${forecast.range.highText}${forecast.units ? ` ${forecast.units}` : ""}`,
  };
}

/** Panels whose quantities lie on one axis, of which there are two at least: lists of them. */
function onOneAxis(panels) {
  const groups = new Map();
  for (const panel of panels) {
    const { units, form } = panel.forecast;
    const key = [units, Boolean(form.moment), form.moment === "span", form.factor, form.before, form.after].join("\n");
    groups.set(key, [...(groups.get(key) ?? []), panel]);
  }
  return [...groups.values()].filter((group) => group.length > 1);
}

/** Where an axis begins and ends that has room for all rows. */
function trendAxis(rows) {
  const ends = rows.flatMap(({ range, tails }) => [...range, ...tails]);
  const [low, high] = [Math.min(...ends), Math.max(...ends)];
  const room = 0.04 * (high - low) || Math.abs(low) * 0.1 || 1;
  return [low - room, high + room];
}

class TrendView {
  constructor(name) {
    this.body = make("div");
    this.root = make("section", { class: "trend", hidden: true, "data-name": name }, make("h3", { text: "Ranges side by side" }),
      make("p", { class: "remark", text: "Bar: central range; line: from the 5th to the 95th percentile; tick: median." }), this.body);
  }

  show(panels) {
    const groups = onOneAxis(panels);
    this.root.hidden = !groups.length;
    this.body.replaceChildren(...groups.map((group) => this.table(group)));
  }

  table(group) {
    const rows = group.map(trendOf);
    const [from, to] = trendAxis(rows);
    const at = (value) => ((100 * (value - from)) / (to - from)).toFixed(2);
    const row = ({ name, range, tails, median, text }) => make("tr", {},
      make("th", { scope: "row" }, named(name), make("br"), make("small", { text })),
      make("td", { class: "plotted" }, makeSvg("svg", { viewBox: "0 0 100 16", preserveAspectRatio: "none", "aria-hidden": "true" },
        makeSvg("path", { class: "tails", d: `M${at(tails[0])} 8H${at(tails[1])}` }),
        makeSvg("path", { class: "range", d: `M${at(range[0])} 3H${at(range[1])}V13H${at(range[0])}Z` }),
        makeSvg("path", { class: "median", d: `M${at(median)} 1V15` }))));
    const [{ decimals, forecast }] = group;
    const end = (value) => make("span", { text: formText(value, decimals, forecast.form) });
    return make("table", {}, make("tbody", {}, ...rows.map(row)),
      make("tfoot", {}, make("tr", {}, make("td"), make("td", {}, make("p", { class: "ends" }, end(from), end(to))))));
  }
}
