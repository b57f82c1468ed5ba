"""Trains of SUMO to and fro between two stations on a single line, under SUMO's signals, under none, or under ours.

python run.py --way ours --seconds 3600     # prints one line of JSON for each way; without --way all of them

The exit status is 1 if anything unsafe happened where our devices are in charge, and 2 if a run did not come about.
"""

import argparse
import contextlib
import json
import sys
import tempfile
from pathlib import Path
from typing import Any

import atc
import traci

import line as track
import network
from dispatcher import Dispatcher
from ground import Ground
from judge import Judge
from line import Line, Platform
from motion import ACCELERATION, BEFORE_THE_END_M, EMERGENCY, LENGTH_M, SERVICE, STEP_S, WATCHED, Body, occupied, seen
from onboard import Met, OnBoard

OURS = "ours"
WAYS = {"signals": network.BOTH_ENDS, "one-end": network.ONE_END, "none": network.NOWHERE, OURS: network.NOWHERE}
# Of SUMO's checks of a speed from outside only traction and brake are left: it protects no train of ours.
TRACTION_AND_BRAKE = 6
FOREVER_S = 1e6
# Where trains stand first, before the exit of their track.
BEFORE_THE_EXIT_M = 10.0


class Run:
    """One way of running the line."""

    def __init__(self, line: Line, way: str, trains: int, seed: int, heedless: bool, mutant: bool) -> None:
        self.line, self.way = line, way
        self.seed, self.heedless, self.mutant = seed, heedless, mutant
        self.starts = starts(line, trains)
        self.dispatcher = Dispatcher(line, self.starts, seed)
        self.judge = Judge(line)
        self.ground = Ground(line, seed) if way == OURS else None
        self.onboard = {train: OnBoard(line, heedless) for train in self.starts} if way == OURS else {}
        self.headings: dict[str, str] = {}
        self.ways: dict[str, list[str]] = {}
        self.steps = 0
        self.unseen: str | None = None

    def run(self, seconds: float) -> dict[str, Any]:
        """Runs SUMO for so long, and tells what happened."""
        with tempfile.TemporaryDirectory() as folder:
            self.start(Path(folder))
            try:
                self.place()
                while self.steps * STEP_S < seconds:
                    self.step()
            finally:
                traci.close()
        return self.told(seconds)

    def start(self, folder: Path) -> None:
        net = network.build(self.line, folder, WAYS[self.way])
        options = ["--step-length", str(STEP_S), "--collision.action", "warn", "--collision.check-junctions", "true"]
        quiet = ["--no-step-log", "true", "--no-warnings", "true", "--time-to-teleport", "-1"]
        # `traci` prints that it waits for SUMO; the standard output is for the results.
        with contextlib.redirect_stdout(sys.stderr):
            program = str(network.PROGRAMS / "sumo")
            traci.start([program, "-n", str(net), "-r", str(train_type(folder)), *options, *quiet], stdout=sys.stderr)

    def place(self) -> None:
        """Puts every train to its platform, at the exit and ready to leave."""
        for train, platform in self.starts.items():
            edge = outwards(platform)[-1]
            mark = self.line.pieces[edge.removeprefix("-")].length_m - BEFORE_THE_EXIT_M
            traci.route.add(train, [edge])
            traci.vehicle.add(train, train, typeID="train", departPos=str(mark))
            traci.vehicle.setStop(train, edge, pos=mark, duration=FOREVER_S)
        traci.simulationStep()
        for train in self.starts:
            traci.vehicle.subscribe(train, WATCHED)
        if self.way == OURS:
            for train in self.starts:
                traci.vehicle.setSpeedMode(train, TRACTION_AND_BRAKE)
                traci.vehicle.setDecel(train, EMERGENCY)
                traci.vehicle.setSpeed(train, 0)

    def step(self) -> None:
        """A tenth of a second."""
        traci.simulationStep()
        self.steps += 1
        now = self.steps * STEP_S
        told = traci.vehicle.getAllSubscriptionResults()
        bodies = {train: seen(self.line, told[train]) for train in self.starts if train in told}
        self.judge.look(now, bodies, len(self.starts), self.ground)
        for train, body in bodies.items():
            self.dispatcher.follow(now, train, body)
        for train in self.dispatcher.departures(now):
            if train in bodies:
                self.leave(train)
        if self.ground is not None:
            self.cycle(now, bodies, self.ground)

    def leave(self, train: str) -> None:
        """Gives a train its way. SUMO turns one that has arrived round where it stands."""
        agent = self.dispatcher.agents[train]
        assert agent.target is not None
        way = self.ways[train] = self.line.way(agent.at, agent.target)
        if traci.vehicle.isStopped(train):
            traci.vehicle.resume(train)
        arrived = traci.vehicle.getRoadID(train) not in way
        traci.vehicle.setRoute(train, [inwards(agent.at)[-1], *way] if arrived else way[1:])
        if self.way != OURS:
            mark = self.line.pieces[way[-1].removeprefix("-")].length_m - BEFORE_THE_END_M
            traci.vehicle.setStop(train, way[-1], pos=mark, duration=FOREVER_S)

    def cycle(self, now: float, bodies: dict[str, Body], ground: Ground) -> None:
        """A cycle of our devices: every train, and in its own time the ground."""
        for train, body in bodies.items():
            self.drive(train, body, ground)
        if self.steps % round(self.line.cycle_s / STEP_S) != 0:
            return
        proceed = {name: station.output.get("proceed", []) for name, station in ground.stations.items()}
        fronts = {train: self.line.pieces[body.piece].circuit for train, body in bodies.items()}
        requests = self.dispatcher.requests(now, proceed, fronts)
        ground.step(self.reported(bodies), requests)
        for name, station in ground.stations.items():
            self.dispatcher.answered(now, name, station.output["answer"])

    def reported(self, bodies: dict[str, Body]) -> set[str]:
        """The circuits that are reported occupied. With the mutant the first train that is well out on the line is
        never reported again."""
        if self.mutant and self.unseen is None:
            between = set(self.line.blocks[1:-1])
            self.unseen = next((train for train, body in bodies.items() if set(body.stretches) <= between), None)
        return occupied(self.line, [body for train, body in bodies.items() if train != self.unseen])

    def drive(self, train: str, body: Body, ground: Ground) -> None:
        """A cycle on board, and the speed that follows from it."""
        device, agent = self.onboard[train], self.dispatcher.agents[train]
        if self.headings.get(train) != body.heading:
            device.restart()
            self.headings[train] = body.heading
        piece = self.line.pieces[body.piece]
        # Frames are sent in turn: first one for trains to the left, and then one for trains to the right.
        frame_ends = body.heading == ("left" if self.steps % 2 == 1 else "right")
        to_exit_m = None if piece.point else piece.length_m - body.position_m
        feed = ground.feed(piece.circuit, body.heading)
        device.step(Met(piece.circuit, body.heading, feed, frame_ends, to_exit_m, body.speed * STEP_S, body.speed))
        may_leave = agent.target is not None and body.edge in self.ways.get(train, [])
        speed = device.speed(body.speed, may_leave, self.to_stop_m(train, body))
        traci.vehicle.setSpeed(train, speed)

    def target_pieces(self, train: str) -> tuple[str, ...]:
        target = self.dispatcher.agents[train].target
        return target.pieces if target is not None else ()

    def to_stop_m(self, train: str, body: Body) -> float | None:
        """From the front to where the train is to stop at its platform, if it is there."""
        if body.piece not in self.target_pieces(train):
            return None
        edges = [body.edge, *body.ahead]
        length = sum(self.line.pieces[edge.removeprefix("-")].length_m for edge in edges)
        return length - body.position_m - BEFORE_THE_END_M

    def told(self, seconds: float) -> dict[str, Any]:
        arrivals, judge = self.dispatcher.arrivals, self.judge
        kinds = sorted({kind for _, kind in judge.sumo_collisions})
        times = [at for at, _ in judge.sumo_collisions] + judge.shared_ground
        return {
            "way": self.way,
            "mutant": self.mutant,
            "heedless": self.heedless,
            "seed": self.seed,
            "trains": len(self.starts),
            "seconds": seconds,
            "collisions": len(judge.sumo_collisions),
            "kinds": kinds,
            "shared_ground": len(judge.shared_ground),
            "first_collision_s": round(min(times), 1) if times else None,
            "wrong_points": judge.wrong_points,
            "lost": judge.lost,
            "arrivals": len(arrivals),
            "arrivals_per_hour": per_hour([arrival.at_s for arrival in arrivals]),
            "mean_travel_s": mean([arrival.travelled_s for arrival in arrivals]),
            "mean_wait_s": mean([arrival.waited_s for arrival in arrivals]),
            "hardest_braking_m_s2": round(judge.hardest_braking, 2),
            "too_fast_s": round(judge.too_fast_s, 1),
        }


def starts(line: Line, trains: int) -> dict[str, Platform]:
    """Where the trains stand first: one after the other in the west and in the east."""
    order = sorted(line.platforms.values(), key=lambda platform: (platform.number, platform.station == track.EAST))
    return {f"train {number}": platform for number, platform in enumerate(order[:trains], 1)}


def outwards(platform: Platform) -> list[str]:
    """The edges of a platform for a train that leaves."""
    return list(platform.pieces) if platform.station == track.WEST else ["-" + name for name in platform.pieces[::-1]]


def inwards(platform: Platform) -> list[str]:
    """The edges of a platform for a train that comes."""
    return ["-" + name for name in platform.pieces[::-1]] if platform.station == track.WEST else list(platform.pieces)


def train_type(folder: Path) -> Path:
    """The trains as SUMO's own rules move them: the same traction, brake and speed as under our devices."""
    attributes = {"id": "train", "vClass": "rail", "length": str(LENGTH_M), "minGap": "2.5", "sigma": "0"}
    attributes |= {"accel": str(ACCELERATION), "decel": str(SERVICE), "emergencyDecel": str(EMERGENCY)}
    attributes |= {"speedDev": "0", "maxSpeed": str(round(75 / 3.6, 3))}
    path = folder / "trains.rou.xml"
    network.write(path, "routes", [("vType", attributes)])
    return path


def per_hour(times: list[float]) -> float | None:
    """The rate between the first arrival and the last one; the start of the devices is not in it."""
    if len(times) < 2:
        return None
    return round((len(times) - 1) / (times[-1] - times[0]) * 3600, 1)


def mean(values: list[float]) -> float | None:
    return round(sum(values) / len(values), 1) if values else None


def duration(text: str) -> float:
    """A simulated time: more than nothing, and no more than a day."""
    seconds = float(text)
    if not 0 < seconds <= 86400:
        raise argparse.ArgumentTypeError(f"{text}: a time is above 0 and at most 86400 seconds")
    return seconds


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--way", choices=WAYS, action="append", help="a way of running the line [default: all]")
    parser.add_argument("--seconds", type=duration, default=3600, help="the simulated time")
    parser.add_argument("--trains", type=int, choices=[2, 3], default=3)
    parser.add_argument("--seed", type=int, default=1, help="of the stops at platforms, and the strokes of points")
    parser.add_argument("--heedless", action="store_true", help="drivers motor whatever our cabs say")
    parser.add_argument("--mutant", action="store_true", help="our devices lose sight of a train on the line")
    asked = parser.parse_args()
    status, line = 0, track.read()
    try:
        for way in asked.way or WAYS:
            status |= unsafe(line, way, asked)
    except (OSError, RuntimeError, atc.Refused, traci.TraCIException, traci.FatalTraCIError) as error:
        print(f"run.py: {error}", file=sys.stderr)
        return 2
    return int(status)


def unsafe(line: Line, way: str, asked: argparse.Namespace) -> bool:
    """Runs one way, and prints what happened; whether it was unsafe where our devices are in charge."""
    ours = way == OURS
    run = Run(line, way, asked.trains, asked.seed, asked.heedless and ours, asked.mutant and ours)
    print(json.dumps(run.run(asked.seconds)), flush=True)
    return ours and run.judge.is_unsafe


if __name__ == "__main__":
    sys.exit(main())
