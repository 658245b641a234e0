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

  // On paper everything is open; afterwards as it was.
  let closed = [];
  addEventListener("beforeprint", () => {
    closed = [...document.querySelectorAll("details:not([open])")];
    for (const each of closed) each.open = true;
  });
  addEventListener("afterprint", () => {
    for (const each of closed) each.open = false;
  });
})();
