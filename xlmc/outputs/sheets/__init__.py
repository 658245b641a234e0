"""Result sheets in the workbook, with native charts."""
