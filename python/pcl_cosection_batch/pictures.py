# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""The picture of a result: its objects as the sensor saw them, and from behind, coloured by provenance."""
import os
import re
from typing import Any

from pcl_cosection_batch.store import read_json

WIDTH, HEIGHT = 400, 340  # of each of the two views, pixels
COLOURS = ((190, 190, 190), (240, 150, 50), (80, 130, 220), (90, 180, 90))  # by provenance, as the viewer has them
BACKGROUND = (225, 227, 230)
MARGIN = 1.1  # around the objects
LOWEST_DEG, HIGHEST_DEG, BEHIND_DEG = 15.0, 70.0, 25.0  # elevations of the viewpoints
FEW_SIDES = 0.2  # length of the mean normal, from which on points were seen from one side


def draw_result(folder: str, path: str) -> str:
    """Draws the meshes of a result. Returns the name of the picture; nothing, if it cannot be drawn."""
    try:
        import numpy as np

        from pcl_cosection_batch import raster

        objects, background = load_meshes(folder)
        if not objects:
            return ""
        scene = compose(objects, background)
        pictures = [raster.draw(scene, camera, WIDTH, HEIGHT) for camera in viewpoints(objects, up_in(folder))]
        raster.write_png(path, np.concatenate(pictures, axis=1))
    except (ImportError, OSError, ValueError, KeyError, IndexError, TypeError, MemoryError):
        return ""
    return os.path.basename(path)


def load_meshes(folder: str) -> tuple[list[Any], list[Any]]:
    """The meshes of the objects, in the world, and the background's."""
    from pcl_cosection_batch.ply import read_mesh

    meshes = os.path.join(folder, "mesh") if os.path.isdir(os.path.join(folder, "mesh")) else folder
    objects = []
    for name in sorted(os.listdir(meshes)):
        number = re.fullmatch(r"object_([0-9]+)\.ply", name)
        if number:
            mesh = read_mesh(os.path.join(meshes, name))
            move(mesh, os.path.join(folder, "trajectory", f"object_{number.group(1)}.txt"))
            objects.append(mesh)
    background = os.path.join(meshes, "background.ply")
    return objects, [read_mesh(background)] if os.path.exists(background) else []


def move(mesh: Any, trajectory: str) -> None:
    """Moves a mesh to the last pose of its trajectory, if it has one."""
    import numpy as np

    if not os.path.exists(trajectory):
        return
    with open(trajectory, encoding="ascii", errors="replace") as file:
        lines = [line.split() for line in file if line.strip() and not line.startswith("#")]
    if not lines:
        return
    tx, ty, tz, x, y, z, w = (float(word) for word in lines[-1][1:8])
    rotation = np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])
    mesh.vertices = mesh.vertices @ rotation.T + (tx, ty, tz)
    mesh.normals = mesh.normals @ rotation.T


def compose(objects: list[Any], background: list[Any]) -> Any:
    """All meshes as one."""
    import numpy as np

    from pcl_cosection_batch.raster import Triangles

    meshes = objects + background
    palette = np.array(COLOURS, float)
    colours = [palette[mesh.provenance] for mesh in objects]
    colours += [np.broadcast_to(np.array(BACKGROUND, float), mesh.vertices.shape) for mesh in background]
    begins = np.cumsum([0] + [len(mesh.vertices) for mesh in meshes])
    return Triangles(
        np.concatenate([mesh.vertices for mesh in meshes]), np.concatenate([mesh.normals for mesh in meshes]),
        np.concatenate(colours), np.concatenate([mesh.triangles + begin for mesh, begin in zip(meshes, begins)]),
        np.concatenate([np.full(len(mesh.triangles), n >= len(objects)) for n, mesh in enumerate(meshes)]))


def up_in(folder: str) -> Any:
    """The upward direction: the normal of the first support plane, else that of a camera's picture."""
    import numpy as np

    planes = read_json(os.path.join(folder, "summary.json")).get("support_planes")
    if isinstance(planes, list) and planes and isinstance(planes[0], list) and len(planes[0]) == 4:
        normal = np.array(planes[0][:3], float)
        if np.linalg.norm(normal) > 0:
            return normal / np.linalg.norm(normal)
    return np.array([0.0, -1.0, 0.0])


def viewpoints(objects: list[Any], up: Any) -> list[Any]:
    """From where most of the seen surface is seen, and from the other side."""
    import numpy as np

    from pcl_cosection_batch.raster import FIELD_OF_VIEW_DEG, Camera

    vertices = np.concatenate([mesh.vertices for mesh in objects])
    observed = np.concatenate([mesh.normals[mesh.provenance == 0] for mesh in objects])
    towards = observed.mean(0) if len(observed) else np.zeros(3)
    if np.linalg.norm(towards) < FEW_SIDES:
        towards = np.array([0.3, -0.5, -0.8])
    flat = towards - up * (towards @ up)
    if np.linalg.norm(flat) < 0.05 * np.linalg.norm(towards):  # from straight above
        flat = np.cross(up, [1.0, 0.0, 0.0] if abs(up[0]) < 0.7 else [0.0, 1.0, 0.0])
    elevation = np.degrees(np.arctan2(towards @ up, np.linalg.norm(flat)))
    flat = flat / np.linalg.norm(flat)
    centre = 0.5 * (vertices.min(0) + vertices.max(0))
    radius = max(np.linalg.norm(vertices - centre, axis=1).max(), 1e-6)
    distance = MARGIN * radius / np.sin(np.radians(0.5 * FIELD_OF_VIEW_DEG))

    def from_direction(horizontal: Any, degrees: float) -> Any:
        angle = np.radians(degrees)
        return Camera(centre + distance * (np.cos(angle) * horizontal + np.sin(angle) * up), centre, up)

    return [from_direction(flat, min(max(elevation, LOWEST_DEG), HIGHEST_DEG)), from_direction(-flat, BEHIND_DEG)]
