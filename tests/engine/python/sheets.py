"""Scenes that the tests of the Python module share."""
import numpy as np

import weft


def sheet(size, material="cotton", pins="edge"):
    """A level sheet of size^2 vertices, 1 m wide, made of a mesh."""
    i, j = np.mgrid[0:size, 0:size]
    positions = np.stack([i, 0 * i, j], axis=-1).reshape(-1, 3) / (size - 1)
    number = np.arange(size * size).reshape(size, size)
    faces = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1)
    mesh = weft.MeshDescription(positions=positions,
                                pins=number[0] if pins == "edge" else pins)
    if material:
        mesh.material = weft.find_material(material)
    mesh.set_faces(faces.reshape(-1, 4))
    return mesh


def model_of(mesh):
    return weft.build_model(weft.cloth_from_mesh(mesh).scene)


def cloth_of(size, **settings):
    return weft.Cloth.create(model_of(sheet(size)), weft.Settings(**settings))


def line(count):
    """The line of particles of README.md."""
    scene = weft.SceneDescription(
        positions=[(0.01 * i, 0, 0) for i in range(count)], masses=np.full(count, 0.005),
        constraints=[(i, i + 1, 0.01, 0, 0) for i in range(count - 1)], fixed=[0])
    return weft.build_model(scene)
