"""What the figures of weft's studies have in common: their look, and the way to a file."""

import argparse
import json
import os
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt

STYLE = {
    "font.size": 9, "axes.spines.top": False, "axes.spines.right": False, "axes.axisbelow": True,
    "axes.titlesize": 10, "axes.titlelocation": "left", "axes.edgecolor": "0.4",
    "xtick.color": "0.2", "ytick.color": "0.2", "legend.frameon": False, "svg.fonttype": "none",
}


def draw_all(description, verb, draw):
    parser = argparse.ArgumentParser(description=description.split("\n", maxsplit=1)[0])
    parser.add_argument("json", help=f"written by `weft {verb} --json`")
    parser.add_argument("--out", required=True, help="the folder to write into")
    options = parser.parse_args()
    with open(options.json, encoding="utf-8") as file:
        study = json.load(file)
    os.makedirs(options.out, exist_ok=True)
    plt.rcParams.update(STYLE)
    for name, figure in draw(study).items():
        for ending in ("png", "svg"):
            figure.savefig(os.path.join(options.out, f"{name}.{ending}"), dpi=130)


def run(description, verb, draw):
    """Saves what draw(study) returns, figures by their names; ends the script."""
    try:
        draw_all(description, verb, draw)
    except (OSError, ValueError, KeyError) as problem:
        sys.exit(f"{os.path.basename(sys.argv[0])}: {type(problem).__name__}: {problem}")
    sys.exit(0)
