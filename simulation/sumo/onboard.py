"""The device on board: the kernel's `train`, on telegrams with codes beside them; and its driver."""

from dataclasses import dataclass, field
from typing import Any

import atc

from line import Line
from motion import ACCELERATION, COMFORTABLE, EMERGENCY, SERVICE, STEP_S

# What `line.toml` says of telegrams for the device on board. The rest of that table is for the ground.
PERMITTED = (
    *("speeds_km_h", "lowest_limit_km_h", "worst_gradient_permille", "brake_mm_s2", "margin_m"),
    *("fresh_ms", "life_ms", "fixed_life_ms", "memory_ms", "window", "run"),
)
# What the odometer may be off.
ODOMETER = 0.01
BRAKE_DELAY_S = 0.5
# How far a driver stays below the permitted speed.
BELOW = 0.5
# What a heedless driver aims at.
HEEDLESS = 40.0


def config(line: Line) -> dict[str, Any]:
    """The configuration of the device."""
    data = line.data
    position = {"tolerance_db": data["position"]["tolerance_db"], "floor_db": data["position"]["floor_db"]}
    table = {name: data["position"][name] for name in ("spacing_m", "lowest_db", "highest_db")}
    return {
        "acceptance": data["times"],
        "supervision": data["supervision"],
        "codes": data["codes"],
        "permitted": {"cycle_ms": data["cycle_ms"], **{name: data["signal"][name] for name in PERMITTED}},
        "position": {"table": table, **position},
    }


def level_db(line: Line, to_exit_m: float) -> float:
    """The level difference of the position signals at a distance: in the middle of what the table has."""
    position = line.data["position"]
    knot, part = divmod(to_exit_m / position["spacing_m"], 1)
    ends = [(position["lowest_db"][at] + position["highest_db"][at]) / 2 for at in (int(knot), int(knot) + 1)]
    return float(round(ends[0] + (ends[1] - ends[0]) * part, 2))


@dataclass
class OnBoard:
    """The device of one train, and its driver."""

    line: Line
    heedless: bool
    cab: dict[str, Any] = field(init=False, default_factory=dict)
    braking_s: float = field(init=False, default=0.0)

    def __post_init__(self) -> None:
        self.machine = atc.Machine("train", config(self.line))
        self.told = False
        self.heard: dict[str, Any] = {}
        self.circuit = ""

    def restart(self) -> None:
        """The driver goes to the other end, where another device starts."""
        self.machine.restart()
        self.told, self.heard, self.circuit, self.braking_s = False, {}, "", 0.0

    def step(self, met: "Met") -> None:
        """One cycle. A code counts that was heard throughout it, and a frame that was heard from begin to end."""
        whole = met.circuit == self.circuit
        code = codes_of(met.feed)
        heard = code if whole and code == self.heard else {}
        frames = met.feed if whole and met.frame_ends and met.feed else {}
        self.heard, self.circuit = code, met.circuit
        level = None if met.to_exit_m is None else level_db(self.line, met.to_exit_m)
        step = {
            "main": {"code_hz": heard.get("main_hz"), "telegram": told("main", frames)},
            "sub": {"code_hz": heard.get("sub_hz"), "telegram": told("sub", frames)},
            "first_db": level,
            "second_db": None if level is None else 0,
            "moved_m": [round(met.moved_m * (1 - ODOMETER), 3), round(met.moved_m * (1 + ODOMETER), 3)],
            "speed_km_h": round(met.speed * 3.6, 1),
            "line": None if self.told else "digital",
            "facing": met.heading,
        }
        self.told = True
        self.cab = self.machine.step(step)
        self.braking_s = 0.0 if self.cab["brake"] == "release" else self.braking_s + STEP_S

    def speed(self, speed: float, may_leave: bool, to_stop_m: float | None) -> float:
        """The speed in the next step, by the brake if it acts, or else by the driver."""
        wanted = self.driven(speed, may_leave, to_stop_m)
        if self.cab["brake"] == "release":
            return wanted
        if self.braking_s <= BRAKE_DELAY_S:
            return min(wanted, speed)
        return max(0.0, speed - (EMERGENCY if self.cab["brake"] == "emergency" else SERVICE) * STEP_S)

    def driven(self, speed: float, may_leave: bool, to_stop_m: float | None) -> float:
        """What the driver does. A heedless one motors whatever the cab says, and the device holds the train."""
        permitted = (self.cab["permitted_km_h"] or 0) / 3.6
        stopped_at_platform = to_stop_m is not None and permitted <= 0
        aim = HEEDLESS if self.heedless and not stopped_at_platform else max(0.0, permitted - BELOW)
        aim = aim if may_leave else 0.0
        if to_stop_m is not None:
            aim = min(aim, (2 * COMFORTABLE * max(0.0, to_stop_m)) ** 0.5)
        if speed > aim + 1:
            return max(0.0, speed - SERVICE * STEP_S)
        if speed > aim:
            return max(0.0, speed - COMFORTABLE * STEP_S)
        return speed + ACCELERATION * STEP_S if speed < aim - 0.3 else speed


@dataclass(frozen=True)
class Met:
    """What a train meets in one cycle."""

    circuit: str
    heading: str
    feed: dict[str, Any] | None
    frame_ends: bool
    to_exit_m: float | None
    moved_m: float
    speed: float


def codes_of(feed: dict[str, Any] | None) -> dict[str, Any]:
    return {carrier: feed[carrier] for carrier in ("main_hz", "sub_hz")} if feed else {}


def told(kind: str, frames: dict[str, Any]) -> dict[str, Any] | None:
    return {kind: frames[kind]} if kind in frames else None
