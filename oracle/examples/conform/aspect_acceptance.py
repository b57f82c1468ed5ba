#!/usr/bin/env python3
"""Aspect acceptance after spec/aspect.md, speaking protocol 1. One rule is broken on purpose: can you see which?"""
import json
import sys


class Lane:  # what is remembered of one aspect
    run, age, accepted, dropped, credit = 0, 0, False, False, False


class Machine:
    def __init__(self, config):
        cycle = config.get("cycle_ms", 10)
        up = lambda name, default: -(-config.get(name, default) // cycle)
        down = lambda name, default: config.get(name, default) // cycle
        self.speeds = config["aspects_km_h"]
        self.t1, self.t5 = up("operate_ms", 300), up("shortened_operate_ms", 100)
        self.t2, self.t4 = down("recovery_ms", 400), down("interruption_ms", 800)
        self.expiry = self.t2 + down("mask_ms", 400)
        self.lanes, self.last = [Lane() for _ in self.speeds], None
        rising = all(low < high for low, high in zip(self.speeds, self.speeds[1:]))
        times = self.t1 <= 60000 and self.t4 <= 60000 and self.expiry <= 60000
        if not (0 < self.t5 < self.t1 and self.t2 > 0 and times and rising and 1 <= len(self.speeds) <= 16):
            raise ValueError("a rule of TIME-2 or TIME-4 is broken")

    def step(self, step):
        for speed, lane in zip(self.speeds, self.lanes):
            heard = speed in step["detected_km_h"]
            lane.run = min(lane.run + 1, self.t1) if heard else 0
            if lane.accepted and (lane.age > 0 or not heard):
                lane.age += 1
            if lane.age > 0:
                silence = lane.age - lane.run
                lane.credit = lane.run > 0 and silence < self.t4 and silence < self.expiry
            lane.credit = lane.credit and heard
            if lane.run == self.t1 or lane.credit and lane.run >= self.t5:
                lane.accepted, lane.age, lane.dropped, lane.credit = True, 0, False, False
            if lane.age == self.expiry:
                lane.accepted, lane.age, lane.dropped = False, 0, False
        firm = [lane.accepted and lane.age < self.t2 for lane in self.lanes]
        proven = [lane.run == self.t1 for lane in self.lanes]
        for rank, lane in enumerate(self.lanes):
            if lane.age >= self.t2 and (any(firm[:rank]) or any(proven[rank + 1:])):
                lane.dropped = True
        satisfied = [rank for rank, lane in enumerate(self.lanes) if lane.accepted and not lane.dropped]
        if not satisfied or not (self.last is not None and satisfied[0] <= self.last or any(proven[satisfied[0]:])):
            return {"display_km_h": None}
        self.last = satisfied[0]
        return {"display_km_h": self.speeds[self.last]}


def reply(request, state={"machine": None}):
    if "start" in request:
        if request["start"]["machine"] != "aspect-acceptance":
            return {"rejected": {"reason": "only aspect-acceptance is built"}}
        try:
            state["machine"] = Machine(request["start"]["config"])
        except (ValueError, ZeroDivisionError) as wrong:
            return {"rejected": {"reason": str(wrong)}}
        return {"started": {"protocol": 1, "machine": "aspect-acceptance", "config": request["start"]["config"]}}
    if "step" in request:
        return {"output": state["machine"].step(request["step"])}
    return {"stopped": {}}


for line in sys.stdin:
    print(json.dumps(reply(json.loads(line))), flush=True)
