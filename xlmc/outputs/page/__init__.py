"""The results as one page for a browser, without a network: the story of the result sheets, with charts to be moved."""

from __future__ import annotations

from xlmc.outputs.page.html_page import check_page_path, page_policy, page_text, plain_page, save_page

__all__ = ["check_page_path", "page_policy", "page_text", "plain_page", "save_page"]
