"""The workbooks people start from, and the scripts that build them."""
