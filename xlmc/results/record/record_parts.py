"""What a record is made of: sections of entries and tables, every one with a key that programs read it by.

Values are plain strings, numbers and logicals, so that a record can be written anywhere and read back.
"""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["Entry", "Record", "RecordTable", "Section", "Value"]

Value = str | int | float | bool | None
"""None where there is nothing to say: no units, no cutoff, no trial to take a mean of."""


@dataclass(frozen=True, slots=True)
class Entry:
    """One fact: a key for programs, a label for people."""

    key: str
    label: str
    value: Value


@dataclass(frozen=True, slots=True)
class RecordTable:
    """Facts of one kind, one a row. `columns` are (key, label); every row has a value for each."""

    columns: tuple[tuple[str, str], ...]
    rows: tuple[tuple[Value, ...], ...]

    def as_dicts(self) -> list[dict[str, Value]]:
        """The rows by column key."""
        keys = [key for key, _ in self.columns]
        return [dict(zip(keys, row, strict=True)) for row in self.rows]


@dataclass(frozen=True, slots=True)
class Section:
    """A part of a record: its entries, then its table, if it has one."""

    key: str
    title: str
    entries: tuple[Entry, ...] = ()
    table: RecordTable | None = None


@dataclass(frozen=True, slots=True)
class Record:
    """All that a run was a function of, what it counted, and how to repeat it."""

    sections: tuple[Section, ...]

    def __contains__(self, key: object) -> bool:
        """Whether there is a section of that key."""
        return any(section.key == key for section in self.sections)

    def section(self, key: str) -> Section:
        """The section of that key.

        Raises:
            KeyError: there is none.
        """
        for section in self.sections:
            if section.key == key:
                return section
        raise KeyError(key)

    def __getitem__(self, key: str) -> Value:
        """The value of an entry, as `record["file.sha256"]`.

        Raises:
            KeyError: there is no such entry.
        """
        section_key, _, wanted = key.partition(".")
        for entry in self.section(section_key).entries:
            if entry.key == wanted:
                return entry.value
        raise KeyError(key)

    def rows(self, key: str) -> list[dict[str, Value]]:
        """The rows of a section's table by column key; none where it has no table.

        Raises:
            KeyError: there is no such section.
        """
        table = self.section(key).table
        return [] if table is None else table.as_dicts()

    def as_dict(self) -> dict[str, dict[str, Value | list[dict[str, Value]]]]:
        """Everything by key, as JSON holds it: section -> entry -> value, with the table under `rows`."""
        found: dict[str, dict[str, Value | list[dict[str, Value]]]] = {}
        for section in self.sections:
            found[section.key] = {entry.key: entry.value for entry in section.entries}
            if section.table is not None:
                found[section.key]["rows"] = section.table.as_dicts()
        return found
