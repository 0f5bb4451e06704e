"""The coefficients of a problem: a number, a text such as "1 + tanh(x)", or a function.

A text is an expression in the variables of the coefficient, of numbers, + - * / **, comparisons joined by & and |, and
the functions of `FUNCTIONS`. `simpleeval` evaluates it over arrays; before that every node of its syntax tree must be
one of those, so that it has no attributes, no imports, no strings and no whole numbers of many digits. A function is
called with as many of the variables as it takes, in their order.
"""

from __future__ import annotations

import ast
import inspect
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np
from scipy.special import gamma
from simpleeval import SimpleEval

from fracparticles.errors import InvalidInput, reason_of, spelled

__all__ = ["FUNCTIONS", "Coefficient"]

_LONGEST = 2000  # characters; the evaluator descends a level an operation
_DEEPEST = 100

_NUMPY = """
sin cos tan arcsin arccos arctan arctan2 sinh cosh tanh exp expm1 log log1p sqrt abs sign minimum maximum where
"""
FUNCTIONS: dict[str, Callable[..., Any]] = {name: getattr(np, name) for name in _NUMPY.split()} | {
    "gamma": gamma
}
_TAKES = {"where": 3, "arctan2": 2, "minimum": 2, "maximum": 2}
_CONSTANTS = {"pi": np.pi, "e": np.e}


def _of_truth(test: Callable[..., Any], one: Any, other: Any) -> Any:
    """Return 1 where it holds and 0 elsewhere: numbers, which add up."""
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


class Coefficient:
    """A coefficient of some variables, checked.

    Parameters
    ----------
    field : str
        What it is called in messages.
    given : float, str or callable
        The number, the text, or the function.
    variables : sequence of str
        What it may depend on, in the order of the arguments of a function.

    Attributes
    ----------
    depends_on : frozenset of str
        The variables that the text holds; of a function, those that it takes.

    Raises
    ------
    InvalidInput
        With the place in the text, what is there, and what is allowed.
    """

    def __init__(self, field: str, given: Any, variables: Sequence[str]) -> None:
        self.field, self.variables = field, tuple(variables)
        self.given: Any = given.item() if isinstance(given, np.generic) else given
        self._tree: ast.expr | None = None
        if isinstance(given, str):
            self._tree = _parsed(field, given, self.variables)
            named = {node.id for node in ast.walk(self._tree) if isinstance(node, ast.Name)}
            self.depends_on = frozenset(named & set(self.variables))
        elif callable(given):
            self._takes = _arguments_of(field, given, self.variables)
            self.depends_on = frozenset(self.variables[: self._takes])
        elif isinstance(self.given, int | float) and not isinstance(self.given, bool):
            self.depends_on = frozenset()
            if not np.isfinite(self.given):
                raise InvalidInput(field, given, "a finite number", "Mend it.")
        else:
            kinds = f"a number, a text in {spelled(self.variables)}, or a function of them"
            raise InvalidInput(field, given, kinds, "Give one of these.")

    @property
    def reproducible(self) -> bool:
        """Whether it can be written down: a function cannot."""
        return not callable(self.given)

    @property
    def constant(self) -> float | None:
        """The number that it is everywhere and always, or None."""
        if self.depends_on:
            return None
        return float(np.asarray(self(dict.fromkeys(self.variables, 0.0)))) + 0.0

    def __call__(self, values: Mapping[str, Any]) -> np.ndarray:
        """Return its values by those of the variables, of the shape that these broadcast to.

        What overflows is infinite or nan.

        Raises
        ------
        InvalidInput
            If a function fails, or returns something else than a number for each point.
        """
        shape = np.broadcast_shapes(*(np.shape(one) for one in values.values()))
        with np.errstate(all="ignore"):
            result = self._evaluated(values)
        try:
            return np.broadcast_to(np.asarray(result, dtype=float), shape)
        except (TypeError, ValueError) as error:
            raise InvalidInput(
                self.field,
                f"{type(result).__name__} of shape {np.shape(result)}",
                f"one number for each of the points, of shape {shape}",
                "Write it with numpy, or numpy.vectorize it.",
            ) from error

    def _evaluated(self, values: Mapping[str, Any]) -> Any:
        if self._tree is not None:
            names = {name: values[name] for name in self.depends_on} | _CONSTANTS
            # One for each call: an evaluator keeps the names, and threads may share the coefficient.
            return SimpleEval(_OPERATORS, FUNCTIONS, names).eval(self.given, self._tree)
        if not callable(self.given):
            return self.given
        try:
            return self.given(*(_read_only(values[name]) for name in self.variables[: self._takes]))
        except InvalidInput:
            raise
        except Exception as error:  # whatever it may raise
            what = f"a function of arrays of {', '.join(self.variables)} ({reason_of(error)})"
            raise InvalidInput(self.field, self.given, what, "Mend the function.") from error

    def checked(self, values: Mapping[str, Any], least: float | None = None) -> np.ndarray:
        """Return its values if all are finite, and none is below `least`.

        Raises
        ------
        InvalidInput
            With the place and the time where it is not, of several the least.
        """
        result = self(values)
        good = np.isfinite(result)
        if least is not None:
            good &= result >= least
        if good.all():
            return result
        worst = np.where(np.isfinite(result), result, -np.inf) if least is not None else good
        index = np.unravel_index(int(worst.argmin()), result.shape)
        where = ", ".join(
            f"{name} = {float(np.broadcast_to(one, result.shape)[index]):.6g}"
            for name, one in values.items()
        )
        allowed = "finite" if least is None else f"finite and at least {least:g}"
        shown = f"{self.given if isinstance(self.given, str) else 'a function'}"
        raise InvalidInput(
            self.field,
            shown,
            f"a coefficient that is {allowed} everywhere, and it is {result[index]:.6g} at {where}",
            "Mend the coefficient, or the domain.",
        )


def _read_only(value: Any) -> Any:
    """A view that the function cannot change: the array is the integrator's, or the lattice."""
    view = np.asarray(value).view()
    view.flags.writeable = False
    return view


def _parsed(field: str, text: str, variables: Sequence[str]) -> ast.expr:
    """The syntax tree of a text, every node of it allowed, and its numbers floats."""
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
    """What is not allowed, where, and what to do; the numbers become floats on the way."""
    from fracparticles.run.complaints import closest

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


def _arguments_of(field: str, function: Callable[..., Any], variables: Sequence[str]) -> int:
    """How many of the variables a function takes: as many as it can."""
    counts = range(len(variables), 0, -1)
    if isinstance(function, np.ufunc):
        takes = [count for count in counts if count == function.nin]
    else:
        try:
            signature = inspect.signature(function)
        except (TypeError, ValueError):  # of one written in C
            return len(variables)
        takes = [count for count in counts if _binds(signature, count)]
    if not takes:
        wanted = f"a function of {', '.join(variables)}, or of the first of these"
        raise InvalidInput(field, function, wanted, "Mend its arguments.")
    return takes[0]


def _binds(signature: inspect.Signature, count: int) -> bool:
    try:
        signature.bind(*range(count))
    except TypeError:
        return False
    return True
