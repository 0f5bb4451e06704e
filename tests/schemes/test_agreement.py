"""A scheme of one's own whose weights and transform are two schemes is refused; those of the library are one each."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fracparticles.errors import InvalidInput
from fracparticles.schemes import SCHEMES, Setting
from fracparticles.schemes.agreement import refuse_disagreement
from fracparticles.schemes.base import OnePass, Sum
from fracparticles.schemes.kpse import KernelExchange

SETTING = Setting(alpha=1.5, n=20, spacing=0.2)
K = KernelExchange
WRONG = {
    "another sign of the weights": {"values": lambda s, r, one: -K.values(s, r, one)},
    "another sign of the transform": {"transform": lambda s, k, one: -K.transform(s, k, one)},
    "half of the transform": {"transform": lambda s, k, one: 0.5 * K.transform(s, k, one)},
    "a constant more": {"transform": lambda s, k, one: K.transform(s, k, one) + 0.01},
    "a kernel half as wide": {"values": lambda s, r, one: K.values(s, 2.0 * r, one)},
    "whole numbers": {"values": lambda s, r, one: np.round(K.values(s, r, one))},
    "one nan": {"values": lambda s, r, one: np.where(r == 0.0, np.nan, K.values(s, r, one))},
    "three weights": {"values": lambda s, r, one: K.values(s, r, one)[:3]},
    "complex ones": {"values": lambda s, r, one: K.values(s, r, one) + 0j},
    "one value for all waves": {"transform": lambda s, k, one: K.transform(s, k, one).sum()},
}


def scheme(**own) -> OnePass:
    return type("OneOfMyOwn", (KernelExchange,), {"name": "OWN", **own})()


@pytest.mark.parametrize("what", WRONG)
def test_what_is_wrong_is_refused_before_any_run(what):
    with pytest.raises(InvalidInput):
        scheme(**WRONG[what]).operator(SETTING)


def test_the_message_says_both_values():
    with pytest.raises(InvalidInput, match=r"scheme = 'OWN'.*theta = .*it says.*Mend its values"):
        scheme(**WRONG["half of the transform"]).operator(SETTING)


@pytest.mark.parametrize("exterior", ["truncated", "open"])
def test_what_agrees_is_the_scheme_that_it_is_made_of(exterior):
    own = scheme(
        values=lambda s, r, one: K.values(s, r, one),
        transform=lambda s, k, one: K.transform(s, k, one),
    )
    setting, u = replace(SETTING, exterior=exterior), np.exp(-np.square(SETTING.x))
    expected = SCHEMES["KPSE"].operator(setting).apply(u)
    assert (own.operator(setting).apply(u) == expected).all()


@pytest.mark.parametrize("alpha", [1.02, 1.5, 1.98])
@pytest.mark.parametrize("overlap", [1.0, 2.0, 10.0, 40.0])
def test_the_schemes_of_the_library_agree(alpha, overlap):
    for one in SCHEMES.values():
        if isinstance(one, OnePass):
            for order in one.orders:
                setting = Setting(alpha=alpha, order=order, overlap=overlap)
                claimed = one.symbol if isinstance(one, Sum) else one.scaled_transform
                refuse_disagreement(one.name, one.weights, claimed, setting)
