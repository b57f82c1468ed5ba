"""The dispatcher. It keeps a free track for each train that leaves, in every way of a run; and where our devices are in
charge it asks them for routes, and for the direction of the line. It knows nothing of what is safe."""

import random
from collections import deque
from dataclasses import dataclass, field

from line import EAST, WEST, Line, Platform
from motion import Body

# How long a train stands at a platform: so long at least, and at most.
DWELL_S = (20.0, 40.0)
# How long it waits after a refusal; and after how long a signal that does not show proceed is given up.
AGAIN_S, PATIENCE_S = 1.0, 20.0
SEGMENT = "Line"

Request = dict[str, str]
Job = tuple[str, Request]


@dataclass
class Agent:
    """A train as the dispatcher knows it."""

    at: Platform
    ready_s: float
    target: Platform | None = None
    holds: bool = True
    moved_s: float | None = None
    jobs: deque[Job] = field(default_factory=deque)
    again_s: float = 0.0
    entry_asked: bool = False
    watch: tuple[str, str, float] | None = None


@dataclass
class Arrival:
    """A train that has arrived: when, how long it waited after its stop, and how long it was on its way then."""

    at_s: float
    waited_s: float
    travelled_s: float


class Dispatcher:
    """Sends the trains to and fro."""

    def __init__(self, line: Line, trains: dict[str, Platform], seed: int) -> None:
        self.line, self.random = line, random.Random(seed)
        self.agents = {train: Agent(platform, place * 5.0) for place, (train, platform) in enumerate(trains.items())}
        self.owners = {platform.key: train for train, platform in trains.items()}
        self.arrivals: list[Arrival] = []
        self.asking: deque[str] = deque()
        self.asked: dict[str, str] = {}

    def departures(self, now: float) -> list[str]:
        """The trains that leave now, as a track of the other station is kept for each; who is ready first is first."""
        leaving = []
        for train, agent in sorted(self.agents.items(), key=lambda pair: pair[1].ready_s):
            if agent.target is not None or agent.ready_s > now:
                continue
            free = [one for key, one in self.line.platforms.items() if key not in self.owners]
            there = [platform for platform in free if platform.station != agent.at.station]
            if there:
                agent.target, agent.moved_s, agent.entry_asked = there[0], None, False
                self.owners[there[0].key] = train
                self.asking.append(train)
                agent.jobs.extend(leaving_jobs(agent.at))
                leaving.append(train)
        return leaving

    def follow(self, now: float, train: str, body: Body) -> None:
        """Looks where a train is."""
        agent = self.agents[train]
        if agent.target is None:
            return
        if agent.moved_s is None and body.speed > 0.1:
            agent.moved_s = now
        if agent.holds and not set(body.stretches) & set(agent.at.pieces):
            agent.holds = False
            del self.owners[agent.at.key]
        if not agent.entry_asked and body.piece == self.line.entry_block(agent.target):
            agent.entry_asked = True
            agent.jobs.append((agent.target.station, {"set": agent.target.enter}))
        if not agent.holds and set(body.stretches) <= set(agent.target.pieces) and body.speed < 0.01:
            moved = agent.moved_s if agent.moved_s is not None else now
            self.arrivals.append(Arrival(now, moved - agent.ready_s, now - moved))
            # A train that goes back never leaves the route at its end, which would release it.
            withdrawal = (agent.target.station, {"withdraw": agent.target.enter})
            self.agents[train] = Agent(agent.target, now + self.random.uniform(*DWELL_S), jobs=deque([withdrawal]))

    def requests(self, now: float, proceed: dict[str, list[str]], fronts: dict[str, str]) -> dict[str, Request]:
        """What is asked of each station in this cycle: of the trains that wait to leave, only the first one asks."""
        requests: dict[str, Request] = {}
        self.asked = {}
        for train, agent in self.agents.items():
            self.lose_patience(now, agent, proceed, fronts.get(train, ""))
            if not agent.jobs or agent.again_s > now:
                continue
            station, request = agent.jobs[0]
            if train in self.asking and train != self.asking[0] and "withdraw" not in request:
                continue
            if station not in requests:
                requests[station], self.asked[station] = request, train
        return requests

    def lose_patience(self, now: float, agent: Agent, proceed: dict[str, list[str]], front: str) -> None:
        """A route whose signal does not show proceed for long is set anew."""
        if agent.watch is None:
            return
        station, route, since = agent.watch
        if front in self.path(station, route):
            agent.watch = None
        elif route in proceed[station]:
            agent.watch = (station, route, now)
        elif now - since > PATIENCE_S:
            agent.jobs.extendleft([(station, {"set": route}), (station, {"withdraw": route})])
            agent.watch = None

    def path(self, station: str, route: str) -> set[str]:
        """The circuits of a route's path."""
        layout = self.line.layouts[station]
        path = next(one["path"] for one in layout["route"] if one["name"] == route)
        return {name for name, own in self.line.circuits(station).items() if own in path}

    def answered(self, now: float, station: str, answer: str | dict[str, object] | None) -> None:
        """What became of the request to a station."""
        train = self.asked.get(station)
        if train is None or answer is None:
            return
        agent = self.agents[train]
        _, request = agent.jobs[0]
        if answer == "accepted":
            agent.jobs.popleft()
            if "set" in request:
                agent.watch = (station, request["set"], now)
                if train in self.asking:
                    self.asking.remove(train)
        elif isinstance(answer, dict) and answer["refused"] == "not-held" and "withdraw" in request:
            agent.jobs.popleft()
        else:
            agent.again_s = now + AGAIN_S


def leaving_jobs(platform: Platform) -> list[Job]:
    """What gives the line its direction, and then the route out."""
    here, there = platform.station, EAST if platform.station == WEST else WEST
    turns = [(there, {"turn": SEGMENT, "to": "toward"}), (here, {"turn": SEGMENT, "to": "away"})]
    return [*turns, (here, {"set": platform.leave})]
