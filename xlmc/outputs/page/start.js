"use strict";
// Everything begins here, once the page has been read.

(function start() {
  const { z, forecasts, overlays } = JSON.parse(document.getElementById("payload").textContent);
  const places = [...document.querySelectorAll(".forecast")];
  const panels = places.map((place) => new Panel(place, forecasts[Number(place.dataset.forecast)], z));
  for (const place of document.querySelectorAll(".overlay")) {
    new Overlay(place, overlays[Number(place.dataset.overlay)].map((i) => panels[i]));
  }
  document.documentElement.classList.add("ready");

  Copies.start();

  // On paper stands what the lines of a chart mean, not what the pointer is at.
  addEventListener("beforeprint", () => panels.forEach((panel) => panel.read(null)));

  // What is open is printed, too.
  for (const button of document.querySelectorAll("button[data-all]")) {
    button.addEventListener("click", () => {
      for (const each of document.querySelectorAll("details")) each.open = button.dataset.all === "open";
    });
  }
})();
