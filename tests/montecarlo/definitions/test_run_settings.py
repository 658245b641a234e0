"""The rows of settings: the keys by which the record knows them."""

from __future__ import annotations

import pytest

from xlmc.montecarlo.definitions.run_settings import SETTINGS


@pytest.mark.parametrize("key", ["seed", "sampling", "engine"])
def test_the_record_knows_a_setting_by_its_own_key(key):
    assert SETTINGS[key].entry_key == key


def test_the_record_knows_a_setting_by_another_key_where_a_row_gives_one():
    others = {key: row.entry_key for key, row in SETTINGS.items() if row.entry_key != key}
    assert [*others.values()] == ["for"]


def test_no_two_settings_have_one_entry():
    keys = [row.entry_key for row in SETTINGS.values()]
    assert len({*keys}) == len(keys)
    assert all(keys)
