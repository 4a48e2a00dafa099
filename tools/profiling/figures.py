"""The tables of tools/profile, from the report of a run, its samples and the bandwidth of copying."""
import re

from stacks import room_of, short

# The elements of the scene that a kernel goes through, by its name.
ITEMS = [(re.compile("membrane"), "membrane_elements", "triangle"),
         (re.compile("bend"), "bending_elements", "bending element"),
         (re.compile("anchor"), "anchors", "anchor"),
         (re.compile("relax|renew|strain|stretch|spring|yarn"), "constraints", "constraint")]


def items_of(name, report):
    """How many items a function goes through, and one of them in words."""
    for pattern, key, noun in ITEMS:
        if room_of(name) == "kernels" and pattern.search(name) and report.get(key, 0) > 0:
            return report[key], noun
    return report["particles"], "particle"


def level_of(footprint, levels):
    """The cache that so many bytes fit in: (name, bytes per second)."""
    for level in levels:
        if footprint <= level["size"]:
            return level["name"], level["bytes_per_second"]
    return levels[-1]["name"], levels[-1]["bytes_per_second"]


def substeps_of(report):
    return max(report["substeps"], 1)


def copy_share(ms, report, levels):
    """The time that it takes to copy all bytes of the cloth once in each substep, against ms a frame."""
    footprint = report["particles"] * report["bytes_per_particle"]
    copy_ms = 1e3 * substeps_of(report) * footprint / level_of(footprint, levels)[1]
    return copy_ms / ms if ms > 0 else 0


def stage_rows(report, levels):
    rows = []
    for stage, ms in report["stages"].items():
        nanoseconds = 1e6 * ms / substeps_of(report) / report["particles"]
        rows.append((stage, ms, ms / report["ms_per_frame"], nanoseconds,
                     copy_share(ms, report, levels)))
    return rows


def sum_of_stages(report):
    """As a share of the frame."""
    return sum(report["stages"].values()) / report["ms_per_frame"]


def kernel_rows(counts, report, levels, most=20, least=0.005):
    """Of functions with the most samples in themselves: name, share, ms a frame, ns per item and substep,
    item, share of copying."""
    total = max(sum(counts.values()), 1)
    rows = []
    for name, count in sorted(counts.items(), key=lambda entry: (-entry[1], entry[0]))[:most]:
        share = count / total
        if share < least:
            continue
        ms = share * report["ms_per_frame"]
        items, noun = items_of(name, report)
        rows.append((short(name), share, ms, 1e6 * ms / substeps_of(report) / items, noun,
                     copy_share(ms, report, levels)))
    return rows


def percent(share):
    return f"{100 * share:.1f} %" if share < 1 else f"{100 * share:.0f} %"


def copying(share):
    """Beyond all of the time it says nothing."""
    return percent(share) if share <= 1 else "> 100 %"


def figure(value):
    return f"{value:.3g}" if value < 1000 else f"{value:.0f}"


def row(name, share, ms, nanoseconds="", noun="", copy=""):
    shown = name if len(name) < 30 else "..." + name[-26:]
    return f"{shown:<30}{share:>8}{ms:>9}{nanoseconds:>9}  {noun:<15}{copy:>7}".rstrip()


def text_of(report, counts, lines, levels):
    footprint = report["particles"] * report["bytes_per_particle"]
    level, rate = level_of(footprint, levels)
    error = "strain" if report["springs"] + report["membrane_elements"] == 0 else "error of the law"
    heading = ("share", "ms", "ns/item", "item", "copying")
    out = [f"{report['scene']}: {report['particles']} particles, {report['constraints']} constraints, "
           f"{report['solver_used']}, {report['isa']}",
           f"{report['ms_per_frame']:.4g} ms per frame in {report['substeps']:.3g} substeps, at max "
           f"{error} {100 * report['max_error']:.3g} %, {report['status']}",
           f"{footprint / 1e6:.3g} MB, which {level} copies at {rate / 1e9:.3g} GB/s", "",
           row("stage", *heading)]
    for stage, ms, share, nanoseconds, copy in stage_rows(report, levels):
        out.append(row(stage, percent(share), figure(ms), figure(nanoseconds), "particle",
                       copying(copy) if ms > 0 else ""))
    out += [row("sum", percent(sum_of_stages(report)), figure(sum(report["stages"].values()))), "",
            row("function, itself", *heading)]
    for name, share, ms, nanoseconds, noun, copy in kernel_rows(counts, report, levels):
        out.append(row(name, percent(share), figure(ms), figure(nanoseconds), noun, copying(copy)))
    if lines:
        out += ["", f"{'line':<60}{'share':>8}"]
        out += [f"{place:<60}{percent(share):>8}" for place, share in lines]
    return "\n".join(out) + "\n"
