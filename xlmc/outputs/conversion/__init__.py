"""What Crystal Ball's dialogs and calls in cells define, as tables on a sheet of the workbook."""
