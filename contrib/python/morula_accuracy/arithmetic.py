# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Expressions like '10*(theta - 1)' of named columns."""
import ast
import operator

from morula_runs.refusal import Refused

OPERATORS = {ast.Add: operator.add, ast.Sub: operator.sub,
             ast.Mult: operator.mul, ast.Div: operator.truediv,
             ast.Pow: operator.pow, ast.USub: operator.neg,
             ast.UAdd: operator.pos}


def evaluate(text, names, option):
    """The value of an expression of numbers, + - * / **, brackets and the
    names given."""
    try:
        return _value(ast.parse(text.strip(), mode="eval").body, names)
    except (SyntaxError, _NotAllowed) as error:
        reason = error.args[0] if isinstance(error, _NotAllowed) else "syntax"
        raise Refused(option, text, "numbers, + - * / **, brackets and the "
                      "columns " + ", ".join(names),
                      f"Not so: {reason}.") from None


class _NotAllowed(Exception):
    pass


def _value(node, names):
    if isinstance(node, ast.Constant) and type(node.value) in (int, float):
        return float(node.value)
    if isinstance(node, ast.Name) and node.id in names:
        return names[node.id]
    if isinstance(node, ast.BinOp) and type(node.op) in OPERATORS:
        return OPERATORS[type(node.op)](_value(node.left, names),
                                        _value(node.right, names))
    if isinstance(node, ast.UnaryOp) and type(node.op) in OPERATORS:
        return OPERATORS[type(node.op)](_value(node.operand, names))
    raise _NotAllowed(ast.unparse(node))
