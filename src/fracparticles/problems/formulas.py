"""A text such as "1 + tanh(x)" as a function of arrays.

A text is an expression in its variables, of numbers, + - * / **, comparisons joined by & and |, and the functions of
`FUNCTIONS`. Every node of its syntax tree must be one of those, so that it has no attributes, no imports, no strings
and no whole numbers of many digits; each then becomes a call of numpy. Nothing of the text is given to Python to run.
"""

from __future__ import annotations

import ast
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np
from scipy.special import gamma

from fracparticles.errors import InvalidInput, closest, spelled

__all__ = ["FUNCTIONS", "Formula"]

_LONGEST = 2000  # characters
_DEEPEST = 100  # operations within one another

_NUMPY = """
sin cos tan arcsin arccos arctan arctan2 sinh cosh tanh exp expm1 log log1p sqrt abs sign minimum maximum where
"""
FUNCTIONS: dict[str, Callable[..., Any]] = {name: getattr(np, name) for name in _NUMPY.split()} | {
    "gamma": gamma
}
# Values in the brackets of a function, where there is not one.
_TAKES = {"where": 3, "arctan2": 2, "minimum": 2, "maximum": 2}
_CONSTANTS = {"pi": np.pi, "e": np.e}


def _of_truth(test: Callable[..., Any], one: Any, other: Any) -> Any:
    """Return 1 where the test holds and 0 elsewhere: numbers, which can be added."""
    return test(one, other) * 1.0


_OPERATORS: dict[type, Callable[..., Any]] = {
    ast.Add: np.add,
    ast.Sub: np.subtract,
    ast.Mult: np.multiply,
    ast.Div: np.divide,
    ast.Pow: np.power,
    ast.USub: np.negative,
    ast.UAdd: np.positive,
} | {
    node: partial(_of_truth, test)
    for node, test in (
        (ast.BitAnd, np.logical_and),
        (ast.BitOr, np.logical_or),
        (ast.Lt, np.less),
        (ast.LtE, np.less_equal),
        (ast.Gt, np.greater),
        (ast.GtE, np.greater_equal),
    )
}
_INSTEAD = {
    ast.BitXor: "Write ** for a power.",
    ast.IfExp: "Write where(condition, one, other).",
    ast.BoolOp: "Join comparisons by & and |, each in brackets.",
    ast.Attribute: "Write the name of the function alone.",
}


Values = Callable[[Mapping[str, Any]], Any]
"""A function of the variables by name."""


class Formula:
    """A text in some variables, checked.

    Parameters
    ----------
    field : str
        Its name in messages.
    text : str
    variables : sequence of str
        The names that it may hold.

    Attributes
    ----------
    depends_on : frozenset of str
        The variables that it holds.

    Raises
    ------
    InvalidInput
        If the text holds anything else; names the place in the text, and what is allowed.
    """

    def __init__(self, field: str, text: str, variables: Sequence[str]) -> None:
        tree = _parsed(field, text, variables)
        named = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
        self.depends_on = frozenset(named & set(variables))
        self._values = _function_of(tree)

    def __call__(self, values: Mapping[str, Any]) -> Any:
        """Return its value, as numpy gives it."""
        return self._values(values)


def _function_of(node: ast.expr) -> Values:
    """Return the function that an allowed node stands for."""
    match node:
        case ast.Constant(value=number):
            return lambda _: number
        case ast.Name(id=name) if name in _CONSTANTS:
            return lambda _: _CONSTANTS[name]
        case ast.Name(id=name):
            return lambda values: values[name]
        case ast.Call(func=ast.Name(id=name), args=given):
            function, nodes = FUNCTIONS[name], given
        case ast.BinOp(left=one, op=operation, right=other):
            function, nodes = _OPERATORS[type(operation)], [one, other]
        case ast.Compare(left=one, ops=[operation], comparators=[other]):
            function, nodes = _OPERATORS[type(operation)], [one, other]
        case ast.UnaryOp(op=operation, operand=one):
            function, nodes = _OPERATORS[type(operation)], [one]
        case _:
            raise AssertionError(f"{ast.dump(node)} was let through")
    parts = [_function_of(one) for one in nodes]
    return lambda values: function(*(part(values) for part in parts))


def _parsed(field: str, text: str, variables: Sequence[str]) -> ast.expr:
    """Return the syntax tree of a text; all its nodes are allowed, and its numbers are floats."""
    clean = " ".join(text.replace("\t", " ").splitlines())
    if not clean.strip() or len(clean) > _LONGEST:
        raise InvalidInput(field, text, f"an expression of 1 to {_LONGEST} characters", "Give one.")
    ahead = len(clean) - len(clean.lstrip())
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            tree = ast.parse(clean.strip(), mode="eval").body
    except SyntaxError as error:
        place = (error.offset or len(clean.strip()) + 1) + ahead
        what = f"an expression in {spelled(variables)}; {error.msg} at position {place}"
        raise InvalidInput(field, text, what, "Mend the text.") from None
    except (ValueError, RecursionError, MemoryError) as error:
        raise InvalidInput(field, text, "an expression", "Take a shorter one.") from error
    for complaint, node, remedy in _complaints(tree, variables):
        column = len(clean.strip().encode()[: node.col_offset].decode()) + ahead + 1
        raise InvalidInput(field, text, f"{complaint} at position {column}", remedy)
    return tree


def _complaints(tree: ast.expr, variables: Sequence[str]) -> Iterator[tuple[str, ast.expr, str]]:
    """Yield what is allowed, the node that is not, and a remedy; the numbers become floats on the way."""
    known = (*variables, *_CONSTANTS)
    plain = f"an expression of numbers, {spelled(variables)}, + - * / ** and functions"
    waiting: list[tuple[ast.expr, int]] = [(tree, 0)]
    while waiting:
        node, depth = waiting.pop(0)
        head = getattr(node, "op", getattr(node, "func", node))
        remedy = _INSTEAD.get(type(head), _INSTEAD.get(type(node), ""))
        if depth > _DEEPEST:
            yield "fewer operations within one another", node, "Take a function."
        elif isinstance(node, ast.Constant) and isinstance(node.value, int | float):
            if isinstance(node.value, bool):
                yield plain, node, "Write 1 or 0."
            try:
                node.value = float(node.value)
            except OverflowError:
                yield "a number below 1e308", node, "Write it as 1e300."
        elif isinstance(node, ast.Name):
            if node.id not in known:
                near = closest(node.id, (*known, *FUNCTIONS)) or "Take one of these."
                yield f"one of the names {spelled(known)}, not {node.id!r}", node, near
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
            name, count = node.func.id, _TAKES.get(node.func.id, 1)
            if name not in FUNCTIONS:
                near = closest(name, FUNCTIONS) or "Take one of these."
                yield f"one of the functions {spelled(FUNCTIONS)}, not {name!r}", node, near
            elif node.keywords or len(node.args) != count:
                yield f"{count} value(s) in the brackets of {name}", node, "Mend their number."
            waiting += [(one, depth + 1) for one in node.args]
        elif isinstance(node, ast.Compare):
            if len(node.ops) > 1 or type(node.ops[0]) not in _OPERATORS:
                yield "one of < <= > >= between two values", node, "Write (0 < x) & (x < 1)."
            waiting += [(node.left, depth + 1), (node.comparators[0], depth + 1)]
        elif isinstance(node, ast.BinOp) and type(node.op) in _OPERATORS:
            waiting += [(node.left, depth + 1), (node.right, depth + 1)]
        elif isinstance(node, ast.UnaryOp) and type(node.op) in _OPERATORS:
            waiting.append((node.operand, depth + 1))
        else:
            yield f"{plain}, and nothing else,", node, remedy or "Leave that out."
