"""The ground: the device of each station is the kernel's `wayside`, with its point, its transmitters, its neighbour."""

from dataclasses import dataclass, field
from random import Random
from typing import Any

import atc

from line import EAST, WEST, Line

# For how long consent between stations counts.
CONSENT_MS = 1000
# How long the stroke of a point takes: so long at least, and at most. The layouts count on 7 s.
STROKE_MS = (5000, 7000)


@dataclass
class Point:
    """A point as it lies."""

    stroke_ms: int
    position: str = "normal"
    moves_ms: int = 0

    def detected(self) -> str | None:
        return None if self.moves_ms > 0 else self.position


@dataclass
class Station:
    """A station at work."""

    line: Line
    name: str
    session: int
    random: Random
    points: dict[str, Point] = field(init=False)
    output: dict[str, Any] = field(init=False, default_factory=dict)
    messages: dict[str, Any] = field(init=False, default_factory=dict)
    started: bool = field(init=False, default=False)

    def __post_init__(self) -> None:
        layout = self.line.layouts[self.name]
        self.names = self.line.circuits(self.name)
        self.points = {point["name"]: Point(self.random.randint(*STROKE_MS)) for point in layout["point"]}
        config = {"layout": layout, "life_ms": CONSENT_MS, "session": self.session, "signals": self.signals()}
        self.machine = atc.Machine("wayside", config)

    def signals(self) -> dict[str, Any]:
        """What the transmitters say."""
        data = self.line.data
        sections = {section["number"]: section for section in data["section"]}
        own = [telegram for telegram in data["telegram"] if telegram["station"] == self.name]
        circuits = {
            telegram["circuit"]: {heading: facing(sections[telegram[heading]]) for heading in ("left", "right")}
            for telegram in own
        }
        return {"speeds_km_h": data["signal"]["speeds_km_h"], "codes": data["codes"], "circuits": circuits}

    def step(self, occupied: set[str], request: dict[str, str] | None) -> None:
        """One cycle. The transmitters take its frames and codes at once, and send them until the next one."""
        self.drive()
        own = list(self.names.values())
        step = {
            "occupied": [own for name, own in self.names.items() if name in occupied],
            "detected": {name: point.detected() for name, point in self.points.items()},
            "request": request,
            "messages": self.messages,
            "all_telegrams": True,
        }
        if not self.started:
            # Staff know that every train stands at a platform.
            step["orders"] = {"unblock": own, "lift": own}
        self.started = True
        self.output = self.machine.step(step)

    def drive(self) -> None:
        """Drives the points where the device wants them."""
        drives = self.output.get("drives", {})
        for name, point in self.points.items():
            point.moves_ms = max(0, point.moves_ms - round(self.line.cycle_s * 1000))
            if point.moves_ms == 0 and drives.get(name, point.position) != point.position:
                point.position, point.moves_ms = drives[name], point.stroke_ms


@dataclass
class Ground:
    """Both stations."""

    line: Line
    seed: int

    def __post_init__(self) -> None:
        random = Random(self.seed)
        names = enumerate((WEST, EAST), 1)
        self.stations = {name: Station(self.line, name, session, random) for session, name in names}

    def step(self, occupied: set[str], requests: dict[str, dict[str, str]]) -> None:
        """One cycle of both; then each hears what the other has said."""
        for name, station in self.stations.items():
            station.step(occupied, requests.get(name))
        west, east = self.stations[WEST], self.stations[EAST]
        west.messages, east.messages = east.output["messages"], west.output["messages"]

    def feed(self, circuit: str, heading: str) -> dict[str, Any] | None:
        """What is sent in a circuit to trains of a heading. Two stations at once are heard as none."""
        feeds = []
        for station in self.stations.values():
            transmission = station.output.get("transmissions", {}).get(station.names.get(circuit, ""))
            if transmission is not None:
                feeds.append(transmission[heading])
        return feeds[0] if len(feeds) == 1 else None


def facing(section: dict[str, Any]) -> dict[str, Any]:
    """What trains of one heading are told of a circuit."""
    gradient, limit = section["gradient_permille"], section["limit_km_h"]
    return {"section": section["number"], "gradient_permille": gradient, "curve_km_h": limit}
