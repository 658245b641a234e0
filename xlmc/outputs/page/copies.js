"use strict";
// Every table can be copied, and every chart saved as a picture.

const Copies = {
  /** @param {ParentNode} root */
  start(root = document) {
    for (const table of root.querySelectorAll(root === document ? "main table" : "table")) {
      const copied = Copies.button("Copy table", (button) => Copies.say(button, Copies.copy(table)));
      table.before(Copies.row(copied, Copies.button("Save table", () => Copies.saveTable(table))));
    }
    for (const drawn of root.querySelectorAll("svg.drawn")) {
      const saved = () => Copies.save(Copies.standalone(drawn), Copies.name(drawn, "svg"));
      drawn.after(Copies.pictureRow(saved, () => Copies.painted(drawn)));
    }
    Copies.charts(root);
  },

  /** Buttons below the charts that are drawn already. */
  charts(root) {
    for (const chart of root.querySelectorAll(".chart:has(canvas)")) {
      const canvas = () => Copies.onWhite(chart.querySelector("canvas"));
      const saved = () => canvas().toBlob((picture) => Copies.save(picture, Copies.name(chart, "png")));
      chart.after(Copies.pictureRow(saved, async () => canvas()));
    }
  },

  pictureRow(saved, canvas) {
    const copied = (button) => Copies.say(button, Copies.copyPicture(canvas));
    return Copies.row(Copies.button("Copy picture", copied), Copies.button("Save picture", saved));
  },

  row(...buttons) {
    const made = document.createElement("div");
    made.className = "copies";
    made.append(...buttons);
    return made;
  },

  button(label, act) {
    const made = document.createElement("button");
    made.type = "button";
    made.className = "copy";
    made.textContent = label;
    made.addEventListener("click", () => act(made));
    return made;
  },

  /** On the button, for a moment, whether something was copied. */
  async say(button, done) {
    const label = button.textContent;
    button.textContent = (await done) ? "Copied" : "Copying is not allowed here";
    setTimeout(() => { button.textContent = label; }, 2000);
  },

  /** Into the clipboard as a table, which Excel and Word take as one. */
  async copy(table) {
    const selection = getSelection();
    selection.selectAllChildren(table);
    const done = document.execCommand("copy");
    selection.removeAllRanges();
    return done;
  },

  /** Into the clipboard as a picture; whether the browser allows that. */
  async copyPicture(canvas) {
    try {
      const drawn = await canvas();
      const picture = new Promise((resolve) => { drawn.toBlob(resolve, "image/png"); });
      await navigator.clipboard.write([new ClipboardItem({ "image/png": picture })]);
      return true;
    } catch {
      return false;
    }
  },

  /** What the table shows, as a file that spreadsheet programs open. */
  saveTable(table) {
    const quoted = (text) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
    const lines = Copies.grid(table).map((line) => line.map(quoted).join(","));
    const mark = "\ufeff"; // by it Excel knows that the text is UTF-8
    Copies.save(new Blob([mark + lines.join("\r\n"), "\r\n"], { type: "text/csv" }), Copies.name(table, "csv"));
  },

  /** The texts of a table's cells, line by line; that of a cell which several lines share stands in each. */
  grid(table) {
    const shared = [];
    return [...table.rows].map((row) => {
      const cells = [...row.cells], line = [];
      while (cells.length || shared[line.length]?.left) {
        const above = shared[line.length];
        if (above?.left) {
          above.left -= 1;
          line.push(above.text);
        } else {
          const cell = cells.shift(), text = cell.innerText.trim().replace(/\u00a0(?!\d{3}(?!\d))/g, " ");
          if (cell.rowSpan > 1) shared[line.length] = { left: cell.rowSpan - 1, text };
          line.push(text, ...Array(cell.colSpan - 1).fill(""));
        }
      }
      return line;
    });
  },

  /** A drawing on a canvas of twice its size. */
  async painted(drawn) {
    const picture = new Image();
    picture.src = `data:image/svg+xml,${encodeURIComponent(await Copies.standalone(drawn).text())}`;
    await picture.decode();
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [2 * picture.width, 2 * picture.height];
    canvas.getContext("2d").drawImage(picture, 0, 0, canvas.width, canvas.height);
    return Copies.onWhite(canvas);
  },

  /** A drawing with the styles of this page that it needs. */
  standalone(drawn) {
    const copied = drawn.cloneNode(true);
    const { width, height } = drawn.viewBox.baseVal;
    copied.setAttribute("xmlns", "http://www.w3.org/2000/svg");
    copied.setAttribute("width", width);
    copied.setAttribute("height", height);
    const rules = [...document.styleSheets].flatMap((sheet) => [...sheet.cssRules])
      .filter((rule) => rule instanceof CSSStyleRule && /:root|\.drawn/.test(rule.selectorText)).map((rule) => rule.cssText);
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
    const what = place.matches("svg") ? place.getAttribute("aria-label")?.split(":")[0] : place.matches("table") ? "" : "chart";
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
