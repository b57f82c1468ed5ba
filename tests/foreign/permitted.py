"""The permitted speed, written from spec/permitted.md and spec/pattern.md alone: `python3 permitted.py [--fault 1…18]`."""

from math import isqrt

import telegram
import wire
from wire import FAULT, Malformed, Rejected, fields, number, whole

SPEED = 65535  # tenths of km/h
LENGTH = 2**32 - 1  # mm
ANY = 2**63


def pattern(brake, gradient, metres):
    """PAT-1, PAT-2: tenths of km/h."""
    if gradient < 0:
        deceleration = brake - -(-(630 if FAULT != 1 else 600) * -gradient // 64)
    else:
        deceleration = brake + 620 * gradient // 64
    if deceleration <= 0:
        return 0
    return min(4095, isqrt(324 * deceleration * metres // 125))


class Stream:
    """TEL-6, TEL-8: the telegrams of one carrier."""

    def __init__(self, window, run, memory):
        self.window, self.run, self.memory = window, run, memory
        self.last = None  # section and counter of the last telegram
        self.silence = 0  # cycles since it
        self.ordered = 0  # telegrams in order, up to the last one; the first of a section is one

    def pass_time(self):
        if self.last is not None:
            self.silence += 1
            if self.silence >= self.memory + (1 if FAULT == 2 else 0):
                self.last, self.ordered = None, 0

    def hear(self, section, counter):
        """Whether the telegram is used, and how old it may be: the time since the one before it."""
        if self.last is None or (self.last[0] != section and FAULT != 3):
            self.ordered = 1
        elif 1 <= (counter - self.last[1]) % 256 <= self.window + (1 if FAULT == 4 else 0):
            self.ordered += 1
        else:
            self.ordered = 1 if FAULT == 19 else 0
        since, self.silence = self.silence, 0
        self.last = (section, counter)
        return self.ordered > self.run, since if FAULT != 5 else 0


class Target:
    def __init__(self, section, rank, beyond, to_stop, age):
        self.section, self.rank, self.beyond, self.to_stop, self.age = section, rank, beyond, to_stop, age


class Permitted:
    def __init__(self, config):
        fields(config, (), DEFAULTS)
        config = {**DEFAULTS, **config}
        times = ("cycle_ms", "fresh_ms", "life_ms", "fixed_life_ms", "memory_ms")
        ms = {name: whole(config[name], 0, 2**32 - 1) for name in times}
        if not isinstance(config["speeds_km_h"], list):
            raise Malformed("speeds are a list")
        self.speeds = [whole(speed, -ANY, ANY, 10) for speed in config["speeds_km_h"]]
        lowest = whole(config["lowest_limit_km_h"], -ANY, ANY, 10)
        self.brake = whole(config["brake_mm_s2"], 0, 2**32 - 1)
        self.margin = whole(config["margin_m"], 0, 2**32 - 1)
        self.worst = whole(config["worst_gradient_permille"], -(2**31), 2**31 - 1)
        window, run = whole(config["window"], 0, 2**32 - 1), whole(config["run"], 0, 2**32 - 1)
        if self.margin > 65535 or not -128 <= self.worst <= 127 or any(not 0 <= speed <= SPEED for speed in self.speeds):
            raise Rejected("margin, gradient or a speed is out of range")
        if not 1 <= len(self.speeds) <= 16 or any(a >= b for a, b in zip(self.speeds, self.speeds[1:])):
            raise Rejected("the speeds are 1 to 16 that rise")
        if lowest not in self.speeds:
            raise Rejected("PER-9: the lowest limit is one of the speeds")
        if not 1 <= self.brake <= 4095 or not 1 <= window <= 127 or not 1 <= run <= 15 or ms["cycle_ms"] == 0:
            raise Rejected("PAT-3, TEL-7: brake, window, run or cycle")
        self.cycle = ms["cycle_ms"]
        self.fresh, self.life, self.fixed_life, memory = (ms[name] // self.cycle for name in times[1:])
        if not (
            1 <= self.fresh <= self.life <= 60000
            and 1 <= self.fixed_life <= 60000
            and 1 <= memory <= min(self.life, self.fixed_life)
        ):
            raise Rejected("PER-9, TEL-7: the times")
        self.lowest = self.speeds.index(lowest)
        self.config = {name: wire_form(value) for name, value in config.items()}
        self.line = "digital"
        self.main, self.sub = Stream(window, run, memory), Stream(window, run, memory)
        self.target = self.behind = None
        self.subs = []  # section, gradient, rank of the limit, age; the newest first
        self.fix = None  # section's exit is no nearer, mm; measured since the last main telegram

    def pass_time(self, moved):
        self.main.pass_time()
        self.sub.pass_time()
        for name in ("target", "behind"):
            target = getattr(self, name)
            if target is not None:
                target.age += 1
                target.to_stop = max(0, target.to_stop - moved)
                if target.age > self.life + (1 if FAULT == 6 else 0):
                    setattr(self, name, None)
        self.subs = [[*entry[:3], entry[3] + 1] for entry in self.subs if entry[3] + 1 <= self.fixed_life or FAULT == 7]

    def pass_fix(self, fix, moved):
        """PER-10, in a cycle without a main telegram: the first distance measured since the last one counts."""
        if self.fix is not None:
            self.fix = max(0, self.fix - moved)
        elif self.main.last is not None:
            self.fix = fix

    def hear_main(self, main, moved):
        used, since = self.main.hear(main["section"], main["counter"])
        fix = self.fix  # of this section: a telegram that is used has one of its section before it
        if used or FAULT != 8:
            self.fix = None
        if not used:
            return
        beyond = (main["beyond_exit_m"] or 0) * 1000
        to_stop = max(0, min(LENGTH, beyond + (fix or 0)) - (moved if FAULT != 9 else 0))
        old = self.target
        if old is not None and old.section != main["section"] and FAULT != 11:
            self.behind = old
        elif old is not None and old.beyond == beyond:
            to_stop = max(to_stop, old.to_stop) if FAULT != 10 else to_stop
        self.target = Target(main["section"], main["speed_rank"], beyond, to_stop, since)

    def hear_sub(self, sub):
        used, since = self.sub.hear(sub["section"], sub["counter"])
        if used:
            limit = min(sub["curve_rank"], sub["restriction_rank"]) if FAULT != 13 else sub["curve_rank"]
            self.subs = [[sub["section"], sub["gradient_permille"], limit, since]] + [
                entry for entry in self.subs if entry[0] != sub["section"]
            ]
            del self.subs[2:]

    def by_target(self, target):
        """The speed by a target: rank, limits and pattern."""
        known = next((entry for entry in self.subs if entry[0] == target.section), None)
        gradient = known[1] if known else self.worst if FAULT != 12 else 0
        if known:
            limit = self.speeds[known[2]]
        else:
            limit = self.speeds[self.lowest]
            if target is self.target and self.behind is not None:
                limit = max(limit, self.by_target(self.behind))
        metres = min(65535, max(0, target.to_stop // 1000 - (self.margin if FAULT != 14 else 0)))
        return min(self.speeds[target.rank], limit, pattern(self.brake, gradient, metres))

    def step(self, value):
        value = fields(value, ("analog_km_h", "moved_m"), ("line", "main", "sub", "to_exit_m", "speed_km_h"))
        code = value["analog_km_h"]
        code = None if code is None else whole(code, 0, SPEED, 10)
        moved = whole(value["moved_m"], 0, LENGTH, 1000)
        fix, line = value.get("to_exit_m"), value.get("line")
        fix = None if fix is None else whole(fix, 0, LENGTH, 1000)
        if value.get("speed_km_h") is not None:
            whole(value["speed_km_h"], 0, SPEED, 10)
        if line not in (None, "analog", "digital"):
            raise Malformed("a line is analog or digital")
        main, sub = value.get("main"), value.get("sub")
        main = None if main is None else telegram.read_main(main)
        sub = None if sub is None else telegram.read_sub(sub)

        self.pass_time(moved)
        self.line = line or self.line
        ranks = len(self.speeds)
        if main is not None and FAULT == 18 and main["speed_rank"] >= ranks:
            main["speed_rank"] = 0
        if main is not None and main["speed_rank"] < ranks:
            self.hear_main(main, moved)
        else:
            self.pass_fix(fix, moved)
        if sub is not None and sub["curve_rank"] < ranks and sub["restriction_rank"] < ranks:
            self.hear_sub(sub)

        fresh = self.target is not None and self.target.age <= self.fresh - (1 if FAULT == 15 else 0)
        digital = self.by_target(self.target) if self.target is not None else None
        if fresh and code is not None:
            speed, basis = (min if FAULT != 16 else max)(code, digital), "both"
        elif self.line == "analog":
            speed, basis = (code, "analog") if code is not None else (None, "nothing")
        elif fresh:
            speed, basis = digital, "pattern"
        elif code is None:
            speed, basis = (None if FAULT != 17 else 0), "nothing"
        elif digital is not None:
            speed, basis = min(code, digital), "running-down"
        else:
            speed, basis = 0, "nothing"
        return {
            "speed_km_h": None if speed is None else number(speed, 10),
            "basis": basis,
            "state": {
                "line": self.line,
                "section": self.target and self.target.section,
                "to_stop_m": self.target and number(self.target.to_stop, 1000),
                "main_age_ms": self.target and self.target.age * self.cycle,
                "sub": [{"section": entry[0], "age_ms": entry[3] * self.cycle} for entry in self.subs],
            },
        }


DEFAULTS = {
    "cycle_ms": 10,
    "speeds_km_h": [0, 15, 25, 45, 55, 65, 75, 90],
    "lowest_limit_km_h": 25,
    "worst_gradient_permille": -35,
    "brake_mm_s2": 800,
    "margin_m": 10,
    "fresh_ms": 2200,
    "life_ms": 5000,
    "fixed_life_ms": 10000,
    "memory_ms": 2000,
    "window": 3,
    "run": 1,
}


def wire_form(value):
    """What was configured, as JSON."""
    if isinstance(value, list):
        return [wire_form(item) for item in value]
    return int(value) if value == int(value) else float(value)


if __name__ == "__main__":
    wire.serve("permitted-speed", Permitted)
