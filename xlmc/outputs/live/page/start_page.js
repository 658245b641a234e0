"use strict";
// The start page: books of the folder, those opened last, templates, and a place to drop a file.

const ENDED = "xlmc has ended; type xlmc open to go on.";

const Start = {
  start() {
    this.wire = new Wire("/start", (message) => this[message.kind](message), () => {}, (why) => this.trouble({ text: why ?? ENDED }));
    document.getElementById("file").addEventListener("change", ({ target }) => this.take(/** @type {HTMLInputElement} */ (target).files[0]));
    addEventListener("dragover", (event) => event.preventDefault());
    addEventListener("drop", (event) => {
      event.preventDefault();
      this.take(event.dataTransfer.files[0]);
    });
  },

  books(found) {
    this.list("books", found.books, ({ name, key }) => [this.link(name, key)]);
    this.list("recent", found.recent, ({ name, key, folder }) => [this.link(name, key), make("small", {}, " in ", named(folder))]);
    this.list("templates", found.templates, ({ name, key, question, editions }) => [
      this.copy(name, key), ...editions.flatMap((each) => [" ", this.copy(each.units, each.key, `${name}, ${each.units}`)]), ` ${question}`]);
    document.getElementById("folder").textContent = found.folder;
    if (found.trouble) this.trouble({ text: found.trouble });
  },

  open({ key }) {
    location.assign(`/book/${key}`);
  },

  list(id, rows, line) {
    const shown = rows.map((row) => make("li", {}, ...line(row)));
    document.getElementById(id).replaceChildren(...(shown.length ? shown : [make("li", { class: "remark", text: "none" })]));
  },

  copy(text, key, label = text) {
    return make("button", { type: "button", text, "aria-label": label, on: { click: () => this.wire.say({ kind: "copy", key }) } });
  },

  link(name, key) {
    return make("a", { href: `/book/${key}` }, named(name));
  },

  take(file) {
    if (!file) return;
    this.file = file;
    this.wire.say({ kind: "ticket" });
  },

  /** The server expects a file. */
  async ticket({ ticket }) {
    const { file } = this;
    try {
      const answer = await fetch(`/drop?name=${encodeURIComponent(file.name)}`, {
        method: "POST", headers: { "X-Xlmc-Ticket": ticket }, body: file });
      const found = await answer.json();
      if (found.key) this.open(found);
      else this.trouble({ text: found.trouble });
    } catch {
      this.trouble({ text: "The file could not be handed over: is xlmc still running?" });
    }
  },

  trouble({ text }) {
    document.getElementById("troubles").replaceChildren(make("p", { class: "warning", text }));
  },
};

Start.start();
