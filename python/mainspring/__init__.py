"""Mainspring: from the shapes of a machine to how it moves and what it will do.

>>> import mainspring as ms
>>> mechanism = ms.load("escapement.padl").compile(gap=36)
>>> ms.predict(mechanism).sentences

Angles are radians, lengths and times the model file's own units. Everything returned is frozen.
Names are loaded on first use, so that importing the package costs next to nothing.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from mainspring._core import InputError as InputError
    from mainspring.builder import Arc as Arc
    from mainspring.builder import Builder as Builder
    from mainspring.builder import Circle as Circle
    from mainspring.builder import Close as Close
    from mainspring.builder import Fixed as Fixed
    from mainspring.builder import Layer as Layer
    from mainspring.builder import Line as Line
    from mainspring.builder import Path as Path
    from mainspring.builder import Slides as Slides
    from mainspring.builder import Turns as Turns
    from mainspring.machine import Machine as Machine
    from mainspring.machine import Mechanism as Mechanism
    from mainspring.machine import Parameter as Parameter
    from mainspring.machine import load as load
    from mainspring.machine import parse as parse
    from mainspring.pairs import Kinematics as Kinematics
    from mainspring.pairs import Pair as Pair
    from mainspring.pairs import Subsystem as Subsystem
    from mainspring.pairs import find_pairs as find_pairs
    from mainspring.prediction import Hypothesis as Hypothesis
    from mainspring.prediction import Pattern as Pattern
    from mainspring.prediction import Prediction as Prediction
    from mainspring.prediction import predict as predict
    from mainspring.simulation import Energy as Energy
    from mainspring.simulation import Event as Event
    from mainspring.simulation import Simulation as Simulation
    from mainspring.simulation import Trajectory as Trajectory
    from mainspring.simulation import simulate as simulate
    from mainspring.space import ConfigurationSpace as ConfigurationSpace
    from mainspring.space import configuration_space as configuration_space

__version__ = "0.1.0"

_HOME = {
    "InputError": "_core",
    "parse": "machine",
    "Arc": "builder",
    "Builder": "builder",
    "Circle": "builder",
    "Close": "builder",
    "Fixed": "builder",
    "Layer": "builder",
    "Line": "builder",
    "Path": "builder",
    "Slides": "builder",
    "Turns": "builder",
    "Machine": "machine",
    "Mechanism": "machine",
    "Parameter": "machine",
    "load": "machine",
    "Kinematics": "pairs",
    "Pair": "pairs",
    "Subsystem": "pairs",
    "find_pairs": "pairs",
    "Hypothesis": "prediction",
    "Pattern": "prediction",
    "Prediction": "prediction",
    "predict": "prediction",
    "Energy": "simulation",
    "Event": "simulation",
    "Simulation": "simulation",
    "Trajectory": "simulation",
    "simulate": "simulation",
    "ConfigurationSpace": "space",
    "configuration_space": "space",
}

__all__ = [
    "Arc",
    "Builder",
    "Circle",
    "Close",
    "ConfigurationSpace",
    "Energy",
    "Event",
    "Fixed",
    "Hypothesis",
    "InputError",
    "Kinematics",
    "Layer",
    "Line",
    "Machine",
    "Mechanism",
    "Pair",
    "Parameter",
    "Path",
    "Pattern",
    "Prediction",
    "Simulation",
    "Slides",
    "Subsystem",
    "Trajectory",
    "Turns",
    "__version__",
    "configuration_space",
    "find_pairs",
    "load",
    "parse",
    "predict",
    "simulate",
]


def __getattr__(name: str) -> Any:  # noqa: ANN401
    """Load a public name from its module on first use."""
    if name not in _HOME:
        raise AttributeError(f"module 'mainspring' has no attribute {name!r}")
    return getattr(import_module(f"mainspring.{_HOME[name]}"), name)


def __dir__() -> list[str]:
    """List the public names."""
    return sorted(__all__)
