"""GETPIVOTDATA reads the cells of a pivot table as it was last refreshed: fixed items, items that vary, its source."""

from __future__ import annotations

import zipfile

import numpy as np
import openpyxl
import pytest
from simulated import simulated

from xlmc.analysis.studies.verify import verify
from xlmc.errors import ErrorCode, FormulaError
from xlmc.excel.workbook.reader import read_workbook
from xlmc.montecarlo.model.loading import load

MAIN = 'xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main"'
OFFICE = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
PACKAGE = "http://schemas.openxmlformats.org/package/2006/relationships"
SOURCE = [
    ["Region", "Year", "Kind", "Date", "Sales", "Cost"],
    ["North", 2023, "a", 45300, 10, 1],
    ["North", 2024, "a", 45301, 20, 2],
    ["South", 2024, "a", 45332, 40, 4],
    ["South", 2024, "b", 45333, 80, 8],
]
SHOWN = {
    "A2": "Kind",
    "B2": "a",
    "A4": "Row Labels",
    "B4": "Sum of Sales",
    "C4": "Costs",
    "A5": "North",
    "B5": 30,
    "C5": 3,
    "A6": 2023,
    "B6": 10,
    "C6": 1,
    "A7": 2024,
    "B7": 20,
    "C7": 2,
    "A8": "South",
    "B8": 40,
    "C8": 4,
    "A9": 2024,
    "B9": 40,
    "C9": 4,
    "A10": "Grand Total",
    "B10": 70,
    "C10": 7,
    "E4": "Row Labels",
    "F4": "Sum of Sales",
    "E5": "Jan",
    "F5": 30,
    "E6": "Feb",
    "E7": "Grand Total",
    "F7": 150,
}
CACHE = f"""<pivotCacheDefinition {MAIN} recordCount="4">
<cacheSource type="worksheet"><worksheetSource ref="A1:F5" sheet="D"/></cacheSource><cacheFields count="6">
<cacheField name="Region"><sharedItems count="2"><s v="South"/><s v="North"/></sharedItems></cacheField>
<cacheField name="Year"><sharedItems count="2"><n v="2023"/><n v="2024"/></sharedItems></cacheField>
<cacheField name="Kind"><sharedItems count="2"><s v="a"/><s v="b"/></sharedItems></cacheField>
<cacheField name="Date"><sharedItems containsDate="1"/><fieldGroup base="3"><rangePr groupBy="months"/>
<groupItems count="4"><s v="&lt;1/1/2024"/><s v="Jan"/><s v="Feb"/><s v="&gt;1/1/2025"/></groupItems></fieldGroup>
</cacheField>
<cacheField name="Sales"><sharedItems/></cacheField><cacheField name="Cost"><sharedItems/></cacheField></cacheFields>
</pivotCacheDefinition>"""
ITEMS = '<items count="3"><item x="{0}"/><item x="{1}"/><item t="default"/></items>'
FIRST = f"""<pivotTableDefinition {MAIN} name="one" cacheId="1">
<location ref="A4:C10" firstHeaderRow="0" firstDataRow="1" firstDataCol="1" rowPageCount="1" colPageCount="1"/>
<pivotFields count="6"><pivotField axis="axisRow">{ITEMS.format(1, 0)}</pivotField>
<pivotField axis="axisRow">{ITEMS.format(0, 1)}</pivotField>
<pivotField axis="axisPage">{ITEMS.format(0, 1)}</pivotField>
<pivotField/><pivotField dataField="1"/><pivotField dataField="1"/></pivotFields>
<rowFields count="2"><field x="0"/><field x="1"/></rowFields>
<rowItems count="6"><i><x/></i><i r="1"><x/></i><i r="1"><x v="1"/></i><i><x v="1"/></i><i r="1"><x v="1"/></i>
<i t="grand"><x/></i></rowItems><colFields count="1"><field x="-2"/></colFields>
<colItems count="2"><i><x/></i><i i="1"><x v="1"/></i></colItems>
<pageFields count="1"><pageField fld="2" item="0"/></pageFields>
<dataFields count="2"><dataField name="Sum of Sales" fld="4"/><dataField name="Costs" fld="5"/></dataFields>
</pivotTableDefinition>"""
MONTHS = '<items count="5"><item x="0"/><item x="1"/><item x="2"/><item x="3"/><item t="default"/></items>'
SECOND = f"""<pivotTableDefinition {MAIN} name="two" cacheId="1">
<location ref="E4:F7" firstHeaderRow="1" firstDataRow="1" firstDataCol="1"/><pivotFields count="6"><pivotField/>
<pivotField/><pivotField/><pivotField name="Month" axis="axisRow">{MONTHS}</pivotField><pivotField dataField="1"/>
<pivotField/></pivotFields><rowFields count="1"><field x="3"/></rowFields>
<rowItems count="3"><i><x v="1"/></i><i><x v="2"/></i><i t="grand"><x/></i></rowItems>
<colItems count="1"><i/></colItems>
<dataFields count="1"><dataField name="Sum of Sales" fld="4"/></dataFields></pivotTableDefinition>"""


def relations(**targets):
    rows = (
        f'<Relationship Id="r{i}" Type="{OFFICE}/{kind.rstrip("0123456789")}" Target="{target}"/>'
        for i, (kind, target) in enumerate(targets.items(), start=1)
    )
    return f'<Relationships xmlns="{PACKAGE}">{"".join(rows)}</Relationships>'


@pytest.fixture(scope="module")
def book(tmp_path_factory):
    folder = tmp_path_factory.mktemp("pivots")

    def made(cells, name="book.xlsx", source=None):
        plain = openpyxl.Workbook()
        plain.active.title = "D"
        for row in SOURCE:
            plain.active.append(row)
        pivots, own = plain.create_sheet("P"), plain.create_sheet("S")
        for address, value in SHOWN.items():
            pivots[address] = value
        for address, value in cells.items():
            own[address] = value
        for address, value in (source or {}).items():
            plain["D"][address] = value
        plain.save(folder / "plain.xlsx")
        of_table = relations(pivotCacheDefinition="/xl/pivotCache/pivotCacheDefinition1.xml")
        more = {
            "xl/worksheets/_rels/sheet2.xml.rels": relations(
                pivotTable1="../pivotTables/pivotTable1.xml", pivotTable2="../pivotTables/pivotTable2.xml"
            ),
            "xl/pivotTables/pivotTable1.xml": FIRST,
            "xl/pivotTables/pivotTable2.xml": SECOND,
            "xl/pivotTables/_rels/pivotTable1.xml.rels": of_table,
            "xl/pivotTables/_rels/pivotTable2.xml.rels": of_table,
            "xl/pivotCache/pivotCacheDefinition1.xml": CACHE,
        }
        with zipfile.ZipFile(folder / "plain.xlsx") as old, zipfile.ZipFile(folder / name, "w") as new:
            for entry in old.namelist():
                new.writestr(entry, old.read(entry))
            for part, text in more.items():
                new.writestr(part, text)
        return folder / name

    return made


ASKED = {
    'GETPIVOTDATA("Sum of Sales",P!$A$4)': 70,
    'GETPIVOTDATA("Sales",P!$B$7,"Region","North")': 30,
    'GETPIVOTDATA("COSTS",P!$A$2,"region","NORTH","Year",2024)': 2,
    'GETPIVOTDATA("Cost",P!A4:C10,"Year","2024","Region","South")': 4,
    'GETPIVOTDATA("Cost",P!A4,"Kind","a","Region","South")': 4,
    'GETPIVOTDATA("Cost",P!A4,"Kind","b","Region","South")': ErrorCode.REF,
    'GETPIVOTDATA("Cost",P!A4,"Region","West")': ErrorCode.REF,
    'GETPIVOTDATA("Cost",P!A4,"Colour","West")': ErrorCode.REF,
    'GETPIVOTDATA("Profit",P!A4)': ErrorCode.REF,
    'GETPIVOTDATA("Cost",P!A4,"Year",2023)': 1,
    'GETPIVOTDATA("Cost",P!A4,"Year",2024)': ErrorCode.REF,
    'GETPIVOTDATA("Cost",P!A4,"Region","South","Year",2023)': ErrorCode.REF,
    'GETPIVOTDATA("Cost",P!A4,"Region",1/0)': ErrorCode.DIV0,
    'GETPIVOTDATA(D!E1,P!A4,D!A1,D!A4)*2+GETPIVOTDATA("Costs",P!A4)': 87,
    'GETPIVOTDATA("Sum of Sales",P!E4)': 150,
    'GETPIVOTDATA("Sales",P!E4,"Date",1)': 30,
    'GETPIVOTDATA("Sales",P!E4,"Month","jan")': 30,
    'GETPIVOTDATA("Sales",P!E4,"Month",3)': ErrorCode.REF,
}


def test_fixed_items(book):
    cells = {f"A{i}": f"={text}" for i, text in enumerate(ASKED, start=1)}
    result = [check.got for check in verify(read_workbook(book(cells))).cells]
    assert dict(zip(ASKED, result, strict=True)) == ASKED


@pytest.mark.parametrize("engine", ["numpy", "jit"])
def test_items_that_vary(book, engine):
    cells = {
        "A1": "=RiskDiscrete({2023,2024},{1,1})",
        "A2": '=CHOOSE(RiskDiscrete({1,2},{1,1}),"south","North")',
        "B1": '=RiskOutput("one")+GETPIVOTDATA("Sales",P!A4,"Region","North","Year",A1)',
        "B2": '=RiskOutput("both")+IFERROR(GETPIVOTDATA("Cost",P!A4,"Region",A2,"Year",A1),-1)',
        "B3": '=RiskOutput("region")+GETPIVOTDATA("Cost",P!A4,"Region",A2)',
    }
    run = simulated(load(book(cells, f"vary-{engine}.xlsx")), 400, seed=5, engine=engine)
    year, north = (run.inputs[name] for name in ("S!A1#1", "S!A2#1"))
    assert np.array_equal(run.forecasts["one"], np.where(year == 2023, 10, 20))
    assert np.array_equal(run.forecasts["region"], np.where(north == 2, 3, 4))
    expected = np.select([(north == 2) & (year == 2023), north == 2, year == 2024], [1, 2, 4], -1)
    assert np.array_equal(run.forecasts["both"], expected)


REFUSED = {
    "its source varies": ('GETPIVOTDATA("Cost",P!A4)', "made from a cell that varies"),
    "no pivot table": ('GETPIVOTDATA("Cost",P!K4)', "No pivot table that can be read"),
    "an empty cell": ('GETPIVOTDATA("Sales",P!E4,"Date",2)', "is empty"),
    "a field that varies": ('GETPIVOTDATA(IF(A1>0,"Cost",""),P!A4)', "field that varies"),
}


@pytest.mark.parametrize(("text", "message"), REFUSED.values(), ids=REFUSED)
def test_what_cannot_be_told_is_refused(book, text, message):
    source = {"E2": "=RiskNormal(10,1)"} if "made from" in message else {}
    cells = {"A1": "=RiskUniform(0,1)", "B1": f'=RiskOutput("y")+A1+{text}'}
    with pytest.raises(FormulaError, match=message):
        load(book(cells, "refused.xlsx", source))
