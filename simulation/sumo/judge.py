"""What a run is judged by: the trains as SUMO has them, and nothing that a device says."""

from dataclasses import dataclass, field
from itertools import combinations

import traci

from ground import Ground
from line import Line
from motion import STEP_S, Body, share_ground

# A train is too fast from here on.
TOLERANCE_KM_H = 1.0


@dataclass
class Judge:
    """Counts what is unsafe. An accident counts once, however long it lasts."""

    line: Line
    sumo_collisions: list[tuple[float, str]] = field(default_factory=list)
    shared_ground: list[float] = field(default_factory=list)
    wrong_points: int = 0
    hardest_braking: float = 0.0
    too_fast_s: float = 0.0
    lost: int = 0

    def __post_init__(self) -> None:
        self.colliding: set[frozenset[str]] = set()
        self.sharing: set[frozenset[str]] = set()
        self.wrong: set[tuple[str, str]] = set()
        self.speeds: dict[str, float] = {}

    def look(self, now: float, bodies: dict[str, Body], trains: int, ground: Ground | None) -> None:
        self.lost = trains - len(bodies)
        self.ask_sumo(now)
        sharing = set()
        for (one, body), (other, its) in combinations(bodies.items(), 2):
            if share_ground(self.line, body, its):
                sharing.add(frozenset({one, other}))
        self.shared_ground += [now] * len(sharing - self.sharing)
        self.sharing = sharing
        for train, body in bodies.items():
            self.hardest_braking = max(self.hardest_braking, (self.speeds.get(train, 0.0) - body.speed) / STEP_S)
            self.speeds[train] = body.speed
            limit = min(self.line.pieces[name].limit_km_h for name in body.stretches)
            self.too_fast_s += STEP_S if body.speed * 3.6 > limit + TOLERANCE_KM_H else 0.0
        if ground is not None:
            self.look_at_points(bodies, ground)

    def ask_sumo(self, now: float) -> None:
        """The collisions that SUMO itself sees."""
        colliding = {}
        for collision in traci.simulation.getCollisions():
            colliding[frozenset({collision.collider, collision.victim})] = collision.type
        self.sumo_collisions += [(now, kind) for pair, kind in colliding.items() if pair not in self.colliding]
        self.colliding = set(colliding)

    def look_at_points(self, bodies: dict[str, Body], ground: Ground) -> None:
        """A train on a leg of a point that does not stand for it, or that moves."""
        wrong = set()
        for train, body in bodies.items():
            for piece in (self.line.pieces[name] for name in body.stretches):
                if piece.point is None:
                    continue
                station, point = piece.point
                if ground.stations[station].points[point].detected() != piece.position:
                    wrong.add((train, piece.name))
        self.wrong_points += len(wrong - self.wrong)
        self.wrong = wrong

    @property
    def is_unsafe(self) -> bool:
        return bool(self.sumo_collisions or self.shared_ground or self.wrong_points or self.lost)
