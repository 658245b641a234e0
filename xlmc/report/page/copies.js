"use strict";
// Every table can be copied, and every chart saved as a picture.

const Copies = {
  start() {
    for (const table of document.querySelectorAll("main table")) {
      table.before(Copies.button("Copy table", (button) => Copies.copy(table, button)));
    }
    for (const drawn of document.querySelectorAll("svg.drawn")) {
      drawn.after(Copies.button("Save picture", () => Copies.save(Copies.standalone(drawn), Copies.name(drawn, "svg"))));
    }
    for (const chart of document.querySelectorAll(".chart")) {
      const saved = () => Copies.onWhite(chart.querySelector("canvas"))
        .toBlob((picture) => Copies.save(picture, Copies.name(chart, "png")));
      chart.after(Copies.button("Save picture", saved));
    }
  },

  button(label, act) {
    const made = document.createElement("button");
    made.type = "button";
    made.className = "copy";
    made.textContent = label;
    made.addEventListener("click", () => act(made));
    return made;
  },

  /** Into the clipboard as a table, which Excel and Word take as one. */
  copy(table, button) {
    const selection = getSelection();
    selection.selectAllChildren(table);
    const done = document.execCommand("copy");
    selection.removeAllRanges();
    button.textContent = done ? "Copied" : "Copying is not allowed here";
    setTimeout(() => { button.textContent = "Copy table"; }, 2000);
  },

  /** A drawing with the styles of this page that it needs. */
  standalone(drawn) {
    const copied = drawn.cloneNode(true);
    const { width, height } = drawn.viewBox.baseVal;
    copied.setAttribute("xmlns", "http://www.w3.org/2000/svg");
    copied.setAttribute("width", width);
    copied.setAttribute("height", height);
    const rules = [...document.styleSheets].flatMap((sheet) => [...sheet.cssRules])
      .filter((rule) => rule.selectorText && /:root|\.drawn/.test(rule.selectorText)).map((rule) => rule.cssText);
    const style = document.createElementNS("http://www.w3.org/2000/svg", "style");
    style.textContent = rules.join("\n");
    copied.prepend(style);
    return new Blob([new XMLSerializer().serializeToString(copied)], { type: "image/svg+xml" });
  },

  onWhite(canvas) {
    const made = document.createElement("canvas");
    [made.width, made.height] = [canvas.width, canvas.height];
    const context = made.getContext("2d");
    context.fillStyle = "#fff";
    context.fillRect(0, 0, made.width, made.height);
    context.drawImage(canvas, 0, 0);
    return made;
  },

  /** Named by the heading that it stands below, in letters that every system takes. */
  name(place, ending) {
    const part = place.closest("article, section");
    const what = place.matches("svg") ? place.getAttribute("aria-label")?.split(":")[0] : "chart";
    const said = [part?.querySelector("h2, h3")?.textContent, what];
    const plain = said.filter(Boolean).join(" ").replace(/[^\p{L}\p{N}]+/gu, "-").replace(/^-|-$/g, "");
    return `${plain.slice(0, 80) || "chart"}.${ending}`;
  },

  save(blob, name) {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(blob);
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  },
};
