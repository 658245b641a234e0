"use strict";
// How a page and its server prove to each other that they know the key; neither ever says it.
// The key is that of the link's code, once, and then the secret that the server gives for it, which stays in this tab.

const Entry = {
  /** The link's code leaves the address before anything else happens. */
  take() {
    const [name, key] = location.hash.slice(1).split(".");
    if (location.hash) history.replaceState(null, "", location.pathname);
    this.code = key ? { name, key } : null;
  },

  /** What this tab can prove that it knows, or null. */
  known() {
    const secret = sessionStorage.getItem("xlmc");
    return this.code ?? (secret ? { name: "secret", key: secret } : null);
  },

  /** Whether both ends of a new connection have proved that they know the key. */
  async enter(socket) {
    const known = this.known();
    const nonce = hexadecimal(crypto.getRandomValues(new Uint8Array(32)));
    socket.send(JSON.stringify({ kind: "hello", name: known.name, nonce }));
    const theirs = await nextMessage(socket);
    if (theirs?.proof !== await this.proof(known.key, "server", nonce, theirs?.nonce)) {
      socket.close();
      return false;
    }
    socket.send(JSON.stringify({ kind: "proof", proof: await this.proof(known.key, "page", nonce, theirs.nonce) }));
    const welcome = await nextMessage(socket);
    if (welcome?.kind !== "welcome") return false;
    sessionStorage.setItem("xlmc", welcome.secret);
    this.code = null;
    return true;
  },

  async proof(key, end, pageNonce, serverNonce) {
    const bytes = (text) => new TextEncoder().encode(text);
    const how = { name: "HMAC", hash: "SHA-256" };
    const made = await crypto.subtle.importKey("raw", bytes(key), how, false, ["sign"]);
    return hexadecimal(new Uint8Array(await crypto.subtle.sign("HMAC", made, bytes([end, pageNonce, serverNonce].join(" ")))));
  },

  /** Why there is no window, in words; `hadCode`: the page came with a link's code. */
  refusal(hadCode) {
    return hadCode
      ? "This link was used already, or is older than a minute. Go on in the tab that has it, or type xlmc open again."
      : "Open the link that xlmc open has printed; another tab cannot use the address alone.";
  },
};

Entry.take();
addEventListener("hashchange", () => location.reload()); // a new link for a page that is open

function hexadecimal(bytes) {
  return Array.from(bytes, (each) => each.toString(16).padStart(2, "0")).join("");
}

/** The next message of a connection, or null if it ends. */
function nextMessage(socket) {
  return new Promise((done) => {
    socket.addEventListener("message", ({ data }) => done(JSON.parse(data)), { once: true });
    socket.addEventListener("close", () => done(null), { once: true });
  });
}
