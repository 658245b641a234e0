from command_line import xlmc

__all__ = ["xlmc"]
