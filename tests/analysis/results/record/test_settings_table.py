"""What the run was to go on until, in the section Settings of the record: as it always stood, and read back."""

from __future__ import annotations

from dataclasses import replace

import pytest
from simulated import simulated

from xlmc.analysis.results.record.record_parts import Entry, Record, Section
from xlmc.analysis.results.record.settings_table import recorded_settings, settings_section
from xlmc.errors import WorkbookError
from xlmc.montecarlo.definitions.stopping import stopping
from xlmc.montecarlo.model.loading import load

LABELS = {
    "trials": "Trials at most",
    "seed": "Seed",
    "sampling": "Sampling",
    "engine": "Engine",
    "lognorm": "RiskLognorm is that of",
    "until_accepted": "Until so many are accepted",
    "precision": "Precision",
    "relative": "It is a share of the number",
    "precision_of": "Of these numbers",
    "confidence": "At this confidence",
    "adaptive": "Stable digits",
    "for": "Of these forecasts",
    "time_limit": "Seconds at most",
    "rare": "Search for rare trials",
}

ASKED = [
    ({}, {}),
    ({"until_accepted": 100, "rare": "never"}, {"until_accepted": 100, "rare": "never"}),
    (
        {"precision": "20%", "precision_of": "p50, mean", "forecasts": "area", "time_limit": 60},
        {
            "precision": 0.2,
            "relative": True,
            "precision_of": "p50,mean",
            "confidence": 0.95,
            "for": '["area"]',
            "time_limit": 60.0,
        },
    ),
    ({"adaptive": 2, "forecasts": ["area", "größe"]}, {"adaptive": 2, "for": '["area", "größe"]'}),
]


@pytest.fixture(scope="module")
def run(small_book):
    return simulated(load(small_book), 20)


def section_of(run, asked):
    settings = replace(run.settings, stopping=stopping(**asked))
    return settings, settings_section(replace(run, settings=settings))


@pytest.mark.parametrize(("asked", "expected"), ASKED)
def test_goals_stand_as_in_version_0_4(run, asked, expected):
    settings, section = section_of(run, asked)
    assert {entry.key: entry.label for entry in section.entries} == LABELS
    assert [entry.key for entry in section.entries] == list(LABELS)
    text = {entry.key: entry.value for entry in section.entries if entry.value is not None}
    assert {
        key: value for key, value in text.items() if key not in ("trials", "seed", "sampling", "engine")
    } == expected
    assert recorded_settings(Record((section,))) == settings


@pytest.mark.parametrize(("asked", "expected"), ASKED)
def test_a_worksheet_gives_whole_numbers_as_floats(run, asked, expected):
    settings, section = section_of(run, asked)
    entries = tuple(
        replace(entry, value=float(entry.value)) if type(entry.value) is int else entry for entry in section.entries
    )
    again = recorded_settings(Record((replace(section, entries=entries),)))
    assert again == settings
    if settings.stopping.accepted is not None:
        assert type(again.stopping.accepted) is int


def test_an_older_record_that_does_not_know_a_goal_is_read(run):
    settings, section = section_of(run, {"until_accepted": 100})
    entries = tuple(entry for entry in section.entries if entry.key != "adaptive")
    assert recorded_settings(Record((replace(section, entries=entries),))) == settings


@pytest.mark.parametrize(
    ("entry", "message"),
    [
        (Entry("until_accepted", "", "many"), "'many' is not a whole number"),
        (Entry("until_accepted", "", 1), "1 accepted trials were asked for"),
        (Entry("adaptive", "", 2.5), "2.5 is not a whole number"),
        (Entry("precision", "", 1.0), "could not convert|must be a string or a real number"),
    ],
)
def test_an_edited_goal_is_refused(run, entry, message):
    _, section = section_of(run, {})
    entries = tuple(entry if each.key == entry.key else each for each in section.entries)
    with pytest.raises(WorkbookError, match=message):
        recorded_settings(Record((Section(section.key, section.title, entries),)))
