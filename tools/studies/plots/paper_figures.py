#!/usr/bin/env python3
"""Draws the paper's figures 2, 3 and 4 from the JSON of `weft paper`, as PNG and SVG.

    paper_figures.py paper.json --out FOLDER
"""

import study_figures

import matplotlib.pyplot as plt
from matplotlib.lines import Line2D

SCENES = ["hang", "hang_sphere", "sphere_drop"]
# Original, then 4.3, 4.2 and 4.2 + 4.3, the same in all figures.
COLOURS = {"original": "#8c8c8c", "4.3": "#d9a441", "4.2": "#4f93b8", "4.2+4.3": "#1f4e6b"}
# Average runtimes in % of the original's, without and with velocity correction, from the paper's
# text. It gives none for frozen directions alone.
PAPER_AVERAGES = {
    ("4.3", "each"): (103, 95), ("4.2", "each"): (72, 66), ("4.2+4.3", "each"): (66, 59),
    ("4.3", "frozen"): (59, 62), ("4.2", "frozen"): (40, 40), ("4.2+4.3", "frozen"): (28, 30),
}


def percent(fraction):
    return f"{100 * fraction:g} %"


def label(method, directions):
    if directions == "each":
        return "original" if method == "original" else method.replace("+", " + ")
    return "4.4" if method == "original" else method.replace("+", " + ") + " + 4.4"


def runtime(study, scene, strain, correction, method, directions):
    """In % of the original's."""
    for row in study["rows"]:
        if (row["scene"], row["strain"], row["velocity_correction"], row["method"],
                row["directions"]) == (scene, strain, correction, method, directions):
            return 100 / row["times_faster"]
    raise ValueError(f"no row for {scene} {strain} {correction} {method} {directions}")


def draw_runtimes(axes, study, correction, methods, directions):
    strains = sorted({row["strain"] for row in study["rows"]}, reverse=True)
    cells = [(scene, strain) for scene in SCENES for strain in strains]
    # A gap between the scenes, a wider one before the averages.
    places = [index + 0.35 * (index // len(strains)) for index in range(len(cells))]
    places.append(places[-1] + 1.7)
    width = 0.82 / len(methods)
    for k, method in enumerate(methods):
        values = [runtime(study, scene, strain, correction, method, directions)
                  for scene, strain in cells]
        values.append(sum(values) / len(values))
        xs = [place + (k - (len(methods) - 1) / 2) * width for place in places]
        axes.bar(xs, values, width * 0.94, color=COLOURS[method], label=label(method, directions))
        paper = PAPER_AVERAGES.get((method, directions))
        top = values[-1]
        if paper:
            published = paper[1 if correction else 0]
            axes.plot(xs[-1], published, marker="D", markersize=5, color="white",
                      markeredgecolor="#b3261e", markeredgewidth=1.3, zorder=3)
            top = max(top, published + 3 if abs(top - published) < 12 else top)
        axes.annotate(f"{values[-1]:.0f}", (xs[-1], top), xytext=(0, 3), ha="center",
                      textcoords="offset points", fontsize=7.5, color="0.2")
    axes.axhline(100, color="0.25", linewidth=0.9, linestyle=(0, (4, 3)))
    axes.axvspan(places[-1] - 0.62, places[-1] + 0.62, color="0.94", zorder=0, linewidth=0)
    axes.set_xticks(places, [percent(strain) for _, strain in cells] + ["average"])
    axes.tick_params(axis="x", length=0)
    for s, scene in enumerate(SCENES):
        middle = sum(places[s * len(strains):(s + 1) * len(strains)]) / len(strains)
        axes.text(middle, -0.135, scene, transform=axes.get_xaxis_transform(), ha="center",
                  va="top", fontweight="bold", color="0.2")
    axes.set_ylabel("runtime, % of the original")
    axes.set_title(f"{'with' if correction else 'without'} velocity correction")
    axes.grid(axis="y", color="0.9", linewidth=0.8)
    axes.margins(x=0.015)


def note(study):
    tolerances = "bars are grouped by the largest strain allowed, which every step reached"
    if any(row["status"] != "converged" for row in study["rows"]):
        tolerances = "bars are grouped by the largest strain allowed; NOT every step reached it"
    return tolerances + ("; QUICK run, few steps" if study.get("quick") else "")


def runtime_figure(study, number, methods, directions, title):
    figure, panels = plt.subplots(2, 1, figsize=(9.4, 6.6), sharey=True)
    for axes, correction in zip(panels, (False, True)):
        draw_runtimes(axes, study, correction, methods, directions)
    figure.suptitle(f"Figure {number}: {title}", x=0.07, ha="left", fontweight="bold", fontsize=11.5)
    figure.text(0.07, 0.935, f"20 x 20 particles, {note(study)}", fontsize=8.5, color="0.35")
    bars, names = panels[0].get_legend_handles_labels()
    mark = Line2D([], [], marker="D", linestyle="none", markersize=5, color="white",
                  markeredgecolor="#b3261e", markeredgewidth=1.3)
    figure.legend(bars + [mark], names + ["paper's average"], loc="lower center",
                  ncol=len(names) + 1, columnspacing=1.6, handlelength=1.1)
    figure.subplots_adjust(left=0.07, right=0.985, top=0.87, bottom=0.135, hspace=0.42)
    return figure


def figure_4(study):
    rows = study["figure4"]
    sizes = sorted({row["size"] for row in rows})
    strains = sorted({row["strain"] for row in rows}, reverse=True)
    sets = [("original", "each", strain, shade) for strain, shade in
            zip(strains, ("#c9c9c9", "#949494", "#5e5e5e"))]
    sets += [("4.2+4.3", "frozen", strain, shade) for strain, shade in
             zip(strains, ("#9cc7dd", "#4f93b8", "#1f4e6b"))]
    seconds = {(r["method"], r["directions"], r["strain"], r["size"]): r["seconds"] for r in rows}
    steps = {entry["strain"]: entry["steps"] for entry in study["steps"]}

    figure, axes = plt.subplots(figsize=(9.4, 5.2))
    width = 0.84 / len(sets)
    for k, (method, directions, strain, colour) in enumerate(sets):
        xs = [x + (k - (len(sets) - 1) / 2) * width for x in range(len(sizes))]
        # Per simulated second: runs of different length then compare.
        values = [seconds[method, directions, strain, size] / (0.01 * steps[strain])
                  for size in sizes]
        name = f"{label(method, directions)}, {percent(strain)}"
        axes.bar(xs, values, width * 0.94, color=colour, label=name)
    axes.axhline(1, color="#b3261e", linewidth=1, linestyle=(0, (4, 3)))
    axes.annotate("real time", (-0.48, 1), xytext=(0, 3), textcoords="offset points",
                  color="#b3261e", fontsize=8.5)
    axes.set_yscale("log")
    axes.set_ylabel("seconds per simulated second")
    axes.set_xticks(range(len(sizes)), [f"{size} x {size} particles" for size in sizes])
    axes.tick_params(axis="x", length=0)
    axes.grid(axis="y", color="0.9", linewidth=0.8)
    axes.set_xlim(-0.5, len(sizes) - 0.5)
    bars, names = axes.get_legend_handles_labels()
    by_strain = [k for pair in zip(range(len(strains)), range(len(strains), len(sets))) for k in pair]
    figure.legend([bars[k] for k in by_strain], [names[k] for k in by_strain], loc="lower center",
                  ncol=len(strains), columnspacing=2.5)
    figure.suptitle("Figure 4: absolute runtime of hang by size", x=0.08, ha="left", fontweight="bold",
                    fontsize=11.5)
    reached = all(row["status"] == "converged" for row in rows)
    figure.text(0.08, 0.915, "without velocity correction; the strain named was "
                + ("reached in every step" if reached else "NOT reached in every step")
                + ("; QUICK run, few steps" if study.get("quick") else ""),
                fontsize=8.5, color="0.35")
    figure.subplots_adjust(left=0.08, right=0.985, top=0.88, bottom=0.165)
    return figure


def figures_of(study):
    return {
        "figure2": runtime_figure(study, 2, ["4.3", "4.2", "4.2+4.3"], "each",
                                  "directions renewed in every iteration"),
        "figure3": runtime_figure(study, 3, ["original", "4.3", "4.2", "4.2+4.3"], "frozen",
                                  "directions renewed only when satisfied (4.4)"),
        "figure4": figure_4(study),
    }


if __name__ == "__main__":
    study_figures.run(__doc__, "paper", figures_of)
