"""Every value of a saved run's `run.json` in turn becomes one of another kind: refused in words, or of no harm."""

from __future__ import annotations

import hashlib
import io
import json
import re
import zipfile

import numpy as np
import pytest
from simulated import simulated

from xlmc.analysis.results.saved import keep, open_run
from xlmc.analysis.results.saved.archive import RUN
from xlmc.errors import XlmcError
from xlmc.montecarlo.model.loading import load
from xlmc.outputs.summary import summarise, summary_text

OTHERS = [None, True, -1, 0.5, 10**30, "x", [], {}, [None], {"a": 1}, float("nan")]
OF_PYTHON = re.compile(r"NoneType|None\b|argument|object|subscript|dtype|array|dict|\bint\b|\bstr\b")


@pytest.fixture(scope="session")
def tiny_run(small_book, tmp_path_factory):
    return keep(simulated(load(small_book), 20), tmp_path_factory.mktemp("edited") / "tiny.xlmcrun")


def places(result, path=()):
    """Paths to every value, keys of objects and positions of lists."""
    for key, value in (
        result.items() if isinstance(result, dict) else enumerate(result) if isinstance(result, list) else ()
    ):
        yield (*path, key)
        yield from places(value, (*path, key))


def edited(source, target, path, value):
    """The saved run, with one value of its document replaced; `...` takes it away."""
    with zipfile.ZipFile(source) as package, zipfile.ZipFile(target, "w") as made:
        for entry in package.infolist():
            content = package.read(entry)
            if entry.filename == RUN:
                document = holder = json.loads(content)
                for key in path[:-1]:
                    holder = holder[key]
                if value is ...:
                    del holder[path[-1]]
                else:
                    holder[path[-1]] = value
                content = json.dumps(document).encode()
            made.writestr(entry, content)
    return target


def refusal(path):
    """Open a saved run and print it; the message where it is refused."""
    try:
        summary_text(summarise(open_run(path)))
    except XlmcError as error:
        return error
    return None


@pytest.mark.usefixtures("read_once")
def test_any_value_of_another_kind(tiny_run, tmp_path):
    with zipfile.ZipFile(tiny_run) as package:
        result = list(places(json.loads(package.read(RUN))))
    assert len(result) > 60
    tried = [(path, OTHERS[(number * 7 + 3) % len(OTHERS)]) for number, path in enumerate(result)]
    tried += [(path, ...) for path in result[::2]]
    refused = 0
    for path, value in tried:
        book = edited(tiny_run, tmp_path / "edited.xlmcrun", path, value)
        error = refusal(book)
        assert error is None or str(error).startswith(str(book)), (path, value)
        assert error is None or not OF_PYTHON.search(error.message), (path, value)
        refused += error is not None
    assert refused > 0.5 * len(tried)


@pytest.mark.parametrize("kind", ["input", "prior", "forecast"])
def test_an_infinite_number_in_a_column_is_refused(kind, tiny_run, tmp_path):
    with zipfile.ZipFile(tiny_run) as package:
        entries = {name: package.read(name) for name in package.namelist()}
    document = json.loads(entries[RUN])
    column = next(each for each in document["columns"] if each["kind"] == kind)
    values = np.load(io.BytesIO(entries[column["entry"]]))
    values[3] = np.inf
    file = io.BytesIO()
    np.save(file, values)
    column["sha256"] = hashlib.sha256(file.getvalue()).hexdigest()
    target = tmp_path / "infinite.xlmcrun"
    with zipfile.ZipFile(target, "w") as made:
        for name, content in (entries | {column["entry"]: file.getvalue(), RUN: json.dumps(document)}).items():
            made.writestr(name, content)
    with pytest.raises(XlmcError, match=r"The saved run is damaged: the (draws|forecast)"):
        open_run(target)
