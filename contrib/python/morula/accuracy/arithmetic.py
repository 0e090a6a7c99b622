# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Expressions like '10*(theta - 1)' of named columns."""
import ast
import math
import operator

from morula.refusal import Refused

OPERATORS = {ast.Add: operator.add, ast.Sub: operator.sub,
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
        value = _value(ast.parse(text.strip(), mode="eval").body, names)
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
