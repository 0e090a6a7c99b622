# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Pieces of HTML, from the templates in page/. Whatever goes into one is
escaped there, but for Markup, which is HTML already."""
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

PAGE = Path(__file__).with_name("page")
TEMPLATES = Environment(loader=FileSystemLoader(PAGE), autoescape=True,
                        undefined=StrictUndefined)
_PARTS = TEMPLATES.get_template("parts.html").module
table, definitions, figure = _PARTS.table, _PARTS.definitions, _PARTS.figure
photograph, notes, span = _PARTS.photograph, _PARTS.notes, _PARTS.span
paragraph = _PARTS.paragraph


def joined(parts):
    """Pieces one after the other."""
    return Markup("").join(parts)


def number(value):
    """Four digits; whole and large numbers with separated thousands."""
    value = float(value)
    if abs(value) < 1e15 and (abs(value) >= 1e5 or value == int(value)):
        return f"{value:,.0f}"
    return f"{value:.4g}"
