# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Small pieces of HTML."""
from html import escape


def table(header, rows, classes=""):
    """Rows of texts; a field that is Markup goes in as it is. Fields of
    columns whose header begins with '>' are right-aligned."""
    right = [name.startswith(">") for name in header]
    head = "".join(f'<th scope="col"{_right(r)}>{text(name.lstrip(">"))}</th>'
                   for name, r in zip(header, right))
    body = "".join(
        "<tr>" + "".join(f"<td{_right(r)}>{text(field)}</td>"
                         for field, r in zip(row, right)) + "</tr>"
        for row in rows)
    return (f'<div class="wide"><table class="{classes}"><thead><tr>{head}'
            f"</tr></thead><tbody>{body}</tbody></table></div>")


def definitions(pairs):
    """(name, value) pairs, or (name, value, id) where the value has one."""
    return "<dl>" + "".join(
        f"<div><dt>{text(name)}</dt><dd{_id(rest)}>{text(value)}</dd></div>"
        for name, value, *rest in pairs) + "</dl>"


class Markup(str):
    """Text that is HTML already."""


def text(field):
    return field if isinstance(field, Markup) else escape(str(field))


def number(value):
    """Four digits; whole and large numbers with separated thousands."""
    value = float(value)
    if abs(value) < 1e15 and (abs(value) >= 1e5 or value == int(value)):
        return f"{value:,.0f}"
    return f"{value:.4g}"


def _right(right):
    return ' class="number"' if right else ""


def _id(rest):
    return f' id="{rest[0]}"' if rest else ""
