# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Expressions that the user types: '10*(theta - 1)' of columns, or the
condition 'generation >= 2 && Y < 0', which is pandas'."""
import ast
import math
import operator

import numpy as np

from .refusal import Refused

ARITHMETIC = {ast.Add: operator.add, ast.Sub: operator.sub,
              ast.Mult: operator.mul, ast.Div: operator.truediv,
              ast.Pow: operator.pow, ast.USub: operator.neg,
              ast.UAdd: operator.pos}
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
    name: pandas' DataFrame.query. && and || and ^ are those of a scene's
    expressions, too; a number is true where it is above 0, as with Fixed
    where."""
    import pandas
    plain = text.replace("&&", " and ").replace("||", " or ").replace("^", "**")
    table = pandas.DataFrame({name: np.asarray(values)
                              for name, values in columns.items()
                              if np.ndim(values) == 1})
    try:
        with np.errstate(all="ignore"):
            found = table.eval(plain.strip(), engine="python", local_dict={},
                               global_dict={})
        mask = np.asarray(found) > 0
        if mask.shape != (len(table),) and mask.shape != ():
            raise ValueError("it is no condition")
    except Exception as error:  # pandas throws what Python does
        raise Refused(
            option, text, "what pandas' DataFrame.query takes, and && || ^; the "
            "columns are " + ", ".join(columns), f"Not so: {error}.") from None
    return np.broadcast_to(mask, (len(table),))


class _NotAllowed(Exception):
    pass


def _parsed(text):
    return ast.parse(text.strip(), mode="eval").body


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
