"""A million cycles of aspect acceptance in one call, and the braking pattern of a whole table."""

import numpy as np

from atc import columns

LINE = {"cycle_ms": 50, "aspects_km_h": [25, 45, 65, 90]}

# The second aspect is heard, with interruptions of up to a second.
random = np.random.default_rng(1)
heard = np.full(1_000_000, 1 << 1, dtype=np.uint16)
for start in random.integers(0, heard.size, 20_000):
    heard[start : start + random.integers(1, 20)] = 0

shown = columns.Aspect(LINE).run(heard)
dropped = np.count_nonzero(np.diff(shown) < 0)
print(f"{np.count_nonzero(heard == 0)} cycles without a signal, {dropped} times without a display")

distances = np.arange(0, 1001, 250)
for gradient in (-20, 0, 20):
    print(f"{gradient:4} per mille: {columns.Pattern(800).run(distances, gradient) / 10} km/h")
