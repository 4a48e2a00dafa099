"""Samples of perf: whole stacks, and what is told from them."""
import re
from collections import Counter

ROOMS = ("kernels", "engine", "program", "libraries")
KERNEL = re.compile(r"weft::simd::(sse2|avx2|avx512|neon)::")


def without_arguments(name):
    """Without what stands in brackets of templates and calls; "(anonymous namespace)" goes, too."""
    name = name.replace("(anonymous namespace)::", "").replace("{lambda", "lambda")
    kept, depth = [], 0
    for i, letter in enumerate(name):
        opens = letter in "<(" and not name[:i].endswith("operator")
        closes = letter in ">)" and depth > 0 and name[i - 1] != "-"
        depth += opens - closes
        if depth == 0 and not closes:
            kept.append(letter)
    words = re.sub(r"#\d+}", "", "".join(kept)).replace(" const", "").split()
    return words[-1] if words else name


def room_of(name):
    if KERNEL.search(name):
        return "kernels"
    if name.startswith("weft::tools::") or name == "main":
        return "program"
    return "engine" if name.startswith("weft::") else "libraries"


def short(name):
    """relax_quads (avx512), SmallSteps::solve, memcpy"""
    kernel = KERNEL.search(name)
    if kernel:
        return f"{name[kernel.end():]} ({kernel[1]})"
    return name.removeprefix("weft::")


def read_stacks(text, program):
    """Of `perf script -F ip,sym,dso`: a Counter of stacks, each from the outermost caller inwards and made
    of pairs of a name and an address, which is None outside of the file `program`."""
    stacks = Counter()
    for block in text.split("\n\n"):
        frames = []
        for line in block.strip().splitlines():
            address, _, rest = line.strip().partition(" ")
            name, _, file = rest.rpartition(" (")
            is_own = file.removesuffix(")") == program
            frames.append((without_arguments(name.strip()), int(address, 16) if is_own else None))
        if frames:
            stacks[tuple(reversed(frames))] += 1
    return stacks


def named(stacks):
    """Stacks of names alone."""
    names = Counter()
    for stack, count in stacks.items():
        names[tuple(name for name, _ in stack)] += count
    return names


def within(stacks, name):
    """The stacks that call a function, and how many of all samples they are."""
    inside = Counter({stack: count for stack, count in stacks.items()
                      if any(frame[0] == name for frame in stack)})
    return inside, inside.total() / max(stacks.total(), 1)


def self_counts(stacks):
    """Samples in each function itself, most first."""
    counts = Counter()
    for stack, count in stacks.items():
        counts[stack[-1][0]] += count
    return counts


def hot_addresses(stacks):
    """Samples at each address of the program itself."""
    counts = Counter()
    for stack, count in stacks.items():
        if stack[-1][1] is not None:
            counts[stack[-1][1]] += count
    return counts
