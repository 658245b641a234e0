"""The list of commands, each with all of its first sentence; an unknown one is answered with the nearest."""

from __future__ import annotations

import click

from xlmc.cli.near import did_you_mean

__all__ = ["Commands"]

_BOOKS = (".xlsx", ".xlsm", ".xltx", ".xltm")


class Commands(click.Group):
    """xlmc's commands, in the order in which a person needs them."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Names, in the order in which they were added."""
        return list(self.commands)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the list; what is long wraps."""
        rows = [(name, self.commands[name].get_short_help_str(limit=1_000)) for name in self.list_commands(ctx)]
        with formatter.section("Commands"):
            formatter.write_dl(rows)

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """The command that the first argument names.

        Raises:
            UsageError: it names none.
        """
        typed = args[0]
        if typed not in self.commands and not typed.startswith("-"):
            near = did_you_mean(typed, self.commands)
            if typed.casefold().endswith(_BOOKS):
                near = f" To run that workbook, type: xlmc simulate {typed}"
            raise click.UsageError(f"there is no command {typed!r}.{near}", ctx)
        return super().resolve_command(ctx, args)
