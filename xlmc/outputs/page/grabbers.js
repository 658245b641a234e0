"use strict";
// The two ends of the certainty range, which are dragged or moved with the arrow keys.

const ARROWS = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -10, PageUp: 10 };

/**
 * Put a grabber on a chart. `grid` says, whenever it is asked, what the chart reaches from and to (`min`, `max`) and in
 * which `step` the grabber moves; `move(value)` is told where it wants to be. At the edge of the chart the end is open: it takes in the trials that are not drawn.
 *
 * Returns a function that puts it at a value, with a text beside it.
 */
function addGrabber(chart, which, label, grid, now, move) {
  const line = document.createElement("div");
  const grip = document.createElement("div");
  const tag = document.createElement("span");
  line.className = `grabber ${which}`;
  grip.className = "grip";
  tag.className = "tag";
  grip.tabIndex = 0;
  grip.setAttribute("role", "slider");
  grip.setAttribute("aria-label", label);
  line.append(grip, tag);
  chart.over.append(line);

  const snapped = (value) => Number((Math.round(value / grid.step) * grid.step).toPrecision(12));
  const placed = (value) => (value <= grid.min ? -Infinity : value >= grid.max ? Infinity : snapped(value));

  grip.addEventListener("pointerdown", (event) => {
    const away = event.clientX - grip.getBoundingClientRect().left - grip.offsetWidth / 2;
    const follow = (moved) => {
      const left = moved.clientX - away - chart.over.getBoundingClientRect().left;
      move(placed(chart.posToVal(left, "x")));
    };
    const letGo = () => {
      grip.removeEventListener("pointermove", follow);
      grip.removeEventListener("pointerup", letGo);
      grip.removeEventListener("pointercancel", letGo);
    };
    event.preventDefault();
    grip.focus({ preventScroll: true });
    grip.setPointerCapture(event.pointerId);
    grip.addEventListener("pointermove", follow);
    grip.addEventListener("pointerup", letGo);
    grip.addEventListener("pointercancel", letGo);
  });

  grip.addEventListener("keydown", (event) => {
    const steps = (ARROWS[event.key] ?? 0) * (event.shiftKey ? 10 : 1);
    if (steps) move(placed(Math.min(grid.max, Math.max(grid.min, now())) + steps * grid.step));
    else if (event.key === "Home") move(-Infinity);
    else if (event.key === "End") move(Infinity);
    else return;
    event.preventDefault();
  });

  return (value, text) => {
    const left = Math.min(chart.over.clientWidth, Math.max(0, chart.valToPos(value, "x")));
    line.style.left = `${value === -Infinity ? 0 : value === Infinity ? chart.over.clientWidth : left}px`;
    tag.textContent = text;
    keepWithin(tag, chart.root);
    grip.setAttribute("aria-valuemin", decimalText(grid.min));
    grip.setAttribute("aria-valuemax", decimalText(grid.max));
    grip.setAttribute("aria-valuenow", decimalText(Math.min(grid.max, Math.max(grid.min, value))));
    grip.setAttribute("aria-valuetext", text);
  };
}

/** Move an element sideways where it reaches beyond another one. */
function keepWithin(element, around) {
  element.style.translate = "";
  const [shown, room] = [element, around].map((each) => each.getBoundingClientRect());
  const away = Math.max(room.left - shown.left, 0) + Math.min(room.right - shown.right, 0);
  if (away) element.style.translate = `${away}px`;
}

/** The step that grabbers move in: a power of ten, at most a fifth of a bar; 1 where the trials are whole numbers. */
function stepOf({ width, whole }) {
  return whole ? 1 : Number(`1e${Math.floor(Math.log10(width / 5) + 1e-9)}`);
}
