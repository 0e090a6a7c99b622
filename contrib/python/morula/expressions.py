# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Expressions that the user types: '10*(theta - 1)' of columns, or the
condition 'generation >= 2 && Y < 0'. Nothing else that Python can do."""
import ast
import math
import operator

import numpy as np

from .refusal import Refused

ARITHMETIC = {ast.Add: operator.add, ast.Sub: operator.sub,
              ast.Mult: operator.mul, ast.Div: operator.truediv,
              ast.Pow: operator.pow, ast.USub: operator.neg,
              ast.UAdd: operator.pos}
COMPARISONS = {ast.Lt: operator.lt, ast.LtE: operator.le,
               ast.Gt: operator.gt, ast.GtE: operator.ge,
               ast.Eq: operator.eq, ast.NotEq: operator.ne}
FUNCTIONS = {"abs": np.abs, "sqrt": np.sqrt}

# Characters; Python's own parser calls itself for each bracket and sign.
LONGEST = 500


def evaluate(text, names, option):
    """The value of an expression of numbers, + - * / **, brackets and the
    names given: a finite number."""
    def refused(reason):
        return Refused(option, text, "numbers, + - * / **, brackets and the "
                       "columns " + ", ".join(names), f"Not so: {reason}.")

    if len(text) > LONGEST:
        raise refused(f"more than {LONGEST} characters")
    try:
        value = _arithmetic(_parsed(text), names, _arithmetic)
    except (SyntaxError, ValueError):  # ValueError: a null byte
        raise refused("syntax") from None
    except _NotAllowed as error:
        raise refused(error.args[0]) from None
    except (RecursionError, MemoryError):
        raise refused("too many brackets or signs within each other") from None
    except ZeroDivisionError:
        raise refused("a division by zero") from None
    except OverflowError:
        raise refused("a number too large") from None
    if isinstance(value, complex) or not math.isfinite(value):
        raise refused(f"it is {value}, which is no finite real number")
    return value


def rows_where(text, columns, option):
    """A mask of the rows for which a condition holds, from their columns by
    name. && and || and ^ are those of a scene's expressions, or Python's; a
    number is true where it is above 0, as with Fixed where."""
    plain = text.replace("&&", " and ").replace("||", " or ").replace("^", "**")
    names = {name: np.asarray(values, dtype=float)
             for name, values in columns.items()}
    try:
        with np.errstate(all="ignore"):
            value = _condition(_parsed(plain), names)
        return _true(np.broadcast_to(value, (len(next(iter(names.values()))),)))
    except (SyntaxError, _NotAllowed) as error:
        reason = error.args[0] if isinstance(error, _NotAllowed) else "syntax"
        raise Refused(
            option, text, "numbers, columns, + - * / ^, < <= > >= == !=, && ||,"
            " abs, sqrt and brackets; the columns are " + ", ".join(columns),
            f"Not so: {reason}.") from None


class _NotAllowed(Exception):
    pass


def _parsed(text):
    return ast.parse(text.strip(), mode="eval").body


def _true(value):
    return np.asarray(value) > 0


def _arithmetic(node, names, part):
    """The value of numbers, names and signs; part(node, names, part) is that
    of what stands between them."""
    if isinstance(node, ast.Constant) and type(node.value) in (int, float):
        return float(node.value)
    if isinstance(node, ast.Name) and node.id in names:
        return names[node.id]
    if isinstance(node, ast.BinOp) and type(node.op) in ARITHMETIC:
        return ARITHMETIC[type(node.op)](part(node.left, names, part),
                                         part(node.right, names, part))
    if isinstance(node, ast.UnaryOp) and type(node.op) in ARITHMETIC:
        return ARITHMETIC[type(node.op)](part(node.operand, names, part))
    raise _NotAllowed(ast.unparse(node))


def _condition(node, names, _=None):
    """Of a part of a condition: numbers, or truth as 0 and 1."""
    if isinstance(node, ast.BoolOp):
        combine = (np.logical_and if isinstance(node.op, ast.And)
                   else np.logical_or)
        parts = [_true(_condition(part, names)) for part in node.values]
        return combine.reduce(np.broadcast_arrays(*parts)).astype(float)
    if isinstance(node, ast.Compare):
        return _comparison(node, names)
    if (isinstance(node, ast.Call) and isinstance(node.func, ast.Name)
            and node.func.id in FUNCTIONS and len(node.args) == 1
            and not node.keywords):
        return FUNCTIONS[node.func.id](_condition(node.args[0], names))
    return _arithmetic(node, names, _condition)


def _comparison(node, names):
    """Also of several, 0 < x < 10, which hold if all do."""
    values = [_condition(part, names)
              for part in (node.left, *node.comparators)]
    result = 1.0
    for kind, low, high in zip(node.ops, values, values[1:]):
        if type(kind) not in COMPARISONS:
            raise _NotAllowed(ast.unparse(node))
        result = result * COMPARISONS[type(kind)](low, high)
    return result
