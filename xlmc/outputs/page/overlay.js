"use strict";
// Forecasts of one unit in one chart, told apart by colour and by dashes.

// Okabe and Ito's colours, which people with any colour vision tell apart: https://jfly.uni-koeln.de/color/
const COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#000000"];
const DASHES = [[], [8, 4], [2, 3], [10, 3, 2, 3]];

class Overlay {
  constructor(element, panels) {
    this.element = element.querySelector(".chart");
    this.panels = panels;
    this.view = "frequency";
    for (const radio of element.querySelectorAll(".views input")) {
      radio.addEventListener("change", () => {
        this.view = radio.value;
        this.draw();
      });
    }
    element.querySelector(".legend").replaceChildren(...panels.map(({ forecast }, i) => legendEntry(forecast.name, i)));
    new ResizeObserver(() => {
      if (this.chart.width !== widthOf(this.element)) this.draw();
    }).observe(this.element);
    this.draw();
  }

  draw() {
    this.chart?.destroy();
    const edges = this.panels.flatMap(({ bins }) => [bins.edges[0], bins.edges.at(-1)]);
    const ends = [Math.min(...edges), Math.max(...edges)];
    const shapes = this.panels.map((panel) => this.shape(panel, ends));
    const top = this.view === "frequency" ? 1.08 * Math.max(...shapes.flat().map(([, y]) => y)) : 100;
    const { forecast, forecast: { units } } = this.panels[0];
    const options = chartOptions(widthOf(this.element), ends, top, forecast, this.view);
    if (this.view === "frequency") {
      options.axes[1].label = `Accepted trials, % per ${units || "unit"}`;
      options.axes[1].values = (_, splits) => splits.map((split) => shortText(split, 6));
    }
    options.hooks = { draw: [(chart) => shapes.forEach((shape, i) => trace(chart, shape, COLOURS[i % COLOURS.length], DASHES[i % DASHES.length]))] };
    this.chart = new uPlot(options, [ends, [0, top]], this.element);
  }

  /** Bars as a share of the trials for each unit, so that forecasts with other bars compare; or the curve. */
  shape({ forecast, trials, bins }, ends) {
    if (this.view !== "frequency") return curve(trials, ends, this.view);
    const { edges, counts, width } = bins;
    const heights = counts.map((count) => (100 * count) / forecast.trials / width);
    return [[edges[0], 0], ...bars(edges, heights), [edges.at(-1), 0]];
  }
}

function legendEntry(name, i) {
  const entry = document.createElement("li");
  const line = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  const path = document.createElementNS("http://www.w3.org/2000/svg", "path");
  line.setAttribute("width", "36");
  line.setAttribute("height", "10");
  path.setAttribute("d", "M0 5H36");
  path.setAttribute("stroke", COLOURS[i % COLOURS.length]);
  path.setAttribute("stroke-width", "2.5");
  path.setAttribute("stroke-dasharray", DASHES[i % DASHES.length].join(" "));
  line.append(path);
  const label = document.createElement("bdi");
  label.textContent = name;
  entry.append(line, label);
  return entry;
}
