"""The live window: a page on this machine that shows a workbook's answer while its ranges are moved.

`session` is what the window knows and does, without sockets, files or threads; `open_book` runs it; `server` listens,
on the loopback address alone; `protocol` says what page and server tell each other.
"""
