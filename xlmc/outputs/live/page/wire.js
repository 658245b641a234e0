"use strict";
// The connection to the server, which comes back by itself after a sleep or a pause, until the program has ended.

const ENDED_BY = [1012, 4401]; // the server ends; another one listens there now, and does not know this page
const MOST_TRIES = 3; // on this machine a connection that is refused means that nothing listens any more

class Wire {
  /**
   * `heard(message)` takes what the server says; `stands(open)` hears whether there is a connection; `ended()` hears
   * that there will be none any more.
   */
  constructor(key, page, heard, stands, ended) {
    Object.assign(this, { key, page, heard, stands, ended, seq: 0, delay: 250, tries: 0, over: false, waiting: [] });
    this.connect();
    addEventListener("online", () => this.again());
    document.addEventListener("visibilitychange", () => this.again());
  }

  connect() {
    const socket = new WebSocket(`ws://${location.host}/live/${this.key}`);
    this.socket = socket;
    socket.addEventListener("open", () => {
      this.delay = 250;
      this.tries = 0;
      socket.send(JSON.stringify({ kind: "hello", page: this.page }));
      for (const text of this.waiting.splice(0)) socket.send(text);
      this.stands(true);
    });
    socket.addEventListener("message", ({ data }) => this.heard(JSON.parse(data)));
    socket.addEventListener("close", ({ code }) => {
      if (this.socket !== socket) return;
      this.tries += 1;
      if (ENDED_BY.includes(code) || this.tries > MOST_TRIES) {
        this.over = true;
        this.ended();
        return;
      }
      this.stands(false);
      this.timer = setTimeout(() => this.connect(), this.delay);
      this.delay = Math.min(2 * this.delay, 5000);
    });
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
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(text);
    else if (!this.over) this.waiting.push(text);
  }

  /** Set a number or a switch; gives the number of the change, which comes back with the answer to it. */
  set(of, name, key, value, held) {
    this.seq += 1;
    this.say({ kind: "set", of, name, key, value, held, seq: this.seq });
    return this.seq;
  }
}
