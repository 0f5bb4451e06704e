"""What holds of the fields of a case: it is whole, and known by its text and its path, or refused in a line."""

# ruff: noqa: B008  an argument of a property is drawn from its default

import json
from math import isfinite
from pathlib import PurePosixPath
from typing import Any

from hypothesis import strategies as st

from fracparticles.errors import InvalidInput
from fracparticles.run.case import Case
from scenes.extremes.fuzzing.cases import as_given, cases, changed
from scenes.extremes.fuzzing.harness import always
from scenes.extremes.fuzzing.strategies import anything, fields_of, given_fields, texts

_LONGEST_NAME = 255  # bytes, of a file


@st.composite
def _nearly(draw: st.DrawFn) -> dict[str, Any]:
    """Draw the fields of a case that is allowed, and change one or two."""
    case = draw(cases())
    fields = as_given(case)
    for name in draw(st.lists(st.sampled_from(list(Case.model_fields)), min_size=1, max_size=2)):
        fields[name] = draw(st.one_of(fields_of(Case)[name], fields_of(Case)[name], anything()))
    return fields


_JSON = st.recursive(
    st.one_of(st.none(), st.booleans(), st.integers(-5, 10**20), st.floats(), texts()),
    lambda inner: st.one_of(
        st.lists(inner, max_size=3), st.dictionaries(texts(), inner, max_size=3)
    ),
    max_leaves=6,
)
_TEXTS = st.one_of(
    anything(),
    _JSON.map(json.dumps),
    given_fields(Case).map(lambda given: json.dumps(given, default=str)),
    st.tuples(cases(), st.integers(0, 400), texts()).map(
        lambda parts: parts[0].to_json()[: parts[1]] + parts[2] + parts[0].to_json()[parts[1] :]
    ),
)


@always("fields of a case", "a whole case, or a line", share=20)
def _whole(given=st.one_of(given_fields(Case), _nearly())):
    """A case of any fields is refused, or is a case."""
    return 2.0 * _wrong(Case(**given))


def _wrong(case: Case) -> bool:
    """Whether a case differs from what its text says, has no path of its own, or numbers that do not fit together."""
    path = PurePosixPath(case.path)
    end = case.t_initial + case.time_step * case.steps if case.steps else case.t_final
    return (
        Case.from_json(case.to_json()) != case
        or Case.from_json(case.to_json()).path != case.path
        or path.is_absolute()
        or ".." in path.parts
        or not all(
            part.isprintable() and len(part.encode()) <= _LONGEST_NAME for part in path.parts
        )
        or case.particles != (2 * case.n + 1) ** case.dim
        or not all(map(isfinite, (case.reach, case.extent, case.particle_spacing, case.span)))
        or abs(case.particle_spacing * case.n - case.extent) > 1e-12 * case.extent
        or abs(end - case.t_final) > 1e-12 * case.t_final
    )


@always("another field", "another case, another path", share=5)
def _another(case=cases(), other=st.fixed_dictionaries({}, optional=fields_of(Case))):
    """A case with another value of a field is another case, with another path; one that is given again the same."""
    wrong = _wrong(case)
    for name, value in other.items():
        try:
            new = changed(case, **{name: value})
        except InvalidInput:
            continue
        same = json.loads(new.to_json()) == json.loads(case.to_json())
        wrong |= (new == case) != same or _wrong(new)
        # A default that is given differs in its text only.
        wrong |= new.path == case.path and new.setting != case.setting
    return 2.0 * wrong


@always("text of a case", "a whole case, or a line", share=10)
def _read(text=_TEXTS):
    """Any text is a case or refused."""
    return 2.0 * _wrong(Case.from_json(text))
