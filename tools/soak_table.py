#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The table of tools/soak: its runs' timing beside cyclictest's, medians over the minutes.

    tools/soak_table.py FOLDER
"""
import json
import pathlib
import re
import statistics
import sys

QUANTILES = {"p50": 0.5, "p99": 0.99, "p999": 0.999}


def cyclictest(path):
    """Wake-up latencies in us: quantiles of the histogram (1 us bins; each at its middle), and the maximum."""
    counts = []
    for line in path.read_text().splitlines():
        if match := re.fullmatch(r"(\d+)\s+(\d+)\s*", line):
            counts.append((int(match[1]), int(match[2])))
        if line.startswith("# Max Latencies:"):
            most = int(line.split(":")[1])
    total = sum(count for _, count in counts)
    result = {"max": most}
    for name, fraction in QUANTILES.items():
        seen = 0
        result[name] = next((us + 0.5 for us, count in counts if (seen := seen + count) >= fraction * total), most)
    return result


def main(folder):
    runs = [json.loads(path.read_text()) for path in sorted(folder.glob("run-*.json"))]
    peers = [cyclictest(path) for path in sorted(folder.glob("cyclictest-*.txt"))]
    faults = [run["error"]["message"] for run in runs if "error" in run]
    runs = [run for run in runs if "ticks" in run]
    if not runs:
        sys.exit(f"no run came to its end: {faults}")
    median = lambda rows, key: statistics.median(row[key] for row in rows)

    print("| wake-up | mixloop-plant | cyclictest | ratio |\n|---|---|---|---|")
    for name in (*QUANTILES, "max"):
        ours, theirs = 1e6 * median(runs, f"wake_up_{name}"), median(peers, name)
        print(f"| {name} | {ours:.1f} us | {theirs:.1f} us | {ours / theirs:.2f} |")
    ticks, missed = sum(run["ticks"] for run in runs), sum(run["missed_deadlines"] for run in runs)
    print(f"\n{ticks} ticks in {len(runs)} runs: {100 * (1 - missed / ticks):.4f} % of the commands in time, at most "
          f"{max(run['longest_miss'] for run in runs)} missed in a row; plant time slipped "
          f"{sum(run['overruns'] for run in runs)} times, by {1e3 * sum(run['slipped'] for run in runs):.1f} ms in all.")
    print(f"Round trip p50 {1e6 * median(runs, 'round_trip_p50'):.1f} us, p99 {1e6 * median(runs, 'round_trip_p99'):.1f} us; "
          f"position error at most {1e3 * max(run['max_position_error'] for run in runs):.2f} mm; "
          f"verdicts: {', '.join(sorted({run['verdict'] for run in runs}))}.")
    allocations = [line.split() for line in (folder / "allocations").read_text().splitlines()]
    worst = {name: max(int(count) for other, count in allocations if other == name) for name, _ in allocations}
    print("Heap allocations in the steady state, at most: "
          + ", ".join(f"{name} {count}" for name, count in sorted(worst.items()) if name.startswith("mixloop-")) + ".")
    for fault in faults:
        print(f"A run ended by a fault: {fault}")
    held = not faults and all(run["verdict"] == "held" for run in runs)
    return 0 if held and not any(count for name, count in worst.items() if name.startswith("mixloop-")) else 1


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(main(pathlib.Path(sys.argv[1])))
