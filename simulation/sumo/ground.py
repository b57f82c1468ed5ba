"""The ground: the device of each station is the kernel's `wayside`, with its point, its transmitters, its neighbour."""

from dataclasses import dataclass, field
from random import Random
from typing import Any

import atc
from line import EAST, WEST, Line, on_the_ground

# Code frequencies of both carriers: speed `i` of the line has the `i`-th of each. A line may have fewer speeds.
MAIN_HZ = [10, 12.5, 15, 18.5, 22, 29, 36, 41.5]
SUB_HZ = [9, 12, 16.5, 21, 24, 27, 32, 38.5]
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
        """What the transmitters say. A circuit has one pair of section numbers for both stations."""
        layout = self.line.layouts[self.name]
        numbers = section_numbers(self.line)
        circuits = {}
        for circuit in layout["circuit"]:
            number = numbers[on_the_ground(layout, circuit["name"])]
            facing = {"gradient_permille": 0, "curve_km_h": self.line.speeds_km_h[-1]}
            circuits[circuit["name"]] = {
                "left": {"section": number + 1, **facing},
                "right": {"section": number, **facing},
            }
        return {"speeds_km_h": self.line.speeds_km_h, "codes": codes(self.line), "circuits": circuits}

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


def codes(line: Line) -> dict[str, Any]:
    """The pairs of codes, as trains and stations have them."""
    pairs = zip(MAIN_HZ, SUB_HZ, line.speeds_km_h, strict=False)
    named = [{"main_hz": main, "sub_hz": sub, "speed_km_h": speed} for main, sub, speed in pairs]
    return {"tolerance_hz": 0.4, "pairs": named}


def section_numbers(line: Line) -> dict[str, int]:
    """The section number of each circuit for trains to the right; for those to the left it is the next one."""
    names = {name for station in line.layouts for name in line.circuits(station)}
    return {name: 2 * place for place, name in enumerate(sorted(names))}
