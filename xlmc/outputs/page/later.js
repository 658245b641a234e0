"use strict";
// What a large page opens only when it is asked for: packed parts, an index of forecasts, charts that come into view.

const Later = {
  /** From this number of forecasts on, they have an index, and charts are drawn when they are looked at. */
  many: 13,

  /** A text that was packed by gzip and written as base64. */
  async text(packed) {
    const bytes = Uint8Array.from(atob(packed), (letter) => letter.charCodeAt(0));
    return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).text();
  },

  start() {
    for (const button of document.querySelectorAll("button[data-packed]")) {
      button.addEventListener("click", () => Later.open(button));
    }
  },

  /** Put a packed section in the place of its button. */
  async open(button) {
    const made = document.createElement("template");
    made.innerHTML = await Later.text(button.dataset.packed);
    const section = made.content.firstElementChild;
    button.closest("section").replaceWith(section);
    Copies.start(section);
  },

  openAll() {
    return Promise.all([...document.querySelectorAll("button[data-packed]")].map(Later.open));
  },

  /** Call an action once for each place, when it comes into view or is printed. */
  whenSeen(places, act) {
    const waiting = new Set(places);
    const show = (place) => {
      seen.unobserve(place);
      if (waiting.delete(place)) act(place);
    };
    const seen = new IntersectionObserver((entries) => {
      entries.filter(({ isIntersecting }) => isIntersecting).forEach(({ target }) => show(target));
    }, { rootMargin: "400px" });
    places.forEach((place) => seen.observe(place));
    addEventListener("beforeprint", () => places.forEach(show));
  },

  /** A search over the forecasts, and a link to each. */
  index(places) {
    const label = document.createElement("label"), box = document.createElement("input"), list = document.createElement("p");
    label.append("Find a forecast ", box);
    box.type = "search";
    box.addEventListener("input", () => Later.find(places, list, box.value.trim().toLowerCase()));
    list.className = "index";
    for (const place of places) {
      const link = document.createElement("a"), name = place.querySelector("h3").textContent;
      link.href = "#forecasts";
      link.textContent = name;
      link.addEventListener("click", (event) => {
        event.preventDefault();
        place.scrollIntoView();
      });
      list.append(link, " ");
    }
    document.querySelector("#forecasts h2").after(label, list);
  },

  find(places, list, wanted) {
    places.forEach((place, number) => {
      const hidden = !place.querySelector("h3").textContent.toLowerCase().includes(wanted);
      place.hidden = hidden;
      list.children[number].hidden = hidden;
    });
  },
};
