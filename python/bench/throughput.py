#!/usr/bin/env python3
"""Logic cycles per second of aspect acceptance through every way in, in one run, beside a reference in pure Python.

    cargo build --release -p atc-oracle -p atc-c
    python python/bench/throughput.py target/release

The module must be installed, built with ``maturin build --release``. The fastest of five runs counts, and the start of
a program is in it. The reference is `oracle/examples/conform/aspect_acceptance.py`.
"""

import io
import json
import runpy
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import atc
from atc import columns

LINE = {"cycle_ms": 50, "aspects_km_h": [25, 45, 65, 90]}
START = json.dumps({"start": {"protocol": 1, "machine": "aspect-acceptance", "config": LINE}})
REFERENCE = Path(__file__).parent / "../../oracle/examples/conform/aspect_acceptance.py"


def rate(cycles, run):
    """Cycles per second of the fastest of five runs."""
    best = float("inf")
    for _ in range(5):
        start = time.perf_counter()
        run()
        best = min(best, time.perf_counter() - start)
    return cycles / best


def main(programs):
    oracle = f"{programs}/oracle"
    heard = np.where(np.random.default_rng(1).random(1_000_000) < 0.9, 2, 0).astype(np.uint16)
    steps = [{"detected_km_h": [45] if now else []} for now in heard]
    lines = [json.dumps({"step": step}) for step in steps]
    session = "\n".join([START, *lines, ""]).encode()

    def line_by_line():
        with subprocess.Popen([oracle, "serve"], stdin=subprocess.PIPE, stdout=subprocess.PIPE) as serve:
            for line in [START, *lines[:20_000]]:
                serve.stdin.write(line.encode() + b"\n")
                serve.stdin.flush()
                serve.stdout.readline()
            serve.stdin.close()

    def in_bulk():
        subprocess.run([oracle, "serve"], input=session, stdout=subprocess.DEVNULL, check=True)

    # It reads requests until they end: here there are none.
    sys.stdin = io.StringIO()
    reference = runpy.run_path(str(REFERENCE))["Machine"](LINE)
    machine = atc.Machine("aspect-acceptance", LINE)
    rows = [
        ("pure Python, the reference", rate(100_000, lambda: [reference.step(step) for step in steps[:100_000]])),
        ("`oracle serve`, line by line", rate(20_000, line_by_line)),
        ("`oracle serve`, in bulk", rate(1_000_000, in_bulk)),
        ("Python, `Machine.step`", rate(100_000, lambda: machine.steps(steps[:100_000]))),
        ("Python, `columns.Aspect.run`", rate(1_000_000, lambda: columns.Aspect(LINE).run(heard))),
    ]
    with tempfile.TemporaryDirectory() as folder:
        log = f"{folder}/log.jsonl"
        generate = [oracle, "replay", "generate", "--machine", "aspect-acceptance", "--steps", "1000000"]
        with open(log, "wb") as file:
            subprocess.run(generate, stdout=file, check=True)
        replay = [oracle, "replay", "--jobs", "1", log]
        rows.append(
            (
                "`oracle replay`, one thread",
                rate(1_000_000, lambda: subprocess.run(replay, capture_output=True, check=True)),
            )
        )
    print("| way in | cycles per second |\n|---|---|")
    for name, cycles in rows:
        print(f"| {name} | {f'{cycles:,.0f}'.replace(',', ' ')} |")
    said = subprocess.run([f"{programs}/throughput"], capture_output=True, text=True, check=True).stdout
    print(
        "\nthrough C, and in the kernel (c-abi/README.md):\n"
        + "\n".join(line for line in said.splitlines() if "aspect" in line)
    )


if __name__ == "__main__":
    main(*sys.argv[1:])
