"use strict";
// Charts are drawn with two points a pixel or more, so that they print sharply. The property is there to be replaced:
// https://drafts.csswg.org/cssom-view/#dom-window-devicepixelratio
window.devicePixelRatio = Math.max(2, window.devicePixelRatio);
