"""Parameters of the shipped machines at both ends of their ranges: a machine, or an error that says why."""

import re

import pytest

import mainspring as ms
from conftest import MODELS

ENDS = [
    pytest.param(model, p.name, value, id=f"{model.stem}-{p.name}-{value:g}")
    for model in MODELS
    for p in ms.load(model).parameters
    for value in p.range or ()
]


@pytest.mark.parametrize(("model", "name", "value"), ENDS)
def test_ends_of_ranges_make_a_machine_or_an_error_that_says_why(model, name, value):
    machine = ms.load(model)
    try:
        mechanism = machine.compile({name: value})
    except ms.InputError as error:
        assert re.match(rf".*{re.escape(model.name)}:\d+:\d+: error: .*; expected ", str(error))
        assert f"{name} = {value:g}" in str(error) or "overlap at the start" in str(error)
    else:
        assert ms.find_pairs(mechanism).pairs
