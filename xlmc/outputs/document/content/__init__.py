"""What the sections of a run say, as blocks, which all outputs write: `document.sections` has their rows."""
