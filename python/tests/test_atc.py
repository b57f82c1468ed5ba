"""The module against the oracle's own sessions, and its columns against its steps."""

import random
import unittest

import numpy as np

import atc
from atc import columns

LINE = {"cycle_ms": 50, "aspects_km_h": [25, 45, 65, 90]}
BLOCK = {"sections": 3, "max_trains": 3, "tail_hold_sections": 1, "cycle_ms": 1000, "pass_ms": 10000}


class Sessions(unittest.TestCase):
    def test_every_machine_is_there(self):
        self.assertIn("wayside", atc.machines())
        self.assertEqual(len(atc.machines()), len(set(atc.machines())))
        self.assertEqual(atc.PROTOCOL, 1)
        self.assertIn("$defs", atc.schema())

    def test_a_restart_is_the_beginning(self):
        machine = atc.Machine("aspect-acceptance", LINE)
        steps = [{"detected_km_h": [45]}] * 12
        first = machine.steps(steps)
        self.assertNotEqual(machine.steps(steps), first)
        machine.restart()
        self.assertEqual(machine.steps(steps), first)

    def test_what_is_refused_changes_nothing(self):
        machine, other = atc.Machine("block-count", BLOCK), atc.Machine("block-count", BLOCK)
        step = {"check_in": True, "check_out": False, "present": [], "reset": 0}
        self.assertEqual(machine.step(step), other.step(step))
        for wrong in ({"present": [7]}, {}, {**step, "reset": float("nan")}, {**step, "present": object()}):
            with self.assertRaises(atc.Refused) as refused:
                machine.step(wrong)
            self.assertGreater(len(str(refused.exception)), 20)
        self.assertEqual(machine.step(step), other.step(step))

    def test_configurations_that_break_a_rule(self):
        for name, config, says in (
            ("aspect-acceptance", {**LINE, "operate_ms": 0}, "operate_ms"),
            ("aspect-acceptance", {"aspects": [25]}, "unknown field `aspects`"),
            ("block", None, "there is no machine"),
        ):
            with self.assertRaisesRegex(atc.Refused, says):
                atc.Machine(name, config)


class Columns(unittest.TestCase):
    def test_aspect_is_the_same_in_columns(self):
        draw = random.Random(2)
        heard = [now for _ in range(600) for now in [draw.choice((2, 2, 2, 8, 4, 0, 1, 5, 15))] * draw.randint(1, 16)]
        machine, speeds = atc.Machine("aspect-acceptance", LINE), LINE["aspects_km_h"]
        steps = ({"detected_km_h": [speed for rank, speed in enumerate(speeds) if now >> rank & 1]} for now in heard)
        want = [
            -1 if shown is None else speeds.index(shown)
            for shown in (out["display_km_h"] for out in machine.steps(steps))
        ]
        aspect = columns.Aspect(LINE)
        half = len(heard) // 2
        got = np.concatenate([aspect.run(heard[:half]), aspect.run(np.array(heard[half:], dtype=np.int64))])
        self.assertEqual(got.tolist(), want)
        self.assertGreater(len(set(want)), 3)

    def test_block_is_the_same_in_columns(self):
        draw = random.Random(3)
        inputs, steps = [], []
        for cycle in range(5000):
            present, check_in, check_out = draw.randrange(8), draw.random() < 0.3, draw.random() < 0.3
            reset, hold, entered = (
                (draw.randrange(3) if draw.random() < 0.05 else -1),
                draw.randrange(3),
                draw.random() < 0.9,
            )
            inputs.append((present, check_in, check_out, reset, hold, entered))
            steps.append(
                {
                    "check_in": check_in,
                    "check_out": check_out,
                    "present": [section for section in range(3) if present >> section & 1],
                    "reset": None if reset < 0 else reset,
                    "ahead_hold_sections": hold,
                    "ahead_entered": entered,
                }
            )
        want = atc.Machine("block-count", BLOCK).steps(steps)
        got = columns.Block(BLOCK).run(np.array(inputs, dtype=columns.BLOCK_INPUT))
        for row, out in zip(got, want):
            status = columns.STATUS[row["status"]]
            self.assertEqual([section for section in range(3) if row["occupied"] >> section & 1], out["occupied"])
            self.assertEqual(int(row["behind_hold_sections"]), out["behind_hold_sections"])
            self.assertEqual((bool(row["agree"]), int(row["count"])), (out["agree"], out["count"]))
            self.assertEqual((status == "counting"), out["counting"])
            self.assertEqual(out["fault"], None if status in ("unverified", "counting") else status)
        self.assertGreater(len(set(got["status"].tolist())), 3)

    def test_the_pattern_is_the_same_in_columns(self):
        draw = random.Random(4)
        machine = atc.Machine("braking-pattern", {"brake_mm_s2": 700})
        distances = [draw.randrange(65536) for _ in range(500)] + [0, 65535]
        gradients = [draw.randint(-128, 127) for _ in distances]
        ask = lambda distance, gradient: machine.step({"distance_m": distance, "gradient_permille": gradient})
        want = [ask(*row)["speed_km_h"] for row in zip(distances, gradients)]
        self.assertEqual((columns.Pattern(700).run(distances, gradients) / 10).tolist(), want)

    def test_a_wrong_row_is_named_and_changes_nothing(self):
        aspect, other = columns.Aspect(LINE), columns.Aspect(LINE)
        with self.assertRaisesRegex(ValueError, "row 9: detected is 0b100000, and the line has 4 aspects"):
            aspect.run([2] * 9 + [32])
        self.assertEqual(aspect.run([2] * 9).tolist(), other.run([2] * 9).tolist())
        for wrong in ([70000], [-1], [0.5], [[1, 2]]):
            with self.assertRaises(ValueError):
                aspect.run(wrong)
        block = columns.Block(BLOCK)
        for wrong, says in (
            ((8, 0, 0, -1, 0, 1), "present"),
            ((0, 2, 0, -1, 0, 1), "check_in"),
            ((0, 0, 0, 256, 0, 1), "reset"),
        ):
            with self.assertRaisesRegex(ValueError, f"row 0: {says}"):
                block.run(np.array([wrong], dtype=columns.BLOCK_INPUT))
        with self.assertRaisesRegex(ValueError, "2 distances and 3 gradients"):
            columns.Pattern().run([1, 2], [1, 2, 3])
        with self.assertRaisesRegex(ValueError, "brake_mm_s2"):
            columns.Pattern(0)


if __name__ == "__main__":
    unittest.main()
