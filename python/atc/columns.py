"""Many logic cycles at once, over NumPy arrays. A row is a cycle.

Either all rows are taken or none: after an error (:class:`ValueError`, with the row) the machine is as it was before.
The state goes on from one call to the next. The configurations are those of the protocol.
"""

from __future__ import annotations

import json as _json

import numpy as _np

from . import _atc

__all__ = ["BLOCK_INPUT", "BLOCK_OUTPUT", "STATUS", "Aspect", "Block", "Pattern"]

#: A cycle's input of a block. ``present`` has bit i for section i, 0 at the entry.
#: ``reset`` is the verified number of trains, or -1.
BLOCK_INPUT = _np.dtype(
    [
        ("present", "<u2"),
        ("check_in", "u1"),
        ("check_out", "u1"),
        ("reset", "<i2"),
        ("ahead_hold_sections", "u1"),
        ("ahead_entered", "u1"),
    ]
)

#: A cycle's output of a block. ``status`` is a place in :data:`STATUS`.
BLOCK_OUTPUT = _np.dtype(
    [("occupied", "<u2"), ("behind_hold_sections", "u1"), ("agree", "u1"), ("count", "u1"), ("status", "u1")]
)

#: What a block's count is worth.
STATUS = ("unverified", "counting", "check-out-at-zero", "check-in-at-maximum", "check-in-stays-on")


def _column(values, kind: str, name: str):
    """The values as an array of one dimension of numbers that fit ``kind``; raises ValueError if one does not."""
    given = _np.atleast_1d(_np.asarray(values))
    if given.ndim != 1 or given.dtype.kind not in "biu":
        raise ValueError(f"{name} must be one column of whole numbers, and has shape {given.shape} of {given.dtype}")
    limits = _np.iinfo(kind)
    if given.size and (int(given.min()) < limits.min or int(given.max()) > limits.max):
        raise ValueError(f"{name} must be {limits.min} to {limits.max}, and is {given.min()} to {given.max()}")
    return given.astype(_np.dtype(kind).newbyteorder("<"))


class Aspect:
    """Aspect acceptance: which aspects are heard, into which one is displayed."""

    def __init__(self, config: dict) -> None:
        self._columns = _atc.AspectColumns(_json.dumps(config))

    def run(self, detected):
        """Sets of aspects (bit i for the aspect of rank i, up to 16) into ranks (int8, -1 for no display)."""
        return _np.frombuffer(self._columns.run(_column(detected, "u2", "detected").tobytes()), "i1")


class Block:
    """Block counting, one block."""

    def __init__(self, config: dict) -> None:
        self._columns = _atc.BlockColumns(_json.dumps(config))

    def run(self, inputs):
        """An array of :data:`BLOCK_INPUT` into one of :data:`BLOCK_OUTPUT`."""
        inputs = _np.atleast_1d(_np.asarray(inputs))
        if inputs.dtype != BLOCK_INPUT or inputs.ndim != 1:
            raise ValueError(f"inputs must be one column of atc.columns.BLOCK_INPUT, and are {inputs.dtype}")
        return _np.frombuffer(self._columns.run(inputs.tobytes()), BLOCK_OUTPUT)


class Pattern:
    """The braking pattern of a train. ``brake_mm_s2``: its service brake on the level, 1 to 4095."""

    def __init__(self, brake_mm_s2: int = 800) -> None:
        self._columns = _atc.PatternColumns(brake_mm_s2)

    def run(self, distance_m, gradient_permille=0):
        """Distances in metres and gradients in thousandths, one each or one for all, into tenths of km/h (uint16)."""
        distance = _column(distance_m, "u2", "distance_m")
        gradient = _column(gradient_permille, "i1", "gradient_permille")
        if gradient.size == 1:
            gradient = _np.broadcast_to(gradient, distance.shape)
        return _np.frombuffer(self._columns.run(distance.tobytes(), gradient.tobytes()), "<u2")
