"use strict";
// The start page: books of the folder, those opened last, templates, and a place to drop a file.

const Start = {
  start() {
    const found = JSON.parse(document.getElementById("data").textContent);
    this.list("books", found.books, ({ name, key }) => [this.link(name, key)]);
    this.list("recent", found.recent, ({ name, key, folder }) => [this.link(name, key), make("small", {}, " in ", named(folder))]);
    this.list("templates", found.templates, ({ name, key, question }) => [
      make("button", { type: "button", text: name, on: { click: () => this.ask(`/open/${key}`, null) } }), ` ${question}`]);
    document.getElementById("folder").textContent = found.folder;
    if (found.trouble) this.trouble(found.trouble);
    document.getElementById("file").addEventListener("change", ({ target }) => this.take(target.files[0]));
    addEventListener("dragover", (event) => event.preventDefault());
    addEventListener("drop", (event) => {
      event.preventDefault();
      this.take(event.dataTransfer.files[0]);
    });
  },

  list(id, rows, line) {
    const shown = rows.map((row) => make("li", {}, ...line(row)));
    document.getElementById(id).replaceChildren(...(shown.length ? shown : [make("li", { class: "remark", text: "none" })]));
  },

  link(name, key) {
    return make("a", { href: `/book/${key}` }, named(name));
  },

  take(file) {
    if (file) this.ask(`/drop?name=${encodeURIComponent(file.name)}`, file);
  },

  async ask(address, body) {
    const headers = { "X-Xlmc-Page": document.body.dataset.page };
    try {
      const answer = await fetch(address, { method: "POST", headers, body });
      const found = await answer.json();
      if (found.open) location.assign(found.open);
      else this.trouble(found.trouble);
    } catch {
      this.trouble("The file could not be handed over: is xlmc still running?");
    }
  },

  trouble(text) {
    document.getElementById("troubles").replaceChildren(make("p", { class: "warning", text }));
  },
};

Start.start();
