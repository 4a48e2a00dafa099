"""Fits the bending stiffness of a fabric to how far a strip of it hangs down over an edge.

    python3 fit_stiffness.py --sag 0.03       # m, measured at the free end of a strip of 0.1 m
    python3 fit_stiffness.py --check 2e-5     # measures a strip of this stiffness, N m, and fits it

This is the cantilever test of textile laboratories. The sag falls as the stiffness grows, so that
halving an interval of its logarithm finds it.
"""
import argparse
import math

import numpy as np

import weft

LENGTH, WIDTH = 0.1, 0.02  # m


def strip(bending, cells):
    """A level strip whose first two rows are held."""
    across = max(1, round(cells * WIDTH / LENGTH))
    i, j = np.mgrid[0:cells + 2, 0:across + 1]
    number = np.arange(i.size).reshape(i.shape)
    faces = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1)
    cotton = weft.find_material("cotton")
    cotton.bending, cotton.damping_motion = bending, 20  # it soon comes to rest
    spacing = LENGTH / cells
    mesh = weft.MeshDescription(
        positions=np.stack([(i - 1) * spacing, 0 * i, j * WIDTH / across], axis=-1).reshape(-1, 3),
        material=cotton, pins=number[:2].ravel())
    mesh.set_faces(faces.reshape(-1, 4))
    return weft.build_model(weft.cloth_from_mesh(mesh).scene)


def sag(bending, cells):
    """m, by which the free end hangs below the edge at rest."""
    cloth = weft.Cloth.create(strip(bending, cells), weft.Settings(tolerance=1e-3))
    before = 0.0
    for _ in range(100):
        for _ in range(10):
            cloth.step(1 / 60)
        now = -cloth.position(cloth.particle_count() - 1)[1]
        if abs(now - before) < 1e-6:
            break
        before = now
    return now


def fit(measured, cells, low=1e-7, high=1e-2):
    """N m; between low and high."""
    for _ in range(20):
        middle = math.sqrt(low * high)
        low, high = (middle, high) if sag(middle, cells) > measured else (low, middle)
    return math.sqrt(low * high)


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    what = options.add_mutually_exclusive_group(required=True)
    what.add_argument("--sag", type=float, help="m")
    what.add_argument("--check", type=float, help="N m")
    options.add_argument("--cells", type=int, default=20, help="along the strip")
    given = options.parse_args()
    measured = given.sag if given.check is None else sag(given.check, given.cells)
    print(f"sag {1000 * measured:.3f} mm: bending {fit(measured, given.cells):.4g} N m")


if __name__ == "__main__":
    main()
