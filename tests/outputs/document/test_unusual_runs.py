from __future__ import annotations

import re
import sys

import pytest
from document_texts import squeezed

from xlmc.api import Simulation
from xlmc.errors import SimulationError
from xlmc.outputs.document import Wanted
from xlmc.outputs.document.build import build
from xlmc.outputs.document.parts import HALF, Document, Drawing, Figure, Heading, Paragraph

docx = pytest.importorskip("docx")
pypdf = pytest.importorskip("pypdf")
pytest.importorskip("typst")


def written(simulation, folder, **options):
    """The texts of both files."""
    run = Simulation(simulation)
    pdf = pypdf.PdfReader(run.save_report(folder / "report.pdf", **options))
    word = docx.Document(run.save_report(folder / "report.docx", **options))
    cells = [cell.text for table in word.tables for row in table.rows for cell in row.cells]
    texts = [*(paragraph.text for paragraph in word.paragraphs), *cells]
    return squeezed("".join(page.extract_text() for page in pdf.pages)), squeezed("".join(texts))


@pytest.mark.parametrize("name", ["run", "none_accepted", "one_accepted"])
def test_warnings_and_answers_stand_in_the_report_of_any_run(request, tmp_path, name):
    simulation = request.getfixturevalue(name)
    for text in written(simulation, tmp_path):
        were = "was" if simulation.accepted == 1 else "were"
        assert squeezed(f"{simulation.accepted:,} {were} accepted") in text
        for warning in simulation.warnings:
            assert squeezed(warning) in text
        for forecast in simulation.model.forecasts:
            assert squeezed(forecast.name) in text


def test_names_that_look_like_markup_are_shown_as_they_are(make, tmp_path):
    evil = '#panic("x") <b> \\u{1} $x$ @ref *bold* `raw` // /* & "quoted" </w:t>'
    simulation = make.simulate(
        {"A1": 1.0, "B1": "=A1*2"},
        [make.uniform(evil, "A1", 0, 1, source=evil, units="m^2")],
        [make.forecast(f"{evil} 2", "B1", threshold=1.0, units="<i>")],
        [make.filter("_f_", "B1", at_most=1.9, because=evil)],
    )
    for text in written(simulation, tmp_path, case={"Title": evil, "Analyst": evil, evil: evil}):
        assert text.count(squeezed(evil)) > 8
        assert "<i>" in text


def test_a_forecast_that_is_huge_tiny_or_the_same_everywhere(make, tmp_path):
    simulation = make.simulate(
        {"A1": 1.0, "B1": "=A1*1E+300", "B2": "=A1*1E-300", "B3": "=A1*0+5", "B4": "=1/(A1-0.5)"},
        [make.uniform("a", "A1", 0, 1)],
        [make.forecast(name, f"B{number}") for number, name in enumerate(("huge", "tiny", "still", "wild"), 1)],
    )
    for text in written(simulation, tmp_path):
        assert "still:5inall2,000trials" in text


def test_a_case_of_very_long_texts(run, tmp_path):
    case = {"Title": "T" * 600, "Analyst": "A" * 600, "Case number": "N" * 600}
    for text in written(run, tmp_path, case=case, sections=["repeat"]):
        assert all(each in text for each in case.values())


def test_a_letter_that_no_font_has_is_said_and_no_file_is_written(make, tmp_path):
    simulation = make.simulate(
        {"A1": 1.0, "B1": "=A1*2"}, [make.uniform("a", "A1", 0, 1)], [make.forecast("b \U00011bff", "B1")]
    )
    with pytest.raises(SimulationError, match="A PDF cannot be made") as refused:
        Simulation(simulation).save_report(tmp_path / "report.pdf")
    assert ".docx" in str(refused.value)
    assert list(tmp_path.iterdir()) == []


def test_reports_need_no_network_no_font_of_the_system_and_no_library_of_plots(run, tmp_path, monkeypatch):
    def refuse(*_, **__):
        raise AssertionError("the network was used")

    for what in ("socket.connect", "getaddrinfo"):
        monkeypatch.setattr(f"socket.{what}", refuse)
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    path = Simulation(run).save_report(tmp_path / "report.pdf", sections=["answer", "forecasts"])
    fonts = {
        str(font["/BaseFont"]).partition("+")[2]
        for page in pypdf.PdfReader(path).pages
        for font in (each.get_object() for each in page["/Resources"]["/Font"].values())
    }
    assert fonts
    assert all(re.match("Libertinus|DejaVu|NewCM", font) for font in fonts), fonts


def test_a_few_forecasts_have_large_figures_and_many_have_small_ones(make):
    def widths(count):
        names = [make.forecast(f"f{number}", f"B{number}") for number in range(1, count + 1)]
        cells = {"A1": 1.0, **{f"B{number}": f"=A1*{number}" for number in range(1, count + 1)}}
        result = build(make.simulate(cells, [make.uniform("a", "A1", 0, 1)], names), Wanted(sections=["forecasts"]))
        return [block.drawing.width for block in result.blocks if isinstance(block, Figure)]

    assert widths(4) == [160.0] * 4
    assert widths(5) == [HALF] * 5


def test_every_kind_of_block_can_be_empty_of_pictures():
    from xlmc.outputs.document.docx_writer import docx_bytes
    from xlmc.outputs.document.typst_writer import pdf_bytes

    plain = Document("t", "", None, "h", "f", (), (Heading("one"), Paragraph("two", "warning")))
    assert plain.pictures == []
    assert pdf_bytes(plain).startswith(b"%PDF")
    assert docx_bytes(plain).startswith(b"PK")
    drawing = Drawing('<svg xmlns="http://www.w3.org/2000/svg" width="9" height="9"/>', "nothing", 5.0)
    one = Document("t", "", None, "h", "f", (), (Heading("one"), Figure(drawing, "two")))
    assert docx_bytes(one).startswith(b"PK")
