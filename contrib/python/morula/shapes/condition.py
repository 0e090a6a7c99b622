# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Which cells an expression like 'generation >= 2 && Y < 0' holds for."""
import ast
import operator

import numpy as np
from morula.refusal import Refused

ARITHMETIC = {ast.Add: operator.add, ast.Sub: operator.sub,
              ast.Mult: operator.mul, ast.Div: operator.truediv,
              ast.Pow: operator.pow}
COMPARISONS = {ast.Lt: operator.lt, ast.LtE: operator.le,
               ast.Gt: operator.gt, ast.GtE: operator.ge,
               ast.Eq: operator.eq, ast.NotEq: operator.ne}
FUNCTIONS = {"abs": np.abs, "sqrt": np.sqrt}
ALLOWED = ("numbers, columns, + - * / ^, < <= > >= == !=, && ||, abs, sqrt and "
           "brackets; the columns are ")


def cells_where(text, columns, option):
    """A mask of the cells, from their columns by name. && and || and ^ are
    those of a scene's expressions, or Python's; a number is true where it is
    above 0, as with Fixed where."""
    plain = text.replace("&&", " and ").replace("||", " or ").replace("^", "**")
    try:
        with np.errstate(all="ignore"):
            value = _value(ast.parse(plain.strip(), mode="eval").body, columns)
        size = len(next(iter(columns.values())))
        return _true(np.broadcast_to(value, (size,)))
    except (SyntaxError, _NotAllowed) as error:
        reason = error.args[0] if isinstance(error, _NotAllowed) else "syntax"
        raise Refused(option, text, ALLOWED + ", ".join(columns),
                      f"Not so: {reason}.") from None


class _NotAllowed(Exception):
    pass


def _true(value):
    return np.asarray(value) > 0


def _value(node, names):
    """Of a part of the expression: numbers, or truth as 0 and 1."""
    if isinstance(node, ast.Constant) and type(node.value) in (int, float):
        return float(node.value)
    if isinstance(node, ast.Name) and node.id in names:
        return np.asarray(names[node.id], dtype=float)
    if isinstance(node, ast.BinOp) and type(node.op) in ARITHMETIC:
        return ARITHMETIC[type(node.op)](_value(node.left, names),
                                         _value(node.right, names))
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
        return -_value(node.operand, names)
    if isinstance(node, ast.BoolOp):
        combine = (np.logical_and if isinstance(node.op, ast.And)
                   else np.logical_or)
        parts = [_true(_value(part, names)) for part in node.values]
        return combine.reduce(np.broadcast_arrays(*parts)).astype(float)
    if isinstance(node, ast.Compare):
        return _comparison(node, names)
    if (isinstance(node, ast.Call) and isinstance(node.func, ast.Name)
            and node.func.id in FUNCTIONS and len(node.args) == 1
            and not node.keywords):
        return FUNCTIONS[node.func.id](_value(node.args[0], names))
    raise _NotAllowed(ast.unparse(node))


def _comparison(node, names):
    """Also of several, 0 < x < 10, which hold if all do."""
    values = [_value(part, names) for part in (node.left, *node.comparators)]
    result = 1.0
    for kind, low, high in zip(node.ops, values, values[1:]):
        if type(kind) not in COMPARISONS:
            raise _NotAllowed(ast.unparse(node))
        result = result * COMPARISONS[type(kind)](low, high)
    return result
