"""Trains as bodies: where they are on the ground, by what SUMO says of them; and what is unsafe about it."""

from dataclasses import dataclass
from typing import Any

from traci import constants as tc

from line import WEST, Line, Piece

STEP_S = 0.1
LENGTH_M = 160.0
ACCELERATION, SERVICE, EMERGENCY, COMFORTABLE = 0.7, 0.9, 1.2, 0.6
# Where trains stop, before the end of the track: in both circuits of it. A train that stands in the last circuit alone
# hears no code when it goes back, as its route begins in the other one.
BEFORE_THE_END_M = 80.0
# Up to here from its toe the legs of a point are too close for two trains: they are 5 m apart there.
FOULING_M = 30.0


@dataclass(frozen=True)
class Body:
    """A train on the ground: the stretch of each piece under it, in metres from the piece's western end."""

    edge: str
    position_m: float
    speed: float
    ahead: tuple[str, ...]
    stretches: dict[str, tuple[float, float]]

    @property
    def piece(self) -> str:
        return self.edge.removeprefix("-")

    @property
    def heading(self) -> str:
        return "left" if self.edge.startswith("-") else "right"


WATCHED = [tc.VAR_EDGES, tc.VAR_ROUTE_INDEX, tc.VAR_ROAD_ID, tc.VAR_LANEPOSITION, tc.VAR_SPEED]


def seen(line: Line, told: dict[int, Any]) -> Body:
    """A train as SUMO tells of it: its front on an edge, and behind it as much of its way as it is long."""
    route, at, road, position, speed = (told[variable] for variable in WATCHED)
    if road.startswith(":"):
        # On a joint: the edge behind it is the last one of its route.
        at, position = at + 1, 0.0
    rest, stretches = LENGTH_M, {}
    for place, edge in enumerate(reversed(route[: at + 1])):
        piece = line.pieces[edge.removeprefix("-")]
        front = position if place == 0 else piece.length_m
        rear = max(0.0, front - rest)
        forwards = not edge.startswith("-")
        stretches[piece.name] = (rear, front) if forwards else (piece.length_m - front, piece.length_m - rear)
        rest -= front - rear
        if rest < 0.001:
            break
    return Body(route[at], position, speed, tuple(route[at + 1 :]), stretches)


def occupied(line: Line, bodies: list[Body]) -> set[str]:
    """The circuits with a train."""
    return {line.pieces[name].circuit for body in bodies for name in body.stretches}


def share_ground(line: Line, one: Body, other: Body) -> bool:
    """Whether two trains share ground: metres of a piece, or the part of a point where its legs are close."""
    for name, (west, east) in one.stretches.items():
        for there, (its_west, its_east) in other.stretches.items():
            if name == there and west < its_east and its_west < east:
                return True
            piece, its = line.pieces[name], line.pieces[there]
            legs_of_one = piece.point is not None and piece.point == its.point and name != there
            nearest = max(from_toe_m(piece, (west, east)), from_toe_m(its, (its_west, its_east)))
            if legs_of_one and nearest < FOULING_M:
                return True
    return False


def from_toe_m(leg: Piece, stretch: tuple[float, float]) -> float:
    """How near to the toe a train is on a leg of a point."""
    toe_is_east = leg.point is not None and leg.point[0] == WEST
    return leg.length_m - stretch[1] if toe_is_east else stretch[0]
