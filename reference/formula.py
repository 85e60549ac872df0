"""Formulas of time in loading curves: the language of solver/forces/formula.cpp in Python."""

import ast
import math
import operator
import re

from common.errors import InputError

FUNCTIONS = {
    name: getattr(math, name)
    for name in "acos asin atan cos cosh exp log sin sinh sqrt tan tanh".split()
} | {"abs": abs, "max": lambda *a: max(a), "min": lambda *a: min(a)}
CONSTANTS = {"pi": math.pi, "e": math.e}
OPERATORS = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: math.pow,
    ast.USub: operator.neg,
    ast.UAdd: operator.pos,
}
LANGUAGE = (
    "a formula may contain the time t, numbers, + - * / ^, parentheses, pi, e and the functions "
    + ", ".join(sorted(FUNCTIONS))
)


def evaluate(text, t):
    """The value of a formula, such as "sin(2*pi*t/0.3)", at a time t in s.

    Raises InputError, with the mistake and what is allowed, for a bad formula or value.
    """
    if "**" in text:
        raise InputError(f"a power is written ^, not '**'; {LANGUAGE}")
    if re.search(r"\d[_boxBOX]", text):  # which Python allows in a number
        raise InputError(f"'{text}' has a number that is not decimal; {LANGUAGE}")
    try:
        value = _value(ast.parse(text.strip().replace("^", "**"), mode="eval").body, {"t": t})
    except SyntaxError as error:
        raise InputError(f"'{text}' cannot be read; {LANGUAGE}") from error
    except (ArithmeticError, TypeError, ValueError) as error:
        raise InputError(f"formula = '{text}' has no value at t = {t}: {error}") from error
    if not math.isfinite(value):
        raise InputError(f"formula = '{text}' is {value} at t = {t}; it must be finite")
    return value


def _value(node, variables):
    """The value of a node of the syntax tree. Raises InputError for anything not allowed."""
    match node:
        case ast.Constant(value=int() | float() as number) if not isinstance(number, bool):
            return float(number)
        case ast.Name(id=name) if name in variables or name in CONSTANTS:
            return variables.get(name, CONSTANTS.get(name))
        case ast.UnaryOp(op=op, operand=operand) if type(op) in OPERATORS:
            return OPERATORS[type(op)](_value(operand, variables))
        case ast.BinOp(op=op, left=left, right=right) if type(op) in OPERATORS:
            return OPERATORS[type(op)](_value(left, variables), _value(right, variables))
        case ast.Call(func=ast.Name(id=name), args=args, keywords=[]) if name in FUNCTIONS:
            return FUNCTIONS[name](*(_value(arg, variables) for arg in args))
    raise InputError(f"'{ast.unparse(node)}' is not allowed; {LANGUAGE}")
