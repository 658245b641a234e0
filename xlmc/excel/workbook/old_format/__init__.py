"""Old Excel workbooks (`.xls`): LibreOffice converts their cells, and xlmc reads what LibreOffice drops or shortens."""
