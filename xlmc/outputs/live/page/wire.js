"use strict";
// The connection to the server, which comes back by itself after a sleep or a pause, until the program has ended.

const UNKNOWN = 4401; // another server listens there now, or the link is used up
const ENDED_BY = [1012, UNKNOWN]; // the server ends, or does not know this page
const REFUSED_BY = { 4404: "There is no such workbook here any more.", 4429: "Too many windows are open; close one, and load this page again." };
const MOST_TRIES = 3; // on this machine a connection that is refused means that nothing listens any more

class Wire {
  /**
   * `heard(message)` takes what the server says; `stands(open)` hears whether there is a connection; `ended(why)` hears
   * that there will be none any more: a text if there never was one.
   */
  constructor(path, heard, stands, ended) {
    this.path = path;
    this.heard = heard;
    this.stands = stands;
    this.ended = ended;
    this.seq = 0;
    this.delay = 250;
    this.tries = 0;
    this.over = false;
    this.waiting = [];
    if (Entry.known()) this.connect();
    else this.end(Entry.refusal(false));
    addEventListener("online", () => this.again());
    document.addEventListener("visibilitychange", () => this.again());
  }

  connect() {
    const socket = new WebSocket(`ws://${location.host}${this.path}`);
    this.socket = socket;
    this.entered = false;
    socket.addEventListener("open", async () => {
      if (!(await Entry.enter(socket))) return; // its end is heard below
      this.entered = true;
      this.delay = 250;
      this.tries = 0;
      socket.addEventListener("message", ({ data }) => this.heard(JSON.parse(data)));
      for (const text of this.waiting.splice(0)) socket.send(text);
      this.stands(true);
    });
    socket.addEventListener("close", ({ code }) => {
      if (this.socket !== socket) return;
      this.tries += 1;
      if (code in REFUSED_BY || ENDED_BY.includes(code) || this.tries > MOST_TRIES) {
        this.end(code === UNKNOWN && Entry.code ? Entry.refusal(true) : REFUSED_BY[code]);
        return;
      }
      this.entered = false;
      this.stands(false);
      this.timer = setTimeout(() => this.connect(), this.delay);
      this.delay = Math.min(2 * this.delay, 5000);
    });
  }

  end(why) {
    this.over = true;
    this.ended(why);
  }

  /** Do not wait for the next try where something says that it would work now. */
  again() {
    if (this.over || document.hidden || this.socket.readyState <= WebSocket.OPEN) return;
    clearTimeout(this.timer);
    this.connect();
  }

  /** What is said while there is no connection is said when there is one. */
  say(message) {
    const text = JSON.stringify(message);
    if (this.entered && this.socket.readyState === WebSocket.OPEN) this.socket.send(text);
    else if (!this.over) this.waiting.push(text);
  }

  /** Set a number or a switch; gives the number of the change, which comes back with the answer to it. */
  set(of, name, key, value, held) {
    this.seq += 1;
    this.say({ kind: "set", of, name, key, value, held, seq: this.seq });
    return this.seq;
  }
}
