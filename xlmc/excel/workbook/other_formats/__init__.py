"""Workbooks in other formats (`.xls`, `.xlsb`, `.ods`): LibreOffice converts, xlmc reads what it drops or shortens."""
