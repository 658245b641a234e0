"use strict";
// Everything begins here, once the page has been read.

(function start() {
  const read = JSON.parse(document.getElementById("payload").textContent);
  if (typeof read === "string") Later.text(read).then((text) => begin(JSON.parse(text)));
  else begin(read);

  function begin({ z, signs, forecasts, overlays }) {
    Object.assign(SIGNS, signs);
    const places = [...document.querySelectorAll(".forecast")];
    const panels = [];
    const draw = (place) => panels.push(new Panel(place, forecasts[Number(place.dataset.forecast)], z));
    if (places.length < Later.many) places.forEach(draw);
    else {
      Later.index(places);
      Later.whenSeen(places, (place) => {
        draw(place);
        Copies.charts(place);
      });
    }
    for (const place of document.querySelectorAll(".overlay")) {
      new Overlay(place, overlays[Number(place.dataset.overlay)].map((i) => panels[i]));
    }
    document.documentElement.classList.add("ready");

    Later.start();
    Copies.start();

    // On paper stands what the lines of a chart mean, not what the pointer is at.
    addEventListener("beforeprint", () => panels.forEach((panel) => panel.read(null)));

    // What is open is printed, too.
    for (const button of document.querySelectorAll("button[data-all]")) {
      button.addEventListener("click", async () => {
        if (button.dataset.all === "open") await Later.openAll();
        for (const each of document.querySelectorAll("details")) each.open = button.dataset.all === "open";
      });
    }
  }
})();
