"use strict";
// Elements made of names and texts: a text is never read as markup.

/**
 * An element with attributes, listeners (`on`) and children; a child that is a text becomes a text.
 * @param {string} tag
 * @param {Record<string, any>} [given]
 * @param {...(Node | string)} children
 * @returns {any}
 */
function make(tag, { on = {}, text = null, ...attributes } = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === true) made.setAttribute(name, "");
    else if (value !== null && value !== false) made.setAttribute(name, String(value));
  }
  for (const [event, heard] of Object.entries(on)) made.addEventListener(event, heard);
  if (text !== null) made.textContent = text;
  made.append(...children);
  return made;
}

/** A name from the workbook, which may be in a script that runs from right to left. */
function named(text) {
  return make("bdi", { text });
}

/**
 * The same for the parts of a drawing.
 * @param {string} tag
 * @param {Record<string, any>} [attributes]
 * @param {...Node} children
 * @returns {any}
 */
function makeSvg(tag, attributes = {}, ...children) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, String(value));
  made.append(...children);
  return made;
}

/** Numbers of elements that need one, so that names of elements differ. */
const Numbered = { next: 0, id: (what) => `${what}-${Numbered.next++}` };
