"""A train hears a code, gets telegrams, loses the signal: what the unit displays, permits and brakes.

python onboard.py onboard.fmu
"""

import sys

import fmpy
import numpy as np

UNIT, SECONDS, CYCLE = sys.argv[1], 8.0, 0.01

INPUTS = {"time": float, "line_begins": np.int64, "facing": np.int64, "speed_measured": bool, "speed_km_h": float}
INPUTS |= {"moved_measured": bool, "moved_least_m": float, "moved_most_m": float}
INPUTS |= {"main_code_hz": float, "sub_code_hz": float}
INPUTS |= {"main_received": bool, "main_section": np.uint16, "main_counter": np.uint8}
INPUTS |= {"main_beyond_exit_m": np.uint16, "main_speed_rank": np.uint8}
INPUTS |= {"sub_received": bool, "sub_section": np.uint16, "sub_counter": np.uint8, "sub_length_m": np.uint16}
INPUTS |= {"sub_curve_rank": np.uint8, "sub_restriction_rank": np.uint8}


def inputs(cycle):
    heard, begins = cycle < 400, 2 if cycle == 0 else 0  # 2: a line with telegrams
    code = (22.0, 21.0) if heard else (0.0, 0.0)
    # An input stays until it is set again: a telegram is received in one cycle, and then it is not.
    main, sub = heard and cycle % 10 == 5, heard and cycle % 10 == 9
    counter = cycle // 10 % 256
    telegrams = (main, 7, counter, 200, 4, sub, 7, counter, 300, 5, 5)
    speed = min(40.0, 0.1 * cycle)
    moved = speed / 3.6 * CYCLE
    return (cycle * CYCLE, begins, 1, True, speed, True, 0.98 * moved, 1.02 * moved, *code, *telegrams)


rows = np.array([inputs(cycle) for cycle in range(round(SECONDS / CYCLE))], dtype=list(INPUTS.items()))
outputs = ["display_shown", "display_km_h", "permitted", "permitted_km_h", "brake"]
said = fmpy.simulate_fmu(UNIT, stop_time=SECONDS, input=rows, output=outputs)

BRAKE = ["emergency", "service", "release"]
before = None
for row in said:
    display = f"{row['display_km_h']:g}" if row["display_shown"] else "none"
    permitted = f"{row['permitted_km_h']:g}" if row["permitted"] else "none"
    now = (display, BRAKE[row["brake"]])
    if now != before:
        print(f"{row['time']:5.2f} s  displayed {display:4}  permitted {permitted:4}  brake {BRAKE[row['brake']]}")
    before = now
