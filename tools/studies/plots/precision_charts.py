#!/usr/bin/env python3
"""Draws the charts of `weft precision` from its JSON, as PNG and SVG.

    precision_charts.py precision.json --out FOLDER

precision: error against time per frame, a row for each scene; first_scene: the first row alone;
motion: what was asked for of the motion, what was got, and its time; sizes: time against size.
"""

import study_figures

import matplotlib.patheffects
import matplotlib.pyplot as plt
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter
from matplotlib.transforms import Bbox

# Okabe and Ito's colours, which the colour-blind can tell apart; peers are grey.
COLOURS = {"auto": "#d55e00", "yarn": "#009e73", "direct": "#0072b2", "gauss_seidel": "#e69f00",
           "small_steps": "#56b4e9", "original": "#cc79a7", "bullet": "#808080"}
OTHER = "#000000"
FIRST_ORDER = ("paper", "implicit")
NAMES = {"original": "the paper's original", "bullet": "Bullet"}
FRAME_MS = 10
SMALLEST_STRAIN, LARGEST_STRAIN = 4e-6, 0.25
ENERGY_BOUND = "0.001 J"


def plain(value):
    return f"{value:.10f}".rstrip("0").rstrip(".") if value < 1 else f"{value:g}"


def percent_tick(value, _):
    return plain(100 * value) + " %"


def plain_tick(value, _):
    return plain(value)


# ------------------------------------------------------------------------------ error against time

def curves_of(points):
    """Points by contender and scheme, in the order in which they were measured."""
    curves = {}
    for point in points:
        curves.setdefault((point["contender"], point["scheme"]), []).append(point)
    return curves


def curve_name(contender, scheme):
    name = NAMES.get(contender, contender)
    return f"{name}, {scheme}" if scheme not in ("", "auto") and contender != "original" else name


def front(points, error):
    """The points that none beats in both time and error (by 2 %), from fast to slow."""
    best = []
    for point in sorted(points, key=lambda p: (p["ms_per_frame"], p[error])):
        if not best or point[error] < 0.98 * best[-1][error]:
            best.append(point)
    return best


def place_label(axes, text, colour, spots, taken, busy):
    """Beside one of the spots (data coordinates, the best first), where it covers least."""
    renderer = axes.figure.canvas.get_renderer()
    frame = axes.get_window_extent(renderer)
    best = None
    for rank, (x, y) in enumerate(spots):
        for offset, horizontal, vertical in (((6, 0), "left", "center"), ((5, 6), "left", "bottom"),
                                             ((-6, 0), "right", "center"),
                                             ((0, -7), "center", "top"), ((0, 7), "center", "bottom"),
                                             ((-5, -6), "right", "top"), ((5, -6), "left", "top")):
            label = axes.annotate(text, (x, y), xytext=offset, textcoords="offset points",
                                  ha=horizontal, va=vertical, color=colour, fontsize=8.5,
                                  fontweight="bold", zorder=6)
            box = label.get_window_extent(renderer).padded(1.5)
            cost = 0.7 * rank + 3 * sum(box.contains(*spot) for spot in busy)
            cost += 1000 * sum(Bbox.intersection(box, other) is not None for other in taken)
            inside = Bbox.intersection(box, frame)
            if inside is None or inside.width < box.width - 1 or inside.height < box.height - 1:
                cost += 1000
            label.remove()
            if best is None or cost < best[0]:
                best = (cost, (x, y), offset, horizontal, vertical, box)
    _, spot, offset, horizontal, vertical, box = best
    label = axes.annotate(text, spot, xytext=offset, textcoords="offset points", ha=horizontal,
                          va=vertical, color=colour, fontsize=8.5, fontweight="bold", zorder=6)
    label.set_path_effects([matplotlib.patheffects.withStroke(linewidth=2.5, foreground="white")])
    taken.append(box)


def along(axes, xs, ys):
    """Display coordinates of spots close together on a line of data coordinates."""
    spots = axes.transData.transform(list(zip(xs, ys)))
    dense = [tuple(spot) for spot in spots]
    for (x0, y0), (x1, y1) in zip(spots, spots[1:]):
        count = max(2, int(((x1 - x0) ** 2 + (y1 - y0) ** 2) ** 0.5 / 6))
        dense += [(x0 + (x1 - x0) * k / count, y0 + (y1 - y0) * k / count) for k in range(count)]
    return dense


def draw_panel(axes, curves, error, limits):
    shown = {key: [p for p in points if p[error] and limits[0] <= p[error] <= limits[1]]
             for key, points in curves.items()}
    lines = []
    for (contender, scheme), points in shown.items():
        colour = COLOURS.get(contender, OTHER)
        counting = [p for p in points if p["counts"]]
        failed = [p for p in points if not p["counts"]]
        best = front(counting, error)
        axes.plot([p["ms_per_frame"] for p in counting], [p[error] for p in counting], "o",
                  markersize=2.6, color=colour, alpha=0.3, markeredgewidth=0, zorder=2)
        axes.plot([p["ms_per_frame"] for p in failed], [p[error] for p in failed], "x",
                  markersize=4.2, color=colour, alpha=0.45, markeredgewidth=0.8, zorder=2)
        if not best:
            continue
        xs, ys = [p["ms_per_frame"] for p in best], [p[error] for p in best]
        axes.plot(xs, ys, color=colour, linewidth=2.6 if contender == "auto" else 1.7,
                  linestyle=(0, (4, 1.6)) if scheme in FIRST_ORDER and contender != "original" else "-",
                  marker="o", markersize=4.6, markeredgecolor="white", markeredgewidth=0.7,
                  zorder=4 if contender == "auto" else 3)
        lines.append((contender, scheme, colour, xs, ys))
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_ylim(*limits)
    axes.margins(x=0.14)
    return lines


def label_lines(axes, lines):
    axes.figure.canvas.draw()
    taken = []
    busy = [spot for *_, xs, ys in lines for spot in along(axes, xs, ys)]
    for contender, scheme, colour, xs, ys in lines:
        spots = list(zip(xs, ys))
        spots = [spots[-1], spots[0]] + spots[-2:0:-1]
        place_label(axes, curve_name(contender, scheme), colour, spots, taken, busy)


def decorate(axes):
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(LogLocator(numticks=12))
        axis.set_minor_formatter(NullFormatter())
    axes.grid(color="0.9", linewidth=0.8)
    axes.xaxis.set_major_formatter(FuncFormatter(plain_tick))


def trajectory_limits(points, floor):
    errors = [p["trajectory_error"] for p in points if p["trajectory_error"] and p["counts"]]
    if not errors:
        return floor, 0.4
    return max(min(errors) / 2, floor), min(max(errors) * 1.6, 0.4)


def draw_scene(panels, study, scene):
    points = [p for p in study["points"] + study["peers"]
              if (p["scene"], p["size"]) == (scene["scene"], scene["size"])]
    curves = curves_of(points)
    size = scene["size"]
    is_square = scene["particles"] == size ** 2
    name = f"{scene['scene']}, {f'{size} x {size}' if is_square else size} particles"

    strain, trajectory = panels
    lines = draw_panel(strain, curves, "max_strain", (SMALLEST_STRAIN, LARGEST_STRAIN))
    decorate(strain)
    strain.yaxis.set_major_formatter(FuncFormatter(percent_tick))
    strain.set_ylabel("largest strain of the whole run")
    strain.set_title(f"{name}: constraint error")
    label_lines(strain, lines)

    limits = trajectory_limits(points, scene["reference_error"])
    lines = draw_panel(trajectory, curves, "trajectory_error", limits)
    decorate(trajectory)
    trajectory.set_xlim(strain.get_xlim())
    trajectory.yaxis.set_major_formatter(FuncFormatter(lambda v, _: plain(1000 * v) + " mm"))
    trajectory.set_ylabel("largest distance to the true motion at 0.4 s")
    by = scene["reference_by"].split(",")[0]
    note = f" (reference: {by})" if by == "small_steps" else ""
    trajectory.set_title(f"{name}: trajectory error{note}")
    label_lines(trajectory, lines)


def precision_figure(study):
    scenes = study["scenes"]
    height = 4.7 * len(scenes) + 1.1
    figure, panels = plt.subplots(len(scenes), 2, figsize=(11.6, height), squeeze=False)
    figure.subplots_adjust(left=0.075, right=0.985, top=1 - 0.85 / height, bottom=0.95 / height,
                           hspace=0.2, wspace=0.2)
    for row, scene in zip(panels, scenes):
        draw_scene(row, study, scene)
    for axes in panels[-1]:
        axes.set_xlabel("ms per frame of 10 ms")

    threads = scenes[0]["threads"]
    figure.suptitle("The cost of an error", x=0.075, y=1 - 0.14 / height, ha="left",
                    fontweight="bold", fontsize=12.5)
    notes = [f"lower left is better; {threads} thread{'s' if threads > 1 else ''}, "
             f"{scenes[0]['frames']} frames, {'wall' if threads > 1 else 'processor'} time; every solver at its best of substeps, tolerances and "
             "iterations"]
    if study["bullet"] == "not built in":
        notes.append("Bullet: not built in")
    if study["quick"]:
        notes.append("QUICK run")
    figure.text(0.075, 1 - 0.48 / height, "; ".join(notes), fontsize=8.5, color="0.35")
    handles = [
        Line2D([], [], color="0.3", marker="o", markersize=4.6, markeredgecolor="white"),
        Line2D([], [], color="0.3", linestyle=(0, (4, 1.6)), marker="o", markersize=4.6,
               markeredgecolor="white"),
        Line2D([], [], color="0.3", marker="o", markersize=3, linestyle="none", alpha=0.4),
        Line2D([], [], color="0.3", marker="x", markersize=4.5, linestyle="none", alpha=0.6)]
    texts = ["best settings, second order (or a peer)", "best settings, first order",
             "other settings", f"missed its tolerance, or gained over {ENERGY_BOUND}"]
    figure.legend(handles, texts, loc="lower center", ncol=4, columnspacing=2, handlelength=2.6)
    return figure


# ------------------------------------------------------------------------- the motion asked and got

def motion_figure(points, quick):
    figure, (got, cost) = plt.subplots(1, 2, figsize=(11.6, 4.9))
    colours = list(COLOURS.values())
    scenes = sorted({(p["scene"], p["size"]) for p in points})
    for colour, (scene, size) in zip(colours, scenes):
        curve = [p for p in points if (p["scene"], p["size"]) == (scene, size)]
        asked = [p for p in curve if p["asked"] > 0]
        style = {"color": colour, "linewidth": 1.9, "marker": "o", "markersize": 5,
                 "markeredgecolor": "white", "markeredgewidth": 0.8}
        got.plot([1000 * p["asked"] for p in asked], [1000 * p["got"] for p in asked],
                 label=f"{scene}, {size} x {size}", **style)
        cost.plot([p["ms_per_frame"] for p in asked], [1000 * p["got"] for p in asked], **style)
        plain_call = [p for p in curve if p["asked"] == 0]
        cost.plot([p["ms_per_frame"] for p in plain_call], [1000 * p["got"] for p in plain_call],
                  "s", color=colour, markersize=7, markerfacecolor="none")
    ends = [1000 * extreme(p["asked"] for p in points if p["asked"] > 0) for extreme in (min, max)]
    got.plot(ends, ends, color="0.45", linewidth=1, zorder=1)
    got.fill_between(ends, [e / 3 for e in ends], [3 * e for e in ends], color="0.93", zorder=0)
    for axes in (got, cost):
        axes.set_xscale("log")
        axes.set_yscale("log")
        decorate(axes)
        axes.yaxis.set_major_formatter(FuncFormatter(plain_tick))
        axes.set_ylabel("got, mm/s")
    got.set_xlabel("asked for: motion_tolerance, mm/s")
    got.set_title("grey: within three times")
    got.legend(loc="upper left")
    cost.set_xlabel("ms per frame of 10 ms")
    cost.set_title("squares: without a motion_tolerance")
    figure.suptitle("What is asked for of the motion, and got", x=0.065, ha="left",
                    fontweight="bold", fontsize=12.5)
    figure.text(0.065, 0.9, "largest distance to the true motion after 0.4 s, over that time; small "
                "steps at 1 %" + ("; QUICK run" if quick else ""), fontsize=8.5, color="0.35")
    figure.subplots_adjust(left=0.065, right=0.985, top=0.82, bottom=0.11, wspace=0.18)
    return figure


# -------------------------------------------------------------------------------- time against size

def sizes_figure(sizes, quick):
    figure, axes = plt.subplots(figsize=(8.6, 5.4))
    lines = []
    for curve in sizes["curves"]:
        if not curve["points"]:
            continue
        colour = COLOURS.get(curve["solver"], OTHER)
        xs = [p["size"] ** 2 for p in curve["points"]]
        ys = [p["ms_per_frame"] for p in curve["points"]]
        axes.plot(xs, ys, color=colour, linewidth=2.6 if curve["solver"] == "auto" else 1.8,
                  marker="o", markersize=5, markeredgecolor="white", markeredgewidth=0.8)
        exponent = f"  $n^{{{curve['exponent']:.2f}}}$" if curve["exponent"] else ""
        lines.append((curve["solver"] + exponent, "", colour, xs, ys))
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.margins(x=0.14, y=0.08)
    axes.axhline(FRAME_MS, color="0.45", linewidth=1, linestyle=(0, (4, 3)), zorder=1)
    axes.annotate("real time", (0.995, FRAME_MS), xycoords=axes.get_yaxis_transform(),
                  xytext=(0, 3), textcoords="offset points", ha="right", color="0.35", fontsize=8.5)
    decorate(axes)
    axes.yaxis.set_major_formatter(FuncFormatter(plain_tick))
    every = sorted({p["size"] for curve in sizes["curves"] for p in curve["points"]})
    ticks = [size for size in every if size in (20, 40, 60, 100, 200, 300, 500, 1000)] or every
    axes.set_xticks([size ** 2 for size in ticks], [f"{size}²" for size in ticks])
    axes.set_xticks([], minor=True)
    axes.set_xlabel("particles")
    axes.set_ylabel("ms per frame of 10 ms")
    threads = "all threads" if sizes["threads"] == 0 else \
        f"{sizes['threads']} thread{'s' if sizes['threads'] > 1 else ''}"
    figure.suptitle("What a particle costs", x=0.09, ha="left", fontweight="bold", fontsize=12.5)
    figure.text(0.09, 0.915, f"{sizes['scene']}, {100 * sizes['tolerance']:g} % in every one of "
                f"{sizes['frames']} frames, {threads}; n: particles"
                + ("; QUICK run" if quick else ""), fontsize=8.5, color="0.35")
    figure.subplots_adjust(left=0.09, right=0.98, top=0.88, bottom=0.1)
    label_lines(axes, lines)
    return figure


def figures_of(study):
    figures = {"precision": precision_figure(study),
               "first_scene": precision_figure({**study, "scenes": study["scenes"][:1]})}
    if study["motion"]:
        figures["motion"] = motion_figure(study["motion"], study["quick"])
    if "sizes" in study:
        figures["sizes"] = sizes_figure(study["sizes"], study["quick"])
    return figures


if __name__ == "__main__":
    study_figures.run(__doc__, "precision", figures_of)
