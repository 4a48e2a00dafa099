"""A flame graph: each function is as wide as it and all that it calls take, and stands on its caller."""
from xml.sax.saxutils import escape

from stacks import room_of, short

WIDTH, ROW, LETTER = 1200, 17, 6.6  # pixels
NARROWEST = 0.3
COLOURS = {"kernels": "#f4a259", "engine": "#8cb8d8", "program": "#b5cf9b", "libraries": "#d0d0d0"}


class Node:
    def __init__(self):
        self.count = 0
        self.children = {}


def tree_of(names):
    """Of a Counter of stacks of names."""
    root = Node()
    for stack, count in names.items():
        node = root
        node.count += count
        for name in stack:
            node = node.children.setdefault(name, Node())
            node.count += count
    return root


def boxes_of(root):
    """(name, samples, depth, share of the width before it, its share of the width), callers first."""
    boxes = []

    def add(node, depth, left):
        for name, child in sorted(node.children.items()):
            boxes.append((name, child.count, depth, left / root.count, child.count / root.count))
            add(child, depth + 1, left)
            left += child.count

    add(root, 0, 0)
    return boxes


def svg_of(names, title):
    root = tree_of(names)
    boxes = [box for box in boxes_of(root) if box[4] * WIDTH >= NARROWEST]
    height = ROW * (max(box[2] for box in boxes) + 1) + 2 * ROW
    lines = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{height}" '
             f'font-family="monospace" font-size="11">',
             f'<rect width="{WIDTH}" height="{height}" fill="white"/>',
             f'<text x="4" y="{ROW - 4}">{escape(title)}</text>']
    for name, count, depth, left, share in boxes:
        x, width, y = left * WIDTH, share * WIDTH, height - ROW * (depth + 1)
        text = escape(short(name)[:int((width - 6) / LETTER)]) if width > 4 * LETTER else ""
        lines.append(f'<g><title>{escape(short(name))}: {100 * share:.1f} %, {count} samples</title>'
                     f'<rect x="{x:.2f}" y="{y}" width="{width:.2f}" height="{ROW - 1}" '
                     f'fill="{COLOURS[room_of(name)]}"/>'
                     f'<text x="{x + 3:.2f}" y="{y + ROW - 5}">{text}</text></g>')
    return "\n".join(lines + ["</svg>", ""])
