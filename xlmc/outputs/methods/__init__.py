"""What `xlmc methods` measured, as blocks, sheets, figures and JSON."""

from xlmc.outputs.methods.methods_report import in_short, methods_report

__all__ = ["in_short", "methods_report"]
