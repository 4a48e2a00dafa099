"""Draws a sheet of fabric that has come to lie over a ball.

    python3 draw_drape.py --material silk --size 40 --out drape.png
"""
import argparse

import matplotlib
import numpy as np

import weft

matplotlib.use("Agg")
import matplotlib.pyplot as plt


def sheet(size, material):
    """A level sheet, 1 m wide, of size^2 vertices."""
    i, j = np.mgrid[0:size, 0:size]
    number = np.arange(size * size).reshape(size, size)
    faces = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1)
    mesh = weft.MeshDescription(positions=np.stack([i, 0 * i, j], axis=-1).reshape(-1, 3) / (size - 1),
                                material=weft.find_material(material))
    mesh.set_faces(faces.reshape(-1, 4))
    return mesh


def drape(made, seconds):
    cloth = weft.Cloth.create(weft.build_model(made.scene))
    ball = weft.build_shape(weft.Ball(centre=(0.5, -0.31, 0.5), radius=0.3))
    cloth.add_body(weft.Body(shape=ball, friction=0.5))
    for _ in range(round(60 * seconds)):
        report = cloth.step(1 / 60)
        if report.status != weft.Status.converged:
            print(report)
    return cloth


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--material", default="silk")
    options.add_argument("--size", type=int, default=40)
    options.add_argument("--seconds", type=float, default=2)
    options.add_argument("--out", default="drape.png")
    given = options.parse_args()
    mesh = sheet(given.size, given.material)
    made = weft.cloth_from_mesh(mesh)
    surface = weft.surface_of_mesh(mesh, made)
    positions, _ = surface.read_vertices(drape(made, given.seconds))
    axes = plt.figure(figsize=(6, 5)).add_subplot(projection="3d")
    axes.plot_trisurf(positions[:, 0], positions[:, 2], positions[:, 1],
                      triangles=surface.triangles(), color="lightsteelblue", linewidth=0.1)
    axes.set_box_aspect(np.ptp(positions[:, [0, 2, 1]], axis=0))
    axes.set_title(f"{given.material}, {given.size} x {given.size}, after {given.seconds:g} s")
    plt.savefig(given.out, dpi=120)
    print(f"lowest {positions[:, 1].min():.3f} m: {given.out}")


if __name__ == "__main__":
    main()
