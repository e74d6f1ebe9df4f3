# SPDX-License-Identifier: GPL-3.0-or-later
"""Opens maps of vdbmap in Blender (3.4 or later), lit, with a camera:

    blender -P tools/blender/open_map.py -- map.vdb                       # a map
    blender -P tools/blender/open_map.py -- map2.vdb --diff diff.vdb      # what changed, over a pale map
    blender -P tools/blender/open_map.py -- 2023.vdb 2024.vdb 2025.vdb    # epochs, one after the other
    blender -b -P tools/blender/open_map.py -- map.vdb --render map.png   # without a window: a picture
    blender -b -P tools/blender/open_map.py -- map.vdb --render turn --turn 90   # turn0001.png to turn0090.png

--save FILE.blend keeps the scene. --seconds S is how long each epoch is shown. Vanished is red, appeared green, changed
amber, as in the file's grid `color`. Voxels become lit cubes, of a coarser level where there are more than --most of them.
That needs OpenVDB's Python module, which Blender brings on most systems (Debian: python3-openvdb); without it, or with
--fog, maps are volumes, of which Blender makes dense textures: 14 bytes for each voxel of the box around the map.
"""

import argparse
import importlib
import math
import pathlib
import sys

import bpy
import numpy
from mathutils import Vector

PALE = (0.62, 0.62, 0.6, 1.0)
MARGIN = 1.05  # of the picture around the map
COLORS = "voxel_color"  # of meshes
STRAY = 0.005  # of the voxels on each side of the map, which may lie outside of the picture
MOST_PLACES = 100_000  # looked at
BLOCK = 128  # voxels along the edge of what is read at once
# Of each side of a voxel the way out, and its corners, against the clock seen from outside.
SIDES = (
    ((-1, 0, 0), ((0, 0, 0), (0, 0, 1), (0, 1, 1), (0, 1, 0))),
    ((1, 0, 0), ((1, 0, 0), (1, 1, 0), (1, 1, 1), (1, 0, 1))),
    ((0, -1, 0), ((0, 0, 0), (1, 0, 0), (1, 0, 1), (0, 0, 1))),
    ((0, 1, 0), ((0, 1, 0), (0, 1, 1), (1, 1, 1), (1, 1, 0))),
    ((0, 0, -1), ((0, 0, 0), (0, 1, 0), (1, 1, 0), (1, 0, 0))),
    ((0, 0, 1), ((0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))),
)


def openvdb_module():
    for name in ("openvdb", "pyopenvdb"):
        try:
            return importlib.import_module(name)
        except ImportError:
            pass
    return None


def parse_arguments():
    arguments = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
    parser = argparse.ArgumentParser(prog="open_map.py", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("maps", nargs="+", type=pathlib.Path, metavar="MAP.vdb")
    parser.add_argument("--diff", type=pathlib.Path, help="what `vdbmap diff -o` wrote")
    parser.add_argument("--render", type=pathlib.Path, help="picture, or beginning of the pictures' names")
    parser.add_argument("--save", type=pathlib.Path, help="the scene as .blend")
    parser.add_argument("--size", default="1280x720", help="of pictures [1280x720]")
    parser.add_argument("--samples", type=int, default=48, help="light paths a pixel [48]")
    parser.add_argument("--turn", type=int, default=0, metavar="FRAMES", help="the camera goes once around in so many frames")
    parser.add_argument("--seconds", type=float, default=2.0, help="that each epoch is shown [2]")
    parser.add_argument("--heading", type=float, help="of the view, degrees to the left of +x; by default across the map")
    parser.add_argument("--elevation", type=float, default=-35.0, help="of the view, degrees; below the horizon negative [-35]")
    parser.add_argument("--fog", action="store_true", help="volumes instead of cubes")
    parser.add_argument("--most", type=float, default=1.5e6, help="voxels of a map that become cubes [1500000]")
    parser.add_argument("--look-at", help="X,Y,Z,RADIUS [m, local frame] instead of the whole map")
    options = parser.parse_args(arguments)
    for path in options.maps + ([options.diff] if options.diff else []):
        if not path.is_file():
            parser.error(f"{path}: no such file")
    return options


def empty_scene():
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    return bpy.context.scene


def load_volume(path):
    volume = bpy.data.volumes.new(path.stem)
    volume.filepath = str(path.resolve())
    if not volume.grids.load():
        sys.exit(f"{path}: {volume.grids.error_message}")
    if "density" not in [grid.name for grid in volume.grids]:
        sys.exit(f"{path}: has no grid 'density', expected a map that vdbmap wrote")
    return volume


def grid_names(path):
    volume = load_volume(path)
    names = [grid.name for grid in volume.grids]
    bpy.data.volumes.remove(volume)
    return names


class Voxels:
    """The voxels of a file: which cells are occupied, and their colours, block by block."""

    def __init__(self, module, path, most):
        names = grid_names(path)
        levels = sorted(name[len("density"):] for name in names if name.startswith("density"))
        for suffix in levels:
            self.density = module.read(str(path), "density" + suffix)
            if self.density.activeVoxelCount() <= most:
                break
        self.color = module.read(str(path), "color" + suffix) if "color" + suffix in names else None
        self.size = self.density.transform.voxelSize()[0]

    def occupied(self, low, edge):
        cells = numpy.zeros((edge, edge, edge), dtype=numpy.float32)
        self.density.copyToArray(cells, ijk=low)
        return cells > 0

    def colors(self, low):
        cells = numpy.zeros((BLOCK, BLOCK, BLOCK, 3), dtype=numpy.float32)
        self.color.copyToArray(cells, ijk=low)
        return cells

    def blocks(self):
        if self.density.activeVoxelCount() == 0:
            return
        low, high = self.density.evalActiveVoxelBoundingBox()
        for x in range(low[0], high[0] + 1, BLOCK):
            for y in range(low[1], high[1] + 1, BLOCK):
                for z in range(low[2], high[2] + 1, BLOCK):
                    yield (x, y, z)


def faces_of_block(voxels, low, without):
    """Corners of the sides towards air of the voxels of a block [m], and their colours: four rows a side."""
    around = voxels.occupied(tuple(i - 1 for i in low), BLOCK + 2)
    inside = around[1:-1, 1:-1, 1:-1]
    if without is not None and math.isclose(without.size, voxels.size):
        inside = inside & ~without.occupied(low, BLOCK)
    if not inside.any():
        return None
    colors = voxels.colors(low) if voxels.color is not None else None
    all_corners, all_colors = [], []
    for (x, y, z), corners in SIDES:
        beside = around[1 + x:BLOCK + 1 + x, 1 + y:BLOCK + 1 + y, 1 + z:BLOCK + 1 + z]
        cells = numpy.argwhere(inside & ~beside)
        if len(cells) == 0:
            continue
        places = (cells + numpy.array(low))[:, None, :] + numpy.array(corners)[None, :, :]
        all_corners.append((places * voxels.size).reshape(-1, 3).astype(numpy.float32))
        if colors is not None:
            all_colors.append(numpy.repeat(colors[cells[:, 0], cells[:, 1], cells[:, 2]], 4, axis=0))
    if not all_corners:
        return None
    return numpy.concatenate(all_corners), numpy.concatenate(all_colors) if all_colors else None


def mesh_of(name, voxels, without=None):
    """Cubes without the sides that other cubes hide. `without`: voxels that are left out."""
    blocks = [faces for low in voxels.blocks() if (faces := faces_of_block(voxels, low, without)) is not None]
    mesh = bpy.data.meshes.new(name)
    if not blocks:
        return mesh
    corners = numpy.concatenate([block[0] for block in blocks])
    count = len(corners)
    mesh.vertices.add(count)
    mesh.vertices.foreach_set("co", corners.ravel())
    mesh.loops.add(count)
    mesh.loops.foreach_set("vertex_index", numpy.arange(count, dtype=numpy.int32))
    mesh.polygons.add(count // 4)
    mesh.polygons.foreach_set("loop_start", numpy.arange(0, count, 4, dtype=numpy.int32))
    mesh.polygons.foreach_set("loop_total", numpy.full(count // 4, 4, dtype=numpy.int32))
    if blocks[0][1] is not None:
        colors = numpy.ones((count, 4), dtype=numpy.float32)
        colors[:, :3] = numpy.concatenate([block[1] for block in blocks])
        mesh.color_attributes.new(COLORS, "FLOAT_COLOR", "CORNER").data.foreach_set("color", colors.ravel())
    mesh.update(calc_edges=True)
    return mesh


def make_surface(name, has_color, pale=False, glow=0.0):
    """A rough surface in the colours of the map."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    surface = nodes["Principled BSDF"]
    surface.inputs["Roughness"].default_value = 0.9
    surface.inputs["Base Color"].default_value = PALE
    if has_color and not pale:
        color = nodes.new("ShaderNodeVertexColor")
        color.layer_name = COLORS
        links.new(color.outputs["Color"], surface.inputs["Base Color"])
        if glow > 0:
            emission = "Emission" if "Emission" in surface.inputs else "Emission Color"
            links.new(color.outputs["Color"], surface.inputs[emission])
            surface.inputs["Emission Strength"].default_value = glow
    return material


def open_cubes(module, path, options, pale=False, glow=0.0, without=None):
    voxels = Voxels(module, path.resolve(), options.most)
    mesh = mesh_of(path.stem, voxels, without)
    mesh.materials.append(make_surface(path.stem, voxels.color is not None, pale, glow))
    thing = bpy.data.objects.new(path.stem, mesh)
    bpy.context.collection.objects.link(thing)
    return thing


def open_fog(path, pale=False, glow=0.0):
    volume = load_volume(path)
    has_color = "color" in [grid.name for grid in volume.grids]
    volume.materials.append(make_material(path.stem, has_color, pale, glow))
    thing = bpy.data.objects.new(path.stem, volume)
    bpy.context.collection.objects.link(thing)
    return thing


def make_material(name, has_color, pale=False, glow=0.0):
    """Fog that scatters light in the colours of the map; `glow` lets it shine by itself, as much as it is dense."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    output = nodes.new("ShaderNodeOutputMaterial")
    fog = nodes.new("ShaderNodeVolumePrincipled")
    fog.inputs["Density"].default_value = 1.0
    fog.inputs["Density Attribute"].default_value = "density"
    fog.inputs["Anisotropy"].default_value = 0.0
    fog.inputs["Color"].default_value = PALE if pale or not has_color else (1.0, 1.0, 1.0, 1.0)
    if has_color and not pale:
        fog.inputs["Color Attribute"].default_value = "color"
    links.new(fog.outputs["Volume"], output.inputs["Volume"])
    if glow > 0 and has_color:
        color = nodes.new("ShaderNodeAttribute")
        color.attribute_name = "color"
        density = nodes.new("ShaderNodeAttribute")
        density.attribute_name = "density"
        strength = nodes.new("ShaderNodeMath")
        strength.operation = "MULTIPLY"
        strength.inputs[1].default_value = glow
        links.new(density.outputs["Fac"], strength.inputs[0])
        links.new(strength.outputs["Value"], fog.inputs["Emission Strength"])
        links.new(color.outputs["Color"], fog.inputs["Emission Color"])
    return material


def show_in_frames(thing, first, last, end):
    """Keyframes: seen from `first` to `last` of the frames 1 to `end` only."""
    def key(frame, is_hidden):
        thing.hide_render = thing.hide_viewport = is_hidden
        thing.keyframe_insert("hide_render", frame=frame)
        thing.keyframe_insert("hide_viewport", frame=frame)

    if first > 1:
        key(1, True)
    key(first, False)
    if last < end:
        key(last + 1, True)


def places_of(things):
    """Corners of voxels, or of the boxes around volumes."""
    places = [numpy.zeros((0, 3), dtype=numpy.float32)]
    for thing in things:
        if thing.type == "MESH":
            corners = numpy.empty(3 * len(thing.data.vertices), dtype=numpy.float32)
            thing.data.vertices.foreach_get("co", corners)
            corners = corners.reshape(-1, 3)
            places.append(corners[::max(1, len(corners) // MOST_PLACES)])
        else:
            places.append(numpy.array([thing.matrix_world @ Vector(corner) for corner in thing.bound_box]))
    return numpy.concatenate(places)


def add_light(scene):
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.data.energy = 2.6
    sun.data.angle = math.radians(2)
    sun.rotation_euler = (math.radians(48), 0, math.radians(25))
    scene.collection.objects.link(sun)
    world = bpy.data.worlds.new("sky")
    world.use_nodes = True
    background = world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (0.78, 0.86, 1.0, 1.0)
    background.inputs["Strength"].default_value = 0.7
    scene.world = world


def add_camera(scene, places, options):
    """A camera on an arm around the middle, so far that nearly all places are in the picture."""
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    scene.collection.objects.link(camera)
    scene.camera = camera
    arm = bpy.data.objects.new("middle", None)
    scene.collection.objects.link(arm)
    low, high = numpy.quantile(places, (STRAY, 1 - STRAY), axis=0)
    middle = (low + high) / 2
    arm.location = middle
    camera.parent = arm
    across = 65.0 if high[0] - low[0] > high[1] - low[1] else 155.0
    heading = math.radians(across if options.heading is None else options.heading)
    elevation = math.radians(options.elevation)
    view = Vector((math.cos(heading) * math.cos(elevation), math.sin(heading) * math.cos(elevation), math.sin(elevation)))
    rotation = view.to_track_quat("-Z", "Y")
    tangent = math.tan(camera.data.angle / 2) / MARGIN
    tangents = (tangent, tangent * scene.render.resolution_y / scene.render.resolution_x)
    seen = (places - middle) @ numpy.array(rotation.to_matrix())  # x to the right, y up, z to the camera
    reach = numpy.max([seen[:, 2] + numpy.abs(seen[:, axis]) / tangents[axis] for axis in (0, 1)], axis=0)
    distance = float(numpy.quantile(reach, 1 - STRAY))
    camera.location = -distance * view
    camera.rotation_euler = rotation.to_euler()
    camera.data.clip_end = 10 * distance
    if options.turn > 0:
        arm.rotation_euler = (0, 0, 0)
        arm.keyframe_insert("rotation_euler", frame=1)
        arm.rotation_euler = (0, 0, 2 * math.pi)
        arm.keyframe_insert("rotation_euler", frame=options.turn + 1)
        for curve in arm.animation_data.action.fcurves:
            for point in curve.keyframe_points:
                point.interpolation = "LINEAR"


def prepare_renderer(scene, options):
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.samples = options.samples
    scene.cycles.use_denoising = False
    scene.cycles.volume_bounces = 2
    scene.cycles.volume_step_rate = 1.0
    scene.cycles.volume_max_steps = 4096
    scene.view_settings.view_transform = "Standard"
    width, _, height = options.size.partition("x")
    scene.render.resolution_x, scene.render.resolution_y = int(width), int(height)
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "PNG"
    scene.render.image_settings.color_mode = "RGB"


def open_maps(options):
    """The maps, and where there is one the diff; returns the objects and how many frames they take."""
    module = None if options.fog else openvdb_module()
    if module is None and not options.fog:
        print("no OpenVDB module for Python: maps are volumes", file=sys.stderr)
    changes = Voxels(module, options.diff.resolve(), math.inf) if module and options.diff else None
    frames_each = max(1, round(options.seconds * bpy.context.scene.render.fps))
    end = frames_each * len(options.maps) if len(options.maps) > 1 else 1
    things = []
    for number, path in enumerate(options.maps):
        pale = options.diff is not None
        thing = open_cubes(module, path, options, pale, without=changes) if module else open_fog(path, pale)
        if len(options.maps) > 1:
            show_in_frames(thing, 1 + number * frames_each, (number + 1) * frames_each, end)
        things.append(thing)
    if options.diff:
        glow = 0.25 if module else 0.6
        things.append(open_cubes(module, options.diff, options, glow=glow) if module else open_fog(options.diff, glow=glow))
    return things, end


def places_to_see(options, things):
    if options.look_at:
        x, y, z, radius = (float(number) for number in options.look_at.split(","))
        sides = numpy.concatenate([numpy.eye(3), -numpy.eye(3)])
        return numpy.array([x, y, z]) + radius * sides
    places = places_of(things)
    return places if len(places) > 0 else numpy.array([[-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]])


def render(scene, options):
    if options.render is None:
        return
    scene.render.filepath = str(options.render.resolve())
    if scene.frame_end > 1:
        bpy.ops.render.render(animation=True)
    else:
        bpy.ops.render.render(write_still=True)


def main():
    options = parse_arguments()
    scene = empty_scene()
    prepare_renderer(scene, options)
    things, num_frames = open_maps(options)
    bpy.context.view_layer.update()
    add_light(scene)
    add_camera(scene, places_to_see(options, things), options)
    scene.frame_start, scene.frame_end = 1, max(num_frames, options.turn, 1)
    scene.frame_set(1)
    if options.save:
        bpy.ops.wm.save_as_mainfile(filepath=str(options.save.resolve()))
    render(scene, options)


main()
