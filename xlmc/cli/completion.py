"""`xlmc completion`: what makes a shell complete commands and options."""

from __future__ import annotations

import click

from xlmc.cli.options import OneOf
from xlmc.cli.terminal import put

__all__ = ["completion"]


@click.command()
@click.argument("shell", type=OneOf("bash", "zsh", "fish"))
@click.pass_context
def completion(context: click.Context, shell: str) -> None:
    """Print what makes SHELL complete commands and options when you press Tab.

    Add it to your shell once: xlmc completion bash >> ~/.bashrc, xlmc completion zsh >> ~/.zshrc, or xlmc completion
    fish > ~/.config/fish/completions/xlmc.fish; then open a new terminal.
    """
    from click.shell_completion import get_completion_class

    result = get_completion_class(shell)
    assert result is not None  # the shells are those that click knows
    put(result(context.find_root().command, {}, "xlmc", "_XLMC_COMPLETE").source() + "\n")
