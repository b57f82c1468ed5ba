"""The line: the layouts of both stations, joined into pieces of track. A piece is an edge of SUMO's network."""

import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

EAST, WEST = "East", "West"
FOLDER = Path(__file__).parent


@dataclass(frozen=True)
class Piece:
    """A piece of track: a circuit, or one leg of the point of a circuit."""

    name: str
    circuit: str
    west: str
    east: str
    length_m: float
    limit_km_h: float
    point: tuple[str, str] | None = None
    position: str | None = None


@dataclass(frozen=True)
class Platform:
    """A track of a station where trains stop: its pieces from west to east, and its routes."""

    station: str
    number: int
    pieces: tuple[str, ...]
    leg: str
    enter: str
    leave: str

    @property
    def key(self) -> tuple[str, int]:
        return self.station, self.number


@dataclass(frozen=True)
class Line:
    """Two stations and the single line between them."""

    data: dict[str, Any]
    layouts: dict[str, dict[str, Any]]
    pieces: dict[str, Piece]
    blocks: tuple[str, ...]
    platforms: dict[tuple[str, int], Platform]

    def way(self, origin: Platform, target: Platform) -> list[str]:
        """The edges from one platform to one of the other station; westwards each has a minus."""
        west, east = (origin, target) if origin.station == WEST else (target, origin)
        eastwards = [*west.pieces, west.leg, *self.blocks, east.leg, *east.pieces]
        return eastwards if origin is west else ["-" + name for name in reversed(eastwards)]

    def entry_block(self, target: Platform) -> str:
        """The block, last but one, in which a train is when its route into the station is asked for."""
        return self.blocks[-2] if target.station == EAST else self.blocks[1]

    @property
    def cycle_s(self) -> float:
        """The cycle of the devices of the stations."""
        return float(self.layouts[WEST]["times"]["cycle_ms"]) / 1000

    def circuits(self, station: str) -> dict[str, str]:
        """The circuits that a station sees: the name on the ground, and its own name."""
        names = [circuit["name"] for circuit in self.layouts[station]["circuit"]]
        return {on_the_ground(self.layouts[station], name): name for name in names}


def on_the_ground(layout: dict[str, Any], circuit: str) -> str:
    """Circuits of the line have one name in both layouts; all others have that of their station before it."""
    return circuit if circuit in layout["segment"][0]["circuits"] else f"{layout['name']}.{circuit}"


def read() -> Line:
    """The line of `line.toml`, and of its layouts."""
    data = tomllib.loads((FOLDER / "line.toml").read_text())
    files = [tomllib.loads((FOLDER / station["file"]).read_text()) for station in data["station"]]
    layouts = {layout["name"]: layout for layout in files}
    pieces = {piece.name: piece for layout in layouts.values() for piece in pieces_of(layout)}
    on_line = [name for layout in layouts.values() for name in layout["segment"][0]["circuits"]]
    platforms = [platform for layout in layouts.values() for platform in platforms_of(layout, pieces)]
    blocks = tuple(sorted(set(on_line)))
    return Line(data, layouts, pieces, blocks, {platform.key: platform for platform in platforms})


def pieces_of(layout: dict[str, Any]) -> list[Piece]:
    """The pieces of a station, and of the line as far as it sees it."""
    station, speed = layout["name"], layout["speed"]["line_kmh"]
    pieces = []
    for circuit in layout["circuit"]:
        if "left" not in circuit:
            continue
        name = on_the_ground(layout, circuit["name"])
        joints = (joint(layout, circuit["left"]), joint(layout, circuit["right"]))
        pieces.append(Piece(name, name, *joints, circuit["length_m"], speed))
    for point in layout["point"]:
        length = next(one["length_m"] for one in layout["circuit"] if one["name"] == point["circuit"])
        toe = joint(layout, point["toe"])
        for position, limit in (("normal", speed), ("reverse", layout["speed"]["reverse_kmh"])):
            leg = joint(layout, point[position])
            ends = (leg, toe) if station == WEST else (toe, leg)
            circuit = on_the_ground(layout, point["circuit"])
            name = f"{circuit}.{position}"
            pieces.append(Piece(name, circuit, *ends, length, limit, (station, point["name"]), position))
    return pieces


def joint(layout: dict[str, Any], name: str) -> str:
    """Joints of the line have one name in both layouts."""
    line = [one for one in layout["circuit"] if one["name"] in layout["segment"][0]["circuits"]]
    shared = {circuit[end] for circuit in line for end in ("left", "right")}
    return name if name in shared else f"{layout['name']}.{name}"


def platforms_of(layout: dict[str, Any], pieces: dict[str, Piece]) -> list[Platform]:
    """The platforms of a station, each with the route that leads in and the one that leads out."""
    station, routes = layout["name"], layout["route"]
    platforms = []
    for number, platform in enumerate(layout["platform"], 1):
        own = platform["circuits"]
        names = tuple(on_the_ground(layout, name) for name in own)
        enter = next(route["name"] for route in routes if set(own) < set(route["path"]))
        leave = next(route["name"] for route in routes if route["entry"] in own)
        ends = {pieces[name].west for name in names} | {pieces[name].east for name in names}
        legs = [piece for piece in pieces.values() if piece.point and {piece.west, piece.east} & ends]
        platforms.append(Platform(station, number, names, legs[0].name, enter, leave))
    return platforms
