"""usage: blender -b --factory-startup --python read_in_blender.py -- FOLDER FRAME...

Prints, as JSON, where Blender has the vertices of FOLDER/start.obj in these frames of a run, with
the Mesh Cache modifier for FOLDER/motion.pc2.
"""
import json
import sys

import bpy


def places(cloth, frame):
    bpy.context.scene.frame_set(frame)
    evaluated = cloth.evaluated_get(bpy.context.evaluated_depsgraph_get())
    return [list(cloth.matrix_world @ vertex.co) for vertex in evaluated.data.vertices]


def with_point_cache(folder):
    bpy.ops.wm.obj_import(filepath=f"{folder}/start.obj", forward_axis="Y", up_axis="Z")
    cloth = bpy.data.objects["cloth"]
    cache = cloth.modifiers.new("cache", "MESH_CACHE")
    cache.cache_format = "PC2"
    cache.filepath = f"{folder}/motion.pc2"
    cache.frame_start = 0
    return cloth


folder, *frames = sys.argv[sys.argv.index("--") + 1:]
bpy.ops.wm.read_factory_settings(use_empty=True)
cloth = with_point_cache(folder)
print("places", json.dumps([places(cloth, int(frame)) for frame in frames]))
