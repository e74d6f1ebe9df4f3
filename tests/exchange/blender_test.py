# SPDX-License-Identifier: GPL-3.0-or-later
"""What Blender sees in a .vdb file, as JSON: blender -b --factory-startup -P blender_test.py -- MAP.vdb OUT.json X,Y,Z ...

For every grid its name, type and place; for the density grids the vertices of their surface; for each point the light
that comes from there where `density` glows in `color`.
"""

import json
import pathlib
import sys
import tempfile

import bpy


def import_volume(path):
    bpy.ops.object.volume_import(filepath=str(path), directory=str(path.parent), files=[{"name": path.name}])
    volume = bpy.context.object
    volume.data.grids.load()
    return volume


def describe(grid):
    return {
        "name": grid.name,
        "type": grid.data_type,
        "channels": grid.channels,
        "matrix": [list(row) for row in grid.matrix_object],
    }


def surface_vertices(volume, grid_name):
    """Vertices of the mesh around the voxels of a grid, six around one that stands alone."""
    mesh_object = bpy.data.objects.new(grid_name, bpy.data.meshes.new(grid_name))
    bpy.context.collection.objects.link(mesh_object)
    modifier = mesh_object.modifiers.new("mesh", "VOLUME_TO_MESH")
    modifier.object = volume
    modifier.grid_name = grid_name
    modifier.threshold = 1.0
    mesh = mesh_object.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    vertices = [list(vertex.co) for vertex in mesh.vertices]
    bpy.data.objects.remove(mesh_object)
    return vertices


def let_color_glow(volume):
    """A material that emits the grid `color` as strongly as `density` is dense."""
    material = bpy.data.materials.new("glow")
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    color, density = (tree.nodes.new("ShaderNodeAttribute") for _ in range(2))
    color.attribute_name = "color"
    density.attribute_name = "density"
    emission = tree.nodes.new("ShaderNodeEmission")
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(color.outputs["Color"], emission.inputs["Color"])
    tree.links.new(density.outputs["Fac"], emission.inputs["Strength"])
    tree.links.new(emission.outputs["Emission"], output.inputs["Volume"])
    volume.data.materials.append(material)


def prepare_scene():
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.samples = 64
    scene.cycles.use_denoising = False
    scene.render.resolution_x = scene.render.resolution_y = 8
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.world = bpy.data.worlds.new("dark")
    scene.world.use_nodes = False
    scene.world.color = (0, 0, 0)
    scene.camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    scene.camera.data.type = "ORTHO"
    scene.camera.data.ortho_scale = 0.4
    scene.collection.objects.link(scene.camera)
    return scene


def light_from(scene, point, folder):
    """Linear RGB that a camera two metres above the point sees in a square of 0.4 m."""
    scene.camera.location = (point[0], point[1], point[2] + 2)
    scene.render.filepath = str(folder / "frame.exr")
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(scene.render.filepath)
    pixels = list(image.pixels)
    bpy.data.images.remove(image)
    return [sum(pixels[channel::4]) / (len(pixels) // 4) for channel in range(3)]


def main(path, out, points):
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    volume = import_volume(pathlib.Path(path).resolve())
    grids = [describe(grid) for grid in volume.data.grids]
    report = {
        "version": list(bpy.app.version),
        "error": volume.data.grids.error_message,
        "grids": grids,
        "vertices": {g["name"]: surface_vertices(volume, g["name"]) for g in grids if g["name"].startswith("density")},
    }
    let_color_glow(volume)
    scene = prepare_scene()
    with tempfile.TemporaryDirectory() as folder:
        report["light"] = [light_from(scene, point, pathlib.Path(folder)) for point in points]
    pathlib.Path(out).write_text(json.dumps(report))


arguments = sys.argv[sys.argv.index("--") + 1 :]
main(arguments[0], arguments[1], [[float(x) for x in point.split(",")] for point in arguments[2:]])
