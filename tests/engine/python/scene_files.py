"""Scene files of the weft program as scenes of the Python module, and back, without what moves."""
import json
import pathlib

import numpy as np

import weft


def kind_of(name):
    return {"distance": 0, "rope": 1}[name]


def constraint_of(row):
    a, b, length, kind, compliance = row + [None, "distance", 0][len(row) - 2:]
    return a, b, length, kind_of(kind), compliance


def bending_of(entry):
    particles, weights = entry["particles"], entry["weights"]
    absent = 4 - len(particles)
    return (particles + [weft.kNoIndex] * absent, weights + [0.0] * absent, entry.get("rest", 0),
            entry["compliance"], entry.get("fold", 0))


def read_scene(file):
    text = json.loads(pathlib.Path(file).read_text())
    scene = weft.SceneDescription(
        positions=text["positions"], masses=text["masses"], fixed=text.get("fixed", []),
        constraints=[constraint_of(row) for row in text.get("constraints", [])],
        bending=[bending_of(entry) for entry in text.get("bending", [])],
        surface=np.array(text.get("surface", [])).astype(int),
        damping=weft.Damping(**text.get("damping", {})), air=weft.Air(**text.get("air", {})),
        friction=text.get("friction", 0.3), gravity=text["gravity"])
    return scene, [body_of(entry) for entry in text.get("bodies", [])]


def body_of(entry):
    assert entry["shape"] == "hull" and not any(entry["rotation"]) and "moves" not in entry
    return weft.Body(shape=weft.build_shape(weft.Hull(points=entry["points"])),
                     pose=weft.Pose(position=entry["position"]), thickness=entry["thickness"],
                     friction=entry["friction"])


def entry_of(element):
    present = element["particles"] != weft.kNoIndex
    return {"particles": element["particles"][present].tolist(),
            "weights": element["weights"][present].tolist(), "rest": element["rest"].item(),
            "compliance": element["compliance"].item(), "fold": element["fold"].item()}


def write_scene(file, scene, bodies):
    """bodies: entries as the file has them."""
    constraints = [[a, b, length, ["distance", "rope"][kind], compliance]
                   + ([strength] if np.isfinite(strength) else [])
                   for a, b, length, kind, compliance, strength in scene.constraints.tolist()]
    damping, air = scene.damping, scene.air
    pathlib.Path(file).write_text(json.dumps({
        "positions": scene.positions.tolist(), "masses": scene.masses.tolist(),
        "fixed": scene.fixed.tolist(), "constraints": constraints,
        "bending": [entry_of(element) for element in scene.bending],
        "surface": scene.surface.tolist(), "friction": scene.friction,
        "damping": {k: getattr(damping, k) for k in ("stretch", "bending", "motion")},
        "air": {"triangles": air.triangles.tolist(), "density": air.density, "drag": air.drag,
                "lift": air.lift, "ram": air.ram, "wind": air.wind.tolist()},
        "gravity": scene.gravity.tolist(), "bodies": bodies}))
