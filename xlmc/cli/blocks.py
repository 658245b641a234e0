"""Blocks on the terminal: paragraphs, and tables that fit its width. Charts are described in words; files draw them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from xlmc.cli.terminal import paragraph, say

if TYPE_CHECKING:
    from xlmc.outputs.document.parts import Block

__all__ = ["show"]


def show(blocks: Iterable[Block]) -> None:
    """Print blocks, with a line of space around each heading and table."""
    from xlmc.cli.printing import heading, table
    from xlmc.outputs.document.parts import Bullets, Code, Figure, Heading, Paragraph, cell_text

    spaced, title = True, ""
    for each in blocks:
        match each:
            case Paragraph(text, _):
                say(paragraph(text))
            case Bullets(texts, _):
                for text in texts:
                    say(paragraph(f"- {text}", hanging="  "))
            case Code(text):
                say(text)
            case Heading(text, _):
                if not spaced:
                    say()
                heading(text)
            case Figure(_, caption):
                say(paragraph(f"Drawn in files: {caption}"))
            case _:
                if not spaced:
                    say()
                title = each.title or each.caption.removesuffix(".")
                rows = [[cell_text(cell) for cell in row] for row in each.rows]
                table(title, each.heads, rows, right=sorted(each.at_right))
        spaced = not isinstance(each, Paragraph | Bullets | Code | Figure)
