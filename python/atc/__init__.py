"""A verified train control kernel, as a reference oracle.

Every machine of the protocol speaks in dictionaries, as over the pipe of ``oracle serve``:

    machine = atc.Machine("aspect-acceptance", {"cycle_ms": 50, "aspects_km_h": [25, 45, 65, 90]})
    machine.step({"detected_km_h": [45]})

Three of them take whole columns of NumPy arrays: see :mod:`atc.columns`.
"""

from __future__ import annotations

import json as _json

from ._atc import PROTOCOL, Conversation as _Conversation
from ._atc import machines, schema as _schema

__all__ = ["PROTOCOL", "Machine", "Refused", "machines", "schema"]


class Refused(ValueError):
    """A configuration or a step that is refused; nothing has changed. The text says what would be right."""


def schema() -> dict:
    """The JSON Schema of the protocol."""
    return _json.loads(_schema())


class Machine:
    """One machine with its state.

    Raises :class:`Refused` if there is no such machine, or if the configuration breaks a rule.
    """

    def __init__(self, name: str, config: dict | None = None) -> None:
        self._start = {"protocol": PROTOCOL, "machine": name}
        if config is not None:
            self._start["config"] = config
        self.restart()

    def restart(self) -> None:
        """Back to the initial state, with the same configuration."""
        self._conversation = _Conversation()
        #: The reply to the start: the whole configuration with its defaults, and its times in cycles.
        self.started = self._ask({"start": self._start}, "started")

    def step(self, step: dict) -> dict:
        """One logic cycle. Raises :class:`Refused` if the step has no meaning; the state is as before."""
        return self._ask({"step": step}, "output")

    def steps(self, steps) -> list[dict]:
        """A logic cycle for each. A step that is refused ends it: those before have been done."""
        return [self.step(step) for step in steps]

    def _ask(self, request: dict, right: str) -> dict:
        try:
            line = _json.dumps(request, allow_nan=False)
        except (TypeError, ValueError) as error:
            raise Refused(f"this cannot be said in JSON: {error}") from error
        reply = _json.loads(self._conversation.answer(line))
        if right in reply:
            return reply[right]
        ((_, body),) = reply.items()
        raise Refused(body["reason"])
