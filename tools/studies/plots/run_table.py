#!/usr/bin/env python3
"""Prints one table of the reports written by `weft run --json FILE`."""

import argparse
import json
import os
import sys

COLUMNS = [
    ("scene", lambda r: r["scene"]),
    ("particles", lambda r: f"{r['particles']}"),
    ("constraints", lambda r: f"{r['constraints']}"),
    ("ms/frame", lambda r: f"{r['ms_per_frame']:.3f}"),
    ("times real time", lambda r: f"{r['real_time_factor']:.3g}"),
    ("max strain", lambda r: f"{100 * r['max_strain']:.3g} %"),
    ("status", lambda r: r["status"]),
]


def print_table(paths):
    rows = []
    for path in paths:
        with open(path, encoding="utf-8") as file:
            report = json.load(file)
        rows.append([text(report) for _, text in COLUMNS])
    titles = [title for title, _ in COLUMNS]
    widths = [max(len(row[k]) for row in [titles] + rows) for k in range(len(COLUMNS))]
    last = len(COLUMNS) - 1
    for row in [titles, ["-" * width for width in widths]] + rows:
        # Words to the left, numbers to the right.
        cells = [cell.ljust(widths[k]) if k in (0, last) else cell.rjust(widths[k])
                 for k, cell in enumerate(row)]
        print("  ".join(cells).rstrip())


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("json", nargs="+", help="written by `weft run --json`")
    try:
        print_table(parser.parse_args().json)
    except (OSError, ValueError, KeyError) as problem:
        sys.exit(f"{os.path.basename(sys.argv[0])}: {type(problem).__name__}: {problem}")


if __name__ == "__main__":
    main()
