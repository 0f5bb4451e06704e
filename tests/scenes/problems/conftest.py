"""The scene that a test module is called after, its study and its figure.

The grid is the smoke grid, but for the PARAMETERS of the module.
"""

from __future__ import annotations

import pytest

from fracstudy.inputs import Inputs
from fracstudy.scene import call
from scene_functions import scenes


@pytest.fixture(scope="module")
def scene(request):
    return scenes()[request.module.__name__.removeprefix("test_").removesuffix("_scene")]


@pytest.fixture(scope="module")
def parameters(request, scene):
    return scene.parameters | getattr(request.module, "PARAMETERS", {})


@pytest.fixture(scope="module")
def result(scene, parameters):
    return call(scene.function("study"), Inputs(scene.name), **parameters)


@pytest.fixture(scope="module")
def panels(scene, result, parameters):
    """The axes of the figure, drawn."""
    return call(scene.function("figure"), result.series, **parameters).axes
