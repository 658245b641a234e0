from __future__ import annotations

import platform
from importlib.metadata import version

import numpy
import pytest

import xlmc
from xlmc.analysis.results.record.make import LIBRARIES, processor, versions


def test_versions_are_those_installed():
    result = versions()
    assert list(result) == ["xlmc", "python", *LIBRARIES]
    assert result["xlmc"] == xlmc.__version__
    assert result["python"] == platform.python_version()
    assert result["numpy"] == numpy.__version__
    assert result["formulas"] == version("formulas")


def test_the_compiler_of_a_compiled_run_is_named():
    pytest.importorskip("llvmlite")
    assert versions("jit") == versions() | {"llvmlite": version("llvmlite")}


def test_the_processors_vector_instructions_are_named():
    result = processor()
    assert result["machine"] == platform.machine()
    enabled = numpy.show_config(mode="dicts")["SIMD Extensions"]
    assert result["vector_instructions"].split() == [*enabled.get("baseline", []), *enabled.get("found", [])] or [
        "none"
    ]


def test_the_machine_itself_is_not_named():
    node = platform.node()
    assert node == "" or all(node not in text for text in (*versions().values(), *processor().values()))
