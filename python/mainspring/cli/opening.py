"""From options to a mechanism, its start state and its warnings."""

import sys
from argparse import Namespace
from typing import Any, TypedDict

import mainspring as ms
from mainspring.cli import values


def mechanism(options: Namespace) -> "ms.Mechanism":
    """Load and compile the machine the options name."""
    settings = values.settings(options.set)
    clearance = values.at_least_zero(options.pair_clearance, "--pair-clearance")
    machine = ms.load(options.model, options.supplement)
    return machine.compile(settings, pair_clearance=clearance, keep_axial=options.keep_axial)


class Start(TypedDict):
    """Start positions and velocities by part, radians or the file's length."""

    positions: dict[str, float]
    velocities: dict[str, float]


def start(options: Namespace, mechanism: "ms.Mechanism") -> Start:
    """Return the start positions and velocities of the options."""
    if not options.position and not options.velocity:
        return {"positions": {}, "velocities": {}}
    parts = mechanism.outlines()["parts"]
    motions = {p["name"]: p["motion"]["kind"] for p in parts if p["motion"]}
    return {
        "positions": values.coordinates(options.position, "--position", motions),
        "velocities": values.coordinates(options.velocity, "--velocity", motions),
    }


class Contact(TypedDict):
    """The model of contact, its constants and the tolerance."""

    contact: Any
    contact_constants: tuple[float, float, float] | None
    rtol: float | None


def contact(options: Namespace) -> Contact:
    """Return how contact is to be modelled."""
    told, rtol = options.contact_constants, options.rtol
    return {
        "contact": options.contact,
        "contact_constants": None if told is None else values.constants(told, "--contact-constants"),
        "rtol": None if rtol is None else values.positive(rtol, "--rtol"),
    }


def warn(lines: tuple[str, ...]) -> None:
    """Print the core's warnings, each a line of its own, on standard error."""
    for line in lines:
        print(line, file=sys.stderr)
