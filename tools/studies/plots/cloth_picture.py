#!/usr/bin/env python3
"""Draws the frames saved by `weft run --out FILE.obj`, side by side in one PNG.

    cloth_picture.py --out picture.png hang.obj hang_sphere.obj=caption sphere_drop.obj

Each mesh is drawn into a depth buffer, so that cloth and spheres hide each other correctly, and
lit by one light that casts shadows. The thin lines on the cloth are the edges of its faces.
Needs numpy and matplotlib (Debian: python3-matplotlib).
"""

import argparse
import os
import sys

import numpy as np

UP = np.array([0.0, 1.0, 0.0])
LIGHT = np.array([0.35, 1.0, 0.55]) / np.linalg.norm([0.35, 1.0, 0.55])  # towards the light
FRONT = np.array([0.20, 0.43, 0.62])
BACK = np.array([0.78, 0.52, 0.33])
SPHERE = np.array([0.80, 0.79, 0.76])
SUPERSAMPLE = 3
SHADOW_SIZE = 700


class Mesh:
    """One object of an OBJ file: its triangles, and which of their sides are edges of a face."""

    def __init__(self, vertices, faces, is_sphere):
        self.is_sphere = is_sphere
        triangles, sides = [], []
        for face in faces:
            for k in range(1, len(face) - 1):
                triangles.append((face[0], face[k], face[k + 1]))
                # Sides opposite to corner 0, 1, 2: the fan's diagonals are no edges of the face.
                sides.append((True, k == len(face) - 2, k == 1))
        used, triangles = np.unique(np.array(triangles), return_inverse=True)
        self.vertices = vertices[used]
        self.triangles = triangles.reshape(-1, 3)
        self.sides = np.array(sides)
        self.normals = self._vertex_normals()

    def _vertex_normals(self):
        a, b, c = (self.vertices[self.triangles[:, k]] for k in range(3))
        face_normals = np.cross(b - a, c - a)
        normals = np.zeros_like(self.vertices)
        for k in range(3):
            np.add.at(normals, self.triangles[:, k], face_normals)
        if self.is_sphere:  # whatever way its faces wind
            normals = self.vertices - self.vertices.mean(axis=0)
        return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)


def read_obj(path):
    """The file's objects; those whose name begins with "sphere" are spheres."""
    vertices, groups, name = [], {}, "cloth"
    with open(path, encoding="utf-8") as lines:
        for line in lines:
            words = line.split()
            if not words:
                continue
            if words[0] == "v":
                vertices.append([float(word) for word in words[1:4]])
            elif words[0] in ("o", "g") and len(words) > 1:
                name = words[1]
            elif words[0] == "f":
                corners = [int(word.split("/")[0]) for word in words[1:]]
                groups.setdefault(name, []).append(
                    [c - 1 if c > 0 else len(vertices) + c for c in corners])
    if not groups:
        raise ValueError(f"{path}: no faces")
    vertices = np.array(vertices)
    meshes = [Mesh(vertices, faces, name.startswith("sphere")) for name, faces in groups.items()]
    # The longest distance across a face of the cloth.
    across = max((np.linalg.norm(vertices[face[0]] - vertices[face[len(face) // 2]])
                  for name, faces in groups.items() if not name.startswith("sphere")
                  for face in faces), default=0.0)
    return [smooth_sphere(mesh, across) if mesh.is_sphere else mesh for mesh in meshes]


def smooth_sphere(mesh, cloth_faces):
    """A finer sphere in place of the file's, drawn smaller by as much as the flat faces between
    particles that touch it would otherwise cut into it."""
    centre = (mesh.vertices.min(axis=0) + mesh.vertices.max(axis=0)) / 2
    radius = float(np.linalg.norm(mesh.vertices - centre, axis=1).max())
    radius = 0.995 * np.sqrt(max(radius**2 - (cloth_faces / 2)**2, (0.8 * radius)**2))
    rows, columns = 28, 56
    theta = np.repeat(np.linspace(0, np.pi, rows + 1), columns)
    phi = np.tile(np.arange(columns) * 2 * np.pi / columns, rows + 1)
    vertices = centre + radius * np.stack(
        [np.sin(theta) * np.cos(phi), np.cos(theta), np.sin(theta) * np.sin(phi)], 1)
    faces = []
    for r in range(rows):
        for c in range(columns):
            a, b = r * columns + c, r * columns + (c + 1) % columns
            faces.append([a, b, b + columns, a + columns])
    return Mesh(vertices, faces, True)


class View:
    """An orthonormal frame looking along -toward_eye; orthographic unless `distance` is given."""

    def __init__(self, toward_eye, distance=None):
        self.forward = toward_eye / np.linalg.norm(toward_eye)
        self.right = np.cross(UP, self.forward)
        self.right /= np.linalg.norm(self.right)
        self.up = np.cross(self.forward, self.right)
        self.distance = distance
        self.centre = np.zeros(3)
        self.scale, self.offset = 1.0, np.zeros(2)

    def project(self, points):
        """Pixel x, pixel y, and nearness: larger is nearer to the eye."""
        d = points - self.centre
        x, y, near = d @ self.right, d @ self.up, d @ self.forward
        if self.distance:
            w = self.distance / (self.distance - near)
            x, y = x * w, y * w
        return np.stack([x * self.scale + self.offset[0], -y * self.scale + self.offset[1], near], 1)

    def fit(self, points, width, height, margin):
        """Scales and shifts so that all points lie inside the picture."""
        self.centre = (points.min(axis=0) + points.max(axis=0)) / 2
        self.scale, self.offset = 1.0, np.zeros(2)
        flat = self.project(points)[:, :2]
        low, high = flat.min(axis=0), flat.max(axis=0)
        self.scale = float(np.min((np.array([width, height]) - 2 * margin) / (high - low)))
        self.offset = np.array([width, height]) / 2 - self.scale * (low + high) / 2


def fragments(view, mesh, width, height):
    """For every triangle: its pixels and their barycentric coordinates."""
    screen = view.project(mesh.vertices)
    for index, triangle in enumerate(mesh.triangles):
        p = screen[triangle]
        x0, y0 = np.maximum(np.floor(p[:, :2].min(axis=0)).astype(int), 0)
        x1, y1 = np.minimum(np.ceil(p[:, :2].max(axis=0)).astype(int) + 1, (width, height))
        if x0 >= x1 or y0 >= y1:
            continue
        area = (p[1, 0] - p[0, 0]) * (p[2, 1] - p[0, 1]) - (p[2, 0] - p[0, 0]) * (p[1, 1] - p[0, 1])
        if abs(area) < 1e-9:
            continue
        x, y = np.meshgrid(np.arange(x0, x1) + 0.5, np.arange(y0, y1) + 0.5)
        w = []
        for k in range(3):
            q, r = p[(k + 1) % 3], p[(k + 2) % 3]
            w.append(((q[0] - x) * (r[1] - y) - (r[0] - x) * (q[1] - y)) / area)
        w = np.stack(w, axis=-1)
        inside = np.all(w >= -1e-6, axis=-1)
        if inside.any():
            rows, columns = np.nonzero(inside)
            yield index, rows + y0, columns + x0, w[inside], p


def shadow_depth(meshes, points):
    view = View(LIGHT)
    view.fit(points, SHADOW_SIZE, SHADOW_SIZE, 4)
    depth = np.full((SHADOW_SIZE, SHADOW_SIZE), -np.inf)
    for mesh in meshes:
        for _, rows, columns, w, p in fragments(view, mesh, SHADOW_SIZE, SHADOW_SIZE):
            depth[rows, columns] = np.maximum(depth[rows, columns], w @ p[:, 2])
    return view, depth


def lit_fraction(shadow, points, bias):
    """How much of the light reaches the points: nine samples of the shadow map."""
    view, depth = shadow
    screen = view.project(points)
    column, row = screen[:, 0].astype(int), screen[:, 1].astype(int)
    lit = np.zeros(len(points))
    for dy in (-3, 0, 3):
        for dx in (-3, 0, 3):
            r = np.clip(row + dy, 0, SHADOW_SIZE - 1)
            c = np.clip(column + dx, 0, SHADOW_SIZE - 1)
            lit += depth[r, c] <= screen[:, 2] + bias
    return lit / 9


def line_strength(mesh, index, w, p):
    """1 on the edges of a face, falling to 0 within about a pixel and a half of the picture."""
    area = abs((p[1, 0] - p[0, 0]) * (p[2, 1] - p[0, 1]) - (p[2, 0] - p[0, 0]) * (p[1, 1] - p[0, 1]))
    strength = np.zeros(len(w))
    for k in range(3):
        if mesh.sides[index, k]:
            length = np.linalg.norm(p[(k + 1) % 3, :2] - p[(k + 2) % 3, :2])
            pixels = np.abs(w[:, k]) * area / max(length, 1e-9)
            strength = np.maximum(strength, np.clip(1.4 - pixels / SUPERSAMPLE * 1.6, 0, 1))
    return strength


def shade(mesh, index, w, p, toward_eye, shadow, extent):
    corners = mesh.triangles[index]
    a, b, c = mesh.vertices[corners]
    points, normals = w @ mesh.vertices[corners], w @ mesh.normals[corners]
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
    front = np.cross(b - a, c - a) @ toward_eye > 0
    colour = SPHERE if mesh.is_sphere else (FRONT if front else BACK)
    # Light the side that is seen, judged by the face: at a silhouette the smooth normal may differ.
    if not mesh.is_sphere and not front:
        normals = -normals
    facing = normals @ LIGHT
    lit = lit_fraction(shadow, points + normals * 0.012 * extent, 0.006 * extent)
    half = (LIGHT + toward_eye) / np.linalg.norm(LIGHT + toward_eye)
    diffuse = np.clip(facing, 0, 1) * lit
    # Cloth lets some light through to the side that lies away from it.
    through = 0.0 if mesh.is_sphere else 0.22
    sky = 0.5 + 0.5 * normals[:, 1]
    intensity = 0.34 + 0.20 * sky + 0.62 * diffuse + through * np.clip(-facing, 0, 1)
    gloss = (0.25 if mesh.is_sphere else 0.10) * np.clip(normals @ half, 0, 1) ** 30 * lit
    result = colour * intensity[:, None] + gloss[:, None]
    if not mesh.is_sphere:
        result *= (1 - 0.30 * line_strength(mesh, index, w, p))[:, None]
    return result


def render(meshes, size, azimuth, elevation):
    """An RGBA picture with a transparent background."""
    pixels = size * SUPERSAMPLE
    points = np.concatenate([mesh.vertices for mesh in meshes])
    extent = float(np.linalg.norm(points.max(axis=0) - points.min(axis=0)))
    azimuth, elevation = np.radians(azimuth), np.radians(elevation)
    toward_eye = np.array([np.cos(elevation) * np.sin(azimuth), np.sin(elevation),
                           np.cos(elevation) * np.cos(azimuth)])
    view = View(toward_eye, distance=3.2 * extent)
    view.fit(points, pixels, pixels, 0.04 * pixels)
    eye = view.centre + view.distance * view.forward
    shadow = shadow_depth(meshes, points)

    image = np.zeros((pixels, pixels, 4))
    depth = np.full((pixels, pixels), -np.inf)
    for mesh in meshes:
        for index, rows, columns, w, p in fragments(view, mesh, pixels, pixels):
            near = w @ p[:, 2]
            nearer = near > depth[rows, columns]
            if not nearer.any():
                continue
            rows, columns, w = rows[nearer], columns[nearer], w[nearer]
            depth[rows, columns] = near[nearer]
            towards = eye - mesh.vertices[mesh.triangles[index]].mean(axis=0)
            towards /= np.linalg.norm(towards)
            image[rows, columns, :3] = shade(mesh, index, w, p, towards, shadow, extent)
            image[rows, columns, 3] = 1
    return reduce(np.clip(image, 0, 1), SUPERSAMPLE)


def reduce(image, factor):
    """Averages blocks of pixels; colours weigh by their coverage."""
    height, width = image.shape[0] // factor, image.shape[1] // factor
    image = image.copy()
    image[..., :3] *= image[..., 3:]
    image = image.reshape(height, factor, width, factor, 4).mean(axis=(1, 3))
    image[..., :3] /= np.maximum(image[..., 3:], 1e-9)
    return image


def on_background(image):
    """Lays the picture on a soft grey that darkens downwards."""
    height = image.shape[0]
    shade_ = np.linspace(0.985, 0.93, height)[:, None, None] * np.array([1.0, 1.0, 1.0])
    return image[..., :3] * image[..., 3:] + shade_ * (1 - image[..., 3:])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("obj", nargs="+", help="OBJ file, or FILE=CAPTION")
    parser.add_argument("--out", required=True, help="the PNG to write")
    parser.add_argument("--size", type=int, default=440, help="pixels of one picture's side")
    parser.add_argument("--azimuth", type=float, default=38, help="degrees from +z towards +x")
    parser.add_argument("--elevation", type=float, default=24, help="degrees above the horizon")
    options = parser.parse_args()

    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    count, size, band = len(options.obj), options.size, 34
    figure = plt.figure(figsize=(count * size / 100, (size + band) / 100), dpi=100)
    for index, argument in enumerate(options.obj):
        path, _, caption = argument.partition("=")
        caption = caption or os.path.splitext(os.path.basename(path))[0]
        picture = on_background(render(read_obj(path), size, options.azimuth, options.elevation))
        axes = figure.add_axes([index / count, band / (size + band), 1 / count, size / (size + band)])
        axes.imshow(picture, interpolation="none", aspect="auto")
        axes.axis("off")
        figure.text((index + 0.5) / count, band / (size + band) / 2, caption, ha="center",
                    va="center", fontsize=11, color="0.2")
    figure.savefig(options.out, dpi=100)
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (OSError, ValueError) as problem:
        sys.exit(f"cloth_picture.py: {problem}")
