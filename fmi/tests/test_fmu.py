"""The unit in FMPy: against the oracle cycle by cycle, its states, its refusals.

ATC_ORACLE and ATC_FMU are the programs `oracle` and `fmu`.
"""

import json
import math
import os
import random
import subprocess
import sys
import tempfile
import unittest
import zipfile
from pathlib import Path

import fmpy
import numpy as np
from fmpy.fmi1 import FMICallException
from fmpy.fmi3 import FMU3Slave
from fmpy.validation import validate_fmu

ORACLE, PACKER = os.environ["ATC_ORACLE"], os.environ["ATC_FMU"]
DISCARD, ERROR = 2, 3
SAFE = {"display_km_h": None, "permitted_km_h": None, "basis": "nothing", "position_m": None, "brake": "emergency"}


def packed(config, folder):
    """The unit with this configuration, or what `fmu` says against it."""
    path, unit = Path(folder) / "config.json", Path(folder) / "onboard.fmu"
    path.write_text(json.dumps(config))
    done = subprocess.run([PACKER, "--config", path, "-o", unit], capture_output=True, text=True)
    if done.returncode == 0:
        return unit, None
    assert done.returncode == 2 and not unit.exists(), done
    return None, done.stderr


def answers(machine, config, steps):
    """The outputs of the oracle, or the reason why it rejects the configuration."""
    lines = [{"start": {"protocol": 1, "machine": machine, "config": config}}, *({"step": step} for step in steps)]
    text = "".join(json.dumps(line) + "\n" for line in lines)
    said = subprocess.run([ORACLE, "serve"], input=text, capture_output=True, text=True, check=True).stdout
    first, *replies = map(json.loads, said.splitlines())
    if "rejected" in first:
        return None, first["rejected"]["reason"]
    assert len(replies) == len(steps) and all("output" in reply for reply in replies), replies
    return [reply["output"] for reply in replies], None


def frames(telegrams):
    """The bits of the frames of these telegrams, as the oracle has them."""
    outputs, _ = answers("telegram-codec", {}, [{"encode": telegram} for telegram in telegrams])
    return [output["frame"] for output in outputs]


def as_bytes(bits):
    return int(bits.ljust(112, "0"), 2).to_bytes(14, "big")


class Unit:
    """The unit in FMPy's low-level interface, ready for its first step."""

    def __init__(self, path, folder, ready=True):
        about = fmpy.read_model_description(str(path))
        self.folder = Path(fmpy.extract(str(path), unzipdir=str(folder)))
        self.variables = {variable.name: variable for variable in about.modelVariables}
        self.words = {kind.name: [item.name for item in kind.items] for kind in about.typeDefinitions}
        self.said, self.time = [], 0.0
        self.cycle = float(about.coSimulation.fixedInternalStepSize)
        self.slave = FMU3Slave(
            guid=about.guid, unzipDirectory=str(self.folder), modelIdentifier="atc_fmi", instanceName="train"
        )
        self.slave.instantiate(logMessage=lambda _, status, category, text: self.said.append((status, text.decode())))
        if ready:
            self.slave.enterInitializationMode()
            self.slave.exitInitializationMode()

    def close(self):
        self.slave.freeInstance()

    def set(self, **values):
        for name, value in values.items():
            variable = self.variables[name]
            kind = {"Enumeration": "Int64"}.get(variable.type, variable.type)
            if kind == "Int64" and isinstance(value, str):
                value = self.words[variable.declaredType.name].index(value)
            getattr(self.slave, "set" + kind)([variable.valueReference], [value])

    def get(self, name):
        variable = self.variables[name]
        kind = {"Enumeration": "Int64"}.get(variable.type, variable.type)
        value = getattr(self.slave, "get" + kind)([variable.valueReference])[0]
        return self.words[variable.declaredType.name][value] if variable.type == "Enumeration" else value

    def do(self, at=None, long=None):
        at, long = self.time if at is None else at, self.cycle if long is None else long
        event, terminate, early, last = self.slave.doStep(at, long)
        assert (event, terminate, early) == (False, False, False) and math.isclose(last, at + long)
        self.time = last

    def outputs(self):
        """The outputs, in the protocol's form."""
        shown, permitted, known = (self.get(name) for name in ("display_shown", "permitted", "position_known"))
        ends = [self.get("position_least_m"), self.get("position_most_m")]
        return {
            "display_km_h": self.get("display_km_h") if shown else None,
            "permitted_km_h": self.get("permitted_km_h") if permitted else None,
            "basis": self.get("basis"),
            "position_m": ends if known else None,
            "brake": self.get("brake"),
        }

    def step(self, step, by_frames):
        """One step of the protocol, by telegram fields where there are such, or by frames."""
        self.set(**variables(step, by_frames))
        self.do()
        return self.outputs()


def variables(step, by_frames):
    """A step of the protocol as variables. Telegrams of the wrong kind come as frames; `by_frames` has their bits."""
    values = {}
    for carrier in ("main", "sub"):
        heard = step.get(carrier) or {}
        telegram, bits = heard.get("telegram"), heard.get("frame")
        fields = (telegram or {}).get(carrier)
        if telegram is not None and (fields is None or by_frames["all"]):
            fields, bits = None, by_frames[json.dumps(telegram)]
        values[f"{carrier}_code_hz"] = heard.get("code_hz") or 0
        values[f"{carrier}_received"] = fields is not None
        values[f"{carrier}_frame"] = as_bytes(bits) if bits else b""
        if fields is not None:
            fields = dict(fields)
            if carrier == "main":
                values["main_closed"] = fields["beyond_exit_m"] is None
                fields["beyond_exit_m"] = fields["beyond_exit_m"] or 0
            values |= {f"{carrier}_{name}": value for name, value in fields.items()}
    for there, name in (("first", "first_db"), ("second", "second_db"), ("speed", "speed_km_h")):
        values[f"{there}_measured"] = step.get(name) is not None
        values[name] = step.get(name) or 0
    moved = step.get("moved_m")
    values["moved_measured"] = moved is not None
    values["moved_least_m"], values["moved_most_m"] = moved or (0, 0)
    values["line_begins"] = step.get("line") or "nothing"
    values["facing"] = step.get("facing") or "unknown"
    lost = step.get("lost", [])
    values["lost_a"], values["lost_b"] = "a" in lost, "b" in lost
    return values


def telegrams(cases):
    heard = (step.get(carrier) or {} for case in cases for step in case["steps"] for carrier in ("main", "sub"))
    return list({json.dumps(it["telegram"]): it["telegram"] for it in heard if it.get("telegram")}.values())


class Test(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def unit(self, config=None, ready=True):
        path, why = packed({} if config is None else config, self.folder)
        self.assertIsNone(why)
        unit = Unit(path, self.folder / "unit", ready)
        self.addCleanup(unit.close)
        return unit

    def assertRefused(self, unit, status, says, call):
        before = len(unit.said)
        with self.assertRaisesRegex(FMICallException, f"status {status}"):
            call()
        self.assertEqual(unit.outputs(), SAFE)
        self.assertRegex(" ".join(text for got, text in unit.said[before:] if got == status), says)


class Packed(Test):
    def test_fmpy_finds_no_problem_and_simulates(self):
        path, _ = packed({}, self.folder)
        self.assertEqual(validate_fmu(str(path)), [])
        kinds = [("time", float), ("main_code_hz", float), ("sub_code_hz", float), ("speed_measured", bool)]
        kinds += [("speed_km_h", float), ("line_begins", np.int64), ("facing", np.int64), ("main_received", bool)]
        kinds += [("main_section", np.uint16), ("main_counter", np.uint8), ("main_beyond_exit_m", np.uint16)]
        kinds += [("main_speed_rank", np.uint8)]
        rows = [(0.01 * n, 22, 21, True, 44.0, 2 * (n == 0), 1, n == 50, 7, 3, 900, 4) for n in range(200)]
        rows = np.array(rows, dtype=kinds)
        said = fmpy.simulate_fmu(str(path), input=rows, stop_time=2.0)
        self.assertEqual(len(said), 201)
        self.assertEqual((said["brake"][0], said["display_km_h"][0]), (0, 0.0))
        self.assertIn(45.0, said["display_km_h"])

    def test_the_same_inputs_give_the_same_bytes(self):
        path, _ = packed({}, self.folder)
        first = path.read_bytes()
        path, _ = packed({}, self.folder)
        self.assertEqual(path.read_bytes(), first)
        with zipfile.ZipFile(path) as files:
            self.assertIsNone(files.testzip())
            self.assertEqual(files.read("resources/config.json"), b"{}")

    def test_a_unit_whose_parts_are_of_different_units_does_not_start(self):
        unit = self.unit()
        (unit.folder / "resources/config.json").write_text('{"permitted":{"cycle_ms":20}}')
        with self.assertRaisesRegex(Exception, "instantiate"):
            unit.slave.instantiate(logMessage=lambda _, status, category, text: unit.said.append((status, text)))
        self.assertIn(b"are not of one unit", unit.said[-1][1])

    def test_what_is_no_configuration(self):
        for config, says in (
            ({"permitted": {"cycle_ms": 0}}, "cycle"),
            ({"acceptances": {}}, "unknown field `acceptances`"),
            ([], "expected an object"),
        ):
            path, why = packed(config, self.folder)
            self.assertIsNone(path)
            self.assertRegex(why, says)


class Vectors(Test):
    def test_every_minimal_vector_of_the_train(self):
        vectors = self.folder / "vectors"
        ask = [ORACLE, "vectors", "--machine", "train", "--set", "minimal", "--out", vectors]
        subprocess.run(ask, check=True, capture_output=True)
        cases = [json.loads(line) for line in (vectors / "train.jsonl").read_text().splitlines()]
        self.assertGreater(len(cases), 100)
        sent = telegrams(cases)
        bits = dict(zip(map(json.dumps, sent), frames(sent)))
        groups = {}
        for case in cases:
            groups.setdefault(json.dumps(case["config"], sort_keys=True), []).append(case)
        cycles, refused = 0, 0
        for number, group in enumerate(groups.values()):
            place = self.folder / str(number)
            place.mkdir()
            path, why = packed(group[0]["config"], place)
            if path is None:
                for case in group:
                    outputs, reason = answers("train", case["config"], [])
                    self.assertTrue(case["rejected"] and outputs is None)
                    self.assertIn(reason, why)
                    refused += 1
                continue
            unit = Unit(path, place / "unit", ready=False)
            for case in group:
                outputs, _ = answers("train", case["config"], case["steps"])
                self.assertEqual(outputs, case["outputs"])
                for every in (False, True):
                    unit.slave.reset()
                    unit.slave.enterInitializationMode()
                    unit.slave.exitInitializationMode()
                    unit.time = 0.0
                    for at, (step, output) in enumerate(zip(case["steps"], outputs)):
                        shown = unit.step(step, bits | {"all": every})
                        self.assertEqual(shown, output, f"{case['id']}, step {at}, frames {every}: {step}")
                        cycles += 1
            unit.close()
        print(f"{len(cases)} vectors, {refused} refused configurations, {cycles} cycles without a difference")

    def test_frames_with_wrong_bits(self):
        draw = random.Random(7)
        good = frames(
            {"main": {"section": 7, "counter": count % 256, "beyond_exit_m": 600, "speed_rank": 4}}
            for count in range(300)
        )
        sub = {"section": 7, "length_m": 500, "gradient_permille": -3, "curve_rank": 5, "restriction_rank": 5}
        fixed = frames({"sub": {**sub, "counter": count % 256}} for count in range(300))
        steps = []
        for main, fix in zip(good, fixed):
            step = {"main": {"code_hz": 22}, "sub": {"code_hz": 21}, "speed_km_h": 30, "facing": "left"}
            for carrier, bits in (("main", main), ("sub", fix)):
                wrong = draw.sample(range(106), draw.choice((0, 0, 0, 1, 2, 30)))
                step[carrier]["frame"] = "".join(str(int(bit) ^ (at in wrong)) for at, bit in enumerate(bits))
            steps.append(step)
        steps[0]["line"] = "digital"
        outputs, _ = answers("train", {}, steps)
        self.assertTrue({"both", "analog"} & {output["basis"] for output in outputs})
        unit = self.unit()
        for step, output in zip(steps, outputs):
            self.assertEqual(unit.step(step, {"all": False}), output)


LINE = {"main_code_hz": 22.0, "sub_code_hz": 21.0, "speed_measured": True, "speed_km_h": 40.0}


class States(Test):
    def test_going_back_repeats(self):
        unit = self.unit()
        unit.set(**LINE, line_begins="analog")

        def on(count):
            shown = []
            for at in range(count):
                unit.set(speed_km_h=40.0 + at % 7)
                unit.do()
                shown.append(unit.outputs())
            return shown

        on(25)
        state, time = unit.slave.getFMUState(), unit.time
        first = on(60)
        self.assertGreater(len({str(output) for output in first}), 1)
        for _ in range(2):
            unit.slave.setFMUState(state)
            unit.time = time
            self.assertEqual(unit.get("time"), time)
            self.assertEqual(on(60), first)
        unit.slave.freeFMUState(state)
        with self.assertRaises(FMICallException):
            unit.slave.setFMUState(fmpy.fmi3.fmi3FMUState(1))
        unit.slave.reset()
        self.assertEqual(unit.outputs(), SAFE)


class Refused(Test):
    def running(self):
        unit = self.unit({"acceptance": {"operate_ms": 150}})
        unit.set(**LINE, line_begins="analog")
        for _ in range(20):
            unit.do()
            unit.set(line_begins="nothing")
        self.assertEqual((unit.outputs()["display_km_h"], unit.outputs()["brake"]), (45, "release"))
        return unit

    def test_values(self):
        unit = self.running()
        for name, value, there, says in (
            ("speed_km_h", math.nan, "speed_measured", "speed_km_h is NaN"),
            ("speed_km_h", math.inf, "speed_measured", "speed_km_h is inf"),
            ("speed_km_h", -3e8, "speed_measured", "speed_km_h is -300000000"),
            ("main_code_hz", -1.0, None, "main_code_hz is -1 Hz; it must be 0 to"),
            ("first_db", 400.0, "first_measured", "first_db is 400 dB; it must be -327.68 to"),
            ("moved_most_m", 33.0, "moved_measured", "moved_most_m is 33 m"),
            ("moved_least_m", 1.0, "moved_measured", "the least must not be greater"),
            ("facing", 3, None, "facing is 3; it must be 0 to 2: unknown, left, right"),
            ("main_frame", b"\x00" * 13, None, "13 bytes"),
            ("main_frame", b"\x00" * 13 + b"\x01", None, "last 6 bits must be 0"),
            ("sub_curve_rank", 16, "sub_received", "a rank is 0 to 15"),
            ("sub_length_m", 0, "sub_received", "sub.length_m is 0"),
        ):
            with self.subTest(says):
                old = {key: unit.get(key) for key in filter(None, (name, there))}
                unit.set(**({there: True} if there else {}), **{name: value})
                self.assertRefused(unit, DISCARD, says, unit.do)
                time = unit.get("time")
                unit.set(**old)
                unit.do()
                self.assertEqual(unit.outputs()["display_km_h"], 45)
                self.assertAlmostEqual(unit.get("time") - time, unit.cycle)

    def test_a_telegram_and_a_frame(self):
        unit = self.running()
        unit.set(main_received=True, main_frame=bytes(14))
        self.assertRefused(unit, DISCARD, "a telegram and a frame", unit.do)

    def test_what_is_not_there_is_not_looked_at(self):
        unit = self.running()
        unit.set(first_db=math.nan, moved_least_m=math.inf)
        unit.do()
        self.assertEqual(unit.outputs()["display_km_h"], 45)

    def test_times(self):
        unit = self.running()
        for at, long, says in (
            (None, 0.02, "communicationStepSize is 0.02 s; it must be 0.01 s"),
            (None, 0.0, "communicationStepSize"),
            (None, math.nan, "communicationStepSize"),
            (None, -0.01, "communicationStepSize"),
            (unit.time + 0.01, None, "currentCommunicationPoint"),
            (math.nan, None, "currentCommunicationPoint"),
        ):
            self.assertRefused(unit, DISCARD, says, lambda: unit.do(at, long))
        unit.do(unit.time + 1e-9, 0.01 + 1e-9)

    def test_modes(self):
        unit = self.unit(ready=False)
        self.assertRefused(unit, ERROR, "mode Instantiated; it is for mode Step", unit.do)
        unit.slave.enterInitializationMode()
        self.assertRefused(unit, ERROR, "mode Initialization; it is for mode Step", unit.do)
        self.assertRefused(unit, ERROR, "no event mode", unit.slave.enterEventMode)
        unit.slave.exitInitializationMode()
        unit.do()
        unit.slave.terminate()
        self.assertRefused(unit, ERROR, "mode Terminated", unit.do)

    def test_an_input_that_was_not_set(self):
        unit = self.running()
        self.assertRefused(unit, ERROR, "another type", lambda: unit.slave.setUInt8([1], [1]))
        self.assertRefused(unit, ERROR, "could not be set", unit.do)
        unit.slave.reset()
        self.assertEqual(unit.outputs(), SAFE)


if __name__ == "__main__":
    sys.exit(not unittest.main(exit=False).result.wasSuccessful())
