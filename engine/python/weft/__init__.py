"""weft: a cloth simulation library.

    import numpy as np
    import weft

    mesh = weft.MeshDescription(positions=vertices, pins=[0, 10],
                                material=weft.find_material("cotton"))
    mesh.set_faces(faces)                                # an array (faces, corners)
    model = weft.build_model(weft.cloth_from_mesh(mesh).scene)
    cloth = weft.Cloth.create(model, weft.Settings(tolerance=0.01))
    report = cloth.step(1 / 60)
    positions = cloth.read_positions()                   # an array (particles, 3), m

Names are those of the C++ headers, which say more about each. Units are SI. Bad input raises
weft.Error, with one line that names the field, the index and the value; nothing is changed then.
"""
from ._weft import *
from ._weft import Error, kNoIndex

__version__ = "0.6.0"
