from __future__ import annotations


def test_lists_the_templates(xlmc):
    outcome = xlmc("new")
    assert outcome.code == 0
    assert "planar-impact  " in outcome.out


def test_copies_a_template_that_runs(xlmc, tmp_path):
    outcome = xlmc("new", "planar-impact", "case.xlsx")
    assert outcome.code == 0
    assert "xlmc simulate case.xlsx" in outcome.out
    assert xlmc("check", tmp_path / "case.xlsx").code == 0


def test_names_the_copy_after_the_template(xlmc, tmp_path):
    assert xlmc("new", "planar-impact").code == 0
    assert (tmp_path / "planar-impact.xlsx").exists()


def test_never_overwrites(xlmc, tmp_path):
    mine = tmp_path / "case.xlsx"
    mine.write_text("my work")
    outcome = xlmc("new", "planar-impact", mine)
    assert outcome.code == 2
    assert "exists already" in outcome.err
    assert mine.read_text() == "my work"


def test_refuses_an_unknown_template(xlmc):
    outcome = xlmc("new", "plane-impact")
    assert outcome.code == 2
    assert "planar-impact" in outcome.err


def test_refuses_a_folder_that_is_not_there(xlmc, tmp_path):
    outcome = xlmc("new", "planar-impact", tmp_path / "nowhere" / "case.xlsx")
    assert outcome.code == 2
    assert "nowhere" in outcome.err
