"use strict";
// A chart as vectors: it is painted once more, and every line, area and text that the canvas is asked for is also
// written as an element of an SVG. The charts of uPlot are painted by few methods of a canvas, and these are all here.

/** A path that remembers its parts. */
class HeardPath extends Path2D {
  constructor(...given) {
    super(...given);
    this.heard = [];
  }
}
for (const name of ["moveTo", "lineTo", "closePath", "rect", "arc"]) {
  HeardPath.prototype[name] = function hear(...given) {
    this.heard.push([name, ...given]);
    return Object.getPrototypeOf(HeardPath.prototype)[name].apply(this, given);
  };
}

/** Listens to what a canvas is asked to paint, in the pixels of the screen. */
class Vectors {
  constructor(context) {
    this.context = context;
    this.made = [];
    this.clips = [];
    this.path = "";
    this.clipping = [""];
    this.scale = devicePixelRatio;
  }

  /** Listen while `paint` runs. */
  async during(paint) {
    const { context } = this;
    const heard = ["save", "restore", "beginPath", "moveTo", "lineTo", "closePath", "rect", "arc", "clip", "fill", "stroke",
      "fillRect", "strokeRect", "fillText"];
    for (const name of heard) {
      context[name] = (...given) => {
        this[name](...given);
        return CanvasRenderingContext2D.prototype[name].apply(context, given);
      };
    }
    const { Path2D } = window;
    window.Path2D = HeardPath;
    try {
      await paint();
    } finally {
      window.Path2D = Path2D;
      for (const name of heard) delete context[name];
    }
  }

  save() { this.clipping.push(this.clipping.at(-1)); }

  restore() { if (this.clipping.length > 1) this.clipping.pop(); }

  beginPath() { this.path = ""; }

  moveTo(x, y) { this.path += `M${this.at(x, y)}`; }

  lineTo(x, y) { this.path += `${this.path ? "L" : "M"}${this.at(x, y)}`; }

  closePath() { this.path += "Z"; }

  rect(x, y, width, height) {
    this.path += `M${this.at(x, y)}L${this.at(x + width, y)}L${this.at(x + width, y + height)}L${this.at(x, y + height)}Z`;
  }

  arc(x, y, radius) {
    const size = this.short(radius / this.scale);
    this.path += `M${this.at(x - radius, y)}A${size} ${size} 0 1 0 ${this.at(x + radius, y)}A${size} ${size} 0 1 0 `
      + `${this.at(x - radius, y)}Z`;
  }

  /** Clips add up: one within another is an intersection. */
  clip() {
    const id = Numbered.id("clip");
    this.clips.push(makeSvg("clipPath", { id, ...this.clipped() }, makeSvg("path", { d: this.path })));
    this.clipping[this.clipping.length - 1] = id;
  }

  fill(path) {
    this.add("path", { d: this.pathOf(path), fill: this.context.fillStyle });
  }

  stroke(path) {
    this.add("path", { d: this.pathOf(path), fill: "none", ...this.pen() });
  }

  /** The path that was given, or the one that was begun. */
  pathOf(path) {
    if (!(path instanceof HeardPath)) return this.path;
    const before = this.path;
    this.path = "";
    for (const [name, ...given] of path.heard) this[name](...given);
    const found = this.path;
    this.path = before;
    return found;
  }

  fillRect(...given) {
    const before = this.path;
    this.path = "";
    this.rect(...given);
    this.add("path", { d: this.path, fill: this.context.fillStyle });
    this.path = before;
  }

  strokeRect(...given) {
    const before = this.path;
    this.path = "";
    this.rect(...given);
    this.add("path", { d: this.path, fill: "none", ...this.pen() });
    this.path = before;
  }

  fillText(text, x, y) {
    const { fillStyle, font, textAlign, textBaseline } = this.context;
    const { a, b, c, d, e, f } = this.context.getTransform();
    const [size, family] = [parseFloat(font.match(/([\d.]+)px/)[1]) / this.scale, font.replace(/^.*?px\s*/, "")];
    const anchor = { center: "middle", right: "end", end: "end" }[textAlign] ?? "start";
    // A baseline in figures, which programs that draw on SVG know better than its names.
    const lower = { top: 0.8, hanging: 0.8, middle: 0.35, bottom: -0.2, ideographic: -0.2 }[textBaseline] ?? 0;
    const [left, top] = [x / this.scale, y / this.scale + lower * size];
    const turned = [a, b, c, d, e / this.scale, f / this.scale].map((part) => this.short(part)).join(" ");
    const made = makeSvg("text", { x: this.short(left), y: this.short(top), fill: fillStyle, "font-size": this.short(size),
      "font-family": family, "text-anchor": anchor, transform: `matrix(${turned})`, ...this.clipped() });
    made.textContent = text;
    this.made.push(made);
  }

  pen() {
    const { strokeStyle, lineWidth, lineJoin, lineCap } = this.context;
    const dash = this.context.getLineDash().map((part) => this.short(part / this.scale)).join(" ");
    return { stroke: strokeStyle, "stroke-width": this.short(lineWidth / this.scale), "stroke-linejoin": lineJoin,
      "stroke-linecap": lineCap, ...(dash ? { "stroke-dasharray": dash } : {}) };
  }

  clipped() {
    return this.clipping.at(-1) ? { "clip-path": `url(#${this.clipping.at(-1)})` } : {};
  }

  add(tag, attributes) {
    if (!attributes.d) return;
    const { globalAlpha } = this.context;
    this.made.push(makeSvg(tag, { ...attributes, ...(globalAlpha < 1 ? { opacity: globalAlpha } : {}), ...this.clipped() }));
  }

  /** A point as it lies on the canvas, in the pixels of the page. */
  at(x, y) {
    const { a, b, c, d, e, f } = this.context.getTransform();
    return `${this.short((a * x + c * y + e) / this.scale)} ${this.short((b * x + d * y + f) / this.scale)}`;
  }

  short(number) {
    return Number(number.toFixed(2));
  }

  /** All of it as an SVG with a name and a white ground. */
  picture(title, width, height) {
    const named = makeSvg("title", {});
    named.textContent = title;
    return makeSvg("svg", { xmlns: "http://www.w3.org/2000/svg", viewBox: `0 0 ${width} ${height}`, width, height },
      named, makeSvg("defs", {}, ...this.clips), makeSvg("rect", { width, height, fill: "#fff" }), ...this.made);
  }
}

/** Save a chart of uPlot as an SVG of lines, areas and texts. */
async function saveSvg(chart, place) {
  const { canvas } = chart.ctx;
  const vectors = new Vectors(chart.ctx);
  await vectors.during(async () => {
    chart.redraw(false);
    await new Promise((done) => { setTimeout(done); }); // uPlot paints in a microtask
  });
  const title = place.getAttribute("aria-label") ?? "";
  const made = vectors.picture(title, canvas.width / devicePixelRatio, canvas.height / devicePixelRatio);
  const text = new XMLSerializer().serializeToString(made);
  Copies.save(new Blob([text], { type: "image/svg+xml" }), Copies.name(place, "svg"));
  return text;
}
