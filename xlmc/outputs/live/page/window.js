"use strict";
// The window begins here: what the server says goes to the left and the right side.

const LEAST_TRIALS = 50000;

const Live = {
  moves: new Map(), // number of a change -> when its event happened
  latencies: [], // milliseconds from an event to the frame that shows its answer
  firsts: [], // likewise, of answers from fewer trials

  start() {
    const path = location.pathname.replace("/book/", "/live/");
    this.wire = new Wire(path, (message) => this.heard(message), (open) => this.stands(open), (why) => this.over(why));
    this.left = new LeftSide(this.wire, (seq, event) => { if (event) this.moves.set(seq, event.timeStamp); });
    this.right = new RightSide(this.wire);
    const say = (id, message) => document.getElementById(id).addEventListener("click", () => this.wire.say(message));
    document.getElementById("skip").addEventListener("click", () => document.getElementById(`tab-${this.right.tab}`).focus());
    const top = /** @type {HTMLElement} */ (document.querySelector(".top"));
    new ResizeObserver(() => document.documentElement.style.setProperty("--top", `${top.offsetHeight}px`)).observe(top);
    say("undo", { kind: "undo" });
    say("redo", { kind: "redo" });
    document.addEventListener("keydown", (event) => this.press(event));
    say("stop", { kind: "stop" });
    say("pin", { kind: "pin" });
    say("reset", { kind: "reset", of: "assumption", name: "" });
  },

  /** Ctrl+Z undoes, Ctrl+Y and Ctrl+Shift+Z redo; in a box whose text was not taken yet they are the box's own. */
  press(event) {
    const key = event.key.toLowerCase();
    const { target } = event;
    if (!(event.ctrlKey || event.metaKey) || event.altKey || !["z", "y"].includes(key)) return;
    if (target.matches?.("input[type=text], input[type=search]") && target.value !== target.dataset.shown) return;
    event.preventDefault();
    const button = document.getElementById(key === "y" || event.shiftKey ? "redo" : "undo");
    if (!this.left.isHeld) button.click();
  },

  stands(open) {
    document.body.classList.toggle("away", !open);
    if (!open) this.stand("The connection is lost; trying again. Nothing is lost.");
  },

  /** The program has ended: nothing is taken any more, and what was answered stays. */
  over(why) {
    document.body.classList.add("away", "over");
    for (const each of document.querySelectorAll("#left, #offer, header .actions, #panel-scenarios, #panel-studies")) {
      /** @type {HTMLElement} */ (each).inert = true;
    }
    this.stand(why ?? "xlmc has ended: changes are not taken any more. Scenarios are kept; type xlmc open to go on.");
  },

  stand(text) {
    document.getElementById("stand").textContent = text;
  },

  heard(message) {
    this[`on_${message.kind}`]?.(message);
  },

  on_book(message) {
    document.getElementById("book").textContent = message.name;
    document.title = `${message.name}: live`;
    this.settings = message.settings;
    Object.assign(SIGNS, message.signs);
    this.left.book(message);
    this.right.book(message);
  },

  on_state(message) {
    this.state = message;
    this.left.state(message);
    this.right.state(message);
    const changed = message.changes.length;
    const off = { reset: !changed && !message.run.changed, undo: !message.undo, redo: !message.redo };
    for (const [id, disabled] of Object.entries(off)) document.getElementById(id).toggleAttribute("disabled", disabled);
    this.offer(message.offered);
  },

  on_moved(message) {
    this.left.moved(message);
  },

  on_frame(message) {
    this.right.frame(message);
    this.left.reshape(message.shapes);
    const run = `${countedText(message.trials, "trial")}, ${countText(message.accepted)} accepted (${message.share})`;
    const few = message.few ? ": too few for an answer" : "";
    this.standing = message.stage === "rest" ? `Done: ${run}${few}` : `Refining: ${run} so far${few}`;
    document.body.classList.toggle("few", message.few);
    this.ended();
    document.body.dataset.stage = message.stage;
    document.body.dataset.version = String(message.version);
    this.measure(message);
  },

  /** What was running is over: say again what the charts are of. */
  ended() {
    const faulty = document.body.classList.contains("faulty");
    this.stand(faulty ? "This state is not possible: the answers are of the state before" : this.standing ?? "");
    document.getElementById("stop").hidden = true;
  },

  on_rest(message) {
    this.left.rest(message);
    this.right.rest(message);
  },

  on_part(message) {
    this.right.part(message);
    this.ended();
  },

  on_others(message) {
    this.right.hand.others(message);
  },

  on_page(message) {
    this.right.hand.page(message);
  },

  on_study(message) {
    this.right.hand.study(message);
  },

  on_running({ stage, share }) {
    this.ended();
    if (stage === "over") return;
    document.getElementById("stop").hidden = stage === "stopped" || share >= 1;
    const of = { compare: "the scenarios", part: "this tab" }[stage] ?? "the trials";
    this.stand(stage === "stopped" ? "Stopped" : `Running: ${Math.round(100 * share)} % of ${of}`);
  },

  on_trouble({ about, text }) {
    const place = document.getElementById("troubles");
    [...place.children].find((each) => each.dataset.about === about)?.remove();
    if (text) place.append(make("p", { class: "warning", "data-about": about, text }));
    if (about !== "state") return;
    document.body.classList.toggle("faulty", Boolean(text));
    this.ended();
  },

  on_news({ text }) {
    const place = document.getElementById("news");
    const close = make("button", { type: "button", class: "close", text: "Close" });
    const line = make("p", { class: "notice" }, named(text), " ", close);
    close.addEventListener("click", () => line.remove());
    place.prepend(line);
    while (place.children.length > 3) place.lastElementChild.remove();
  },

  /** What was set when the window was last closed, and not kept as a scenario. */
  offer(changes) {
    const place = document.getElementById("offer");
    const answer = (take) => () => this.wire.say({ kind: "restore", take });
    place.replaceChildren(...(changes.length ? [make("p", { class: "notice" },
      "When the window was last closed, this was changed: ", named(changes.join("; ")), " ",
      make("button", { type: "button", text: "Bring it back", on: { click: answer(true) } }), " ",
      make("button", { type: "button", text: "Forget it", on: { click: answer(false) } }))] : []));
  },

  /** From the event of a move to the frame in which its answer is drawn; first short runs of a slow workbook apart. */
  measure({ seq, trials, stage }) {
    const began = this.moves.get(seq);
    const short = trials < LEAST_TRIALS && stage !== "rest";
    if (!short) for (const each of this.moves.keys()) if (each <= seq) this.moves.delete(each);
    if (began === undefined) return;
    requestAnimationFrame(() => (short ? this.firsts : this.latencies).push(performance.now() - began));
  },
};

Live.start();
