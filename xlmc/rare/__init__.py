"""Rare acceptance."""
