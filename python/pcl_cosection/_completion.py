# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""Completion of views."""

from __future__ import annotations

import json
import os
import re
from typing import Any, Callable, Dict, Iterable, List, Mapping, Optional, Sequence

import numpy as np

from . import _arrays
from . import _core
from ._core import CompletionData, InvalidArgument, MeshData, SceneData
from ._mesh import Mesh, SignedDistance, as_mesh
from ._options import Options, option_arguments
from ._view import View

Progress = Callable[[str, float], Optional[bool]]


class Object(Mesh):
    """A completed object: a closed mesh, and what is known about it.

    Beside what a Mesh has:

    id                  its label
    sdf                 SignedDistance of which the mesh is the zero set
    hull                all that may be it, as no view saw it free; with Options.save_hull, else None
    inner_bound         where measured surfaces imply matter; with Options.save_bounds, else None
    outer_bound         the hull with the mesh, two sigma_m larger; with Options.save_bounds, else None
    contradicted_share  share of its points, in [0, 1], that a view looks through: large with wrong poses, and motion
    penetration_m       deepest place of its surface in supported parts of another body, metres
    outlier_points      points that were left out
    warnings            lines about it
    """

    def __init__(self, values: Mapping[str, Any], warnings: Sequence[str]) -> None:
        self._data = values["mesh"]
        self.id: int = values["id"]
        self.sdf = None if values["sdf"] is None else SignedDistance(values["sdf"])
        self.hull = _mesh_or_none(values["hull"])
        self.inner_bound = _mesh_or_none(values["inner_bound"])
        self.outer_bound = _mesh_or_none(values["outer_bound"])
        self.contradicted_share: float = values["contradicted_share"]
        self.penetration_m: float = values["penetration_m"]
        self.outlier_points: int = values["outlier_points"]
        self.warnings = _about(self.id, warnings)


class Completion:
    """What complete() returns.

    objects     Object by label
    failed      why an object could not be completed, by label
    background  Mesh of what the objects stand on, open; None without a background
    planes      (n, 4): support planes (a, b, c, d), a x + b y + c z + d = 0, the unit normal towards the objects
    origin_m    (3,): of the frame of the meshes in the world, metres; zero unless the scene is far from its origin
    warnings    lines about the whole and its objects
    timings_s   seconds by stage
    """

    def __init__(self, data: CompletionData) -> None:
        self._data = data
        self.warnings: List[str] = data.warnings
        self.timings_s: Dict[str, float] = data.timings_s
        self.origin_m: _arrays.Array = data.origin_m
        self.planes: _arrays.Array = np.array(data.planes, dtype=np.float64).reshape(-1, 4)
        self.background = _mesh_or_none(data.background)
        given = data.objects
        self.objects: Dict[int, Object] = {one["id"]: Object(one, self.warnings) for one in given if not one["error"]}
        self.failed: Dict[int, str] = {one["id"]: one["error"] for one in given if one["error"]}

    @property
    def summary(self) -> Dict[str, Any]:
        """What the program pcl_cosection writes to summary.json."""
        return dict(json.loads(self._data.summary()))

    def save(self, output: str | os.PathLike[str], format: str = "") -> List[str]:
        """Write meshes and summary.json into a folder, as the program pcl_cosection does; or all objects into one file
        that ends in .ply, .stl or .obj.

        format is that of the meshes in a folder: "ply" (if empty), "stl" or "obj". Returns the names of the meshes.
        Raises IoError, InvalidArgument.
        """
        return self._data.save(os.fspath(output), format)

    def __repr__(self) -> str:
        failed = f", {len(self.failed)} failed" if self.failed else ""
        return f"<pcl_cosection.Completion: {len(self.objects)} objects{failed}>"


def complete(view: Any, labels: Any = None, intrinsics: Any = None, T_world_sensor: Any = None, *,
              colours: Any = None, normals: Any = None, depth_scale: Optional[float] = None,
              free_space: Any = (), planes: Sequence[Any] = (), obstacles: Any = (),
              proposals: Optional[Mapping[int, Any]] = None, progress: Optional[Progress] = None,
              options: Options | Mapping[str, Any] | None = None) -> Completion:
    """Complete the hidden surfaces of the objects in one or several views.

    view         a depth image (height, width) with labels and intrinsics; or points, (n, 3) or (height, width, 3); or a
                 View; or the name of a PCD or PLY file; or a list of Views and names
    labels, intrinsics, T_world_sensor, colours, normals, depth_scale
                 of a depth image or points, as of View
    free_space   a further View, or name, or a list of some, that show which space is free and nothing else
    planes       (a, b, c, d) each: a x + b y + c z + d = 0 (world, metres), which no object crosses: a table, a wall
    obstacles    a mesh or a list of meshes (world, metres) that no object enters: a Mesh, one of Open3D or trimesh, a
                 pair of vertices and faces, or the name of a file
    proposals    by label, a mesh or a list of meshes that may be the shape of the object, of any size and pose
    progress     called now and then with the name of a stage and the finished fraction; False cancels
    options      Options, or a dict of some

    Returns a Completion. Raises InvalidArgument, DegenerateInput, IoError, MemoryLimitExceeded; Cancelled if progress
    asks for it; KeyboardInterrupt for Ctrl-C.
    """
    views = _views(view, labels, intrinsics, T_world_sensor, colours, normals, depth_scale)
    scene = SceneData(option_arguments(options))
    is_one = isinstance(free_space, (View, str, os.PathLike))
    more = [_view(f"free_space[{n}]", given)
            for n, given in enumerate([free_space] if is_one else _arrays.items("free_space", free_space))]
    for number, one in enumerate(views):
        scene.add_view(one.file or f"view {number}", one.data, False)
    for number, one in enumerate(more):
        scene.add_view(one.file or f"free space {number}", one.data, True)
    for label, poses in _poses(views + more).items():
        scene.set_poses(label, poses)
    for plane in _arrays.items("planes", planes):
        scene.add_mesh("--plane=", _plane(plane), None)
    for number, mesh in enumerate(_list_of_meshes(obstacles)):
        _add_mesh(scene, "--obstacle=", f"obstacle {number}", f"obstacles[{number}]", mesh)
    for label, meshes in _arrays.by_label("proposals", proposals).items():
        for number, mesh in enumerate(_list_of_meshes(meshes)):
            name = f"proposal {number} of object {label}"
            _add_mesh(scene, f"--proposal={label}=", name, f"proposals[{label}]", mesh)
    if progress is not None and not callable(progress):
        raise InvalidArgument(f"progress: expected a function of a stage and a fraction, got {type(progress).__name__}")
    return Completion(_core.complete(scene, progress))


def _views(view: Any, labels: Any, intrinsics: Any, T_world_sensor: Any, colours: Any, normals: Any,
            depth_scale: Optional[float]) -> List[View]:
    beside = {"labels": labels, "intrinsics": intrinsics, "T_world_sensor": T_world_sensor, "colours": colours,
              "normals": normals, "depth_scale": depth_scale}
    is_list = isinstance(view, (list, tuple)) and any(isinstance(one, (View, str, os.PathLike)) for one in view)
    if is_list or isinstance(view, (View, str, os.PathLike)):
        for name, value in beside.items():
            if value is not None:
                raise InvalidArgument(f"{name}: expected nothing beside a View or a file, which says it")
        return [_view(f"view[{n}]", one) for n, one in enumerate(view)] if is_list else [_view("view", view)]
    if isinstance(view, (list, tuple)) and len(view) == 0:
        raise InvalidArgument("view: expected at least one view, got none")
    array = _arrays.as_array("view", view)
    if intrinsics is not None:
        _arrays.check_shape("view", array, ("height", "width"))
        return [View(array, labels, intrinsics, T_world_sensor, colours=colours, normals=normals,
                      depth_scale=depth_scale)]
    if array.ndim == 2 and array.shape[1] != 3:
        raise InvalidArgument("intrinsics: expected (fx, fy, cx, cy) or a 3 x 3 matrix with a depth image, got nothing")
    _arrays.check_shape("view", array, ("n", 3), ("height", "width", 3))
    return [View(points=array, labels=labels, intrinsics=intrinsics, T_world_sensor=T_world_sensor, colours=colours,
                  normals=normals, depth_scale=depth_scale)]


def _view(name: str, value: Any) -> View:
    if isinstance(value, View):
        return value
    if isinstance(value, (str, os.PathLike)):
        return View(file=value)
    raise InvalidArgument(f"{name}: expected a View or the name of a file, got {type(value).__name__}")


def _poses(views: Iterable[View]) -> Dict[int, List[_arrays.Array]]:
    """Poses of all views, by label; not finite where they are not known."""
    unknown = np.full((4, 4), np.nan)
    labels = {label for one in views for label in one.T_world_object}
    return {label: [one.T_world_object.get(label, unknown) for one in views] for label in sorted(labels)}


def _plane(value: Any) -> str:
    numbers = _arrays.vectors("planes", value, (4,), dtype=np.float64)
    return ",".join(repr(float(number)) for number in numbers)


def _list_of_meshes(value: Any) -> List[Any]:
    is_pair = isinstance(value, tuple) and len(value) == 2 and not hasattr(value[0], "vertices")
    return list(value) if isinstance(value, (list, tuple)) and not is_pair else [value]


def _add_mesh(scene: SceneData, option: str, name: str, argument: str, value: Any) -> None:
    if isinstance(value, (str, os.PathLike)):
        scene.add_mesh(option, os.fspath(value), None)
    else:
        scene.add_mesh(option, name, as_mesh(argument, value)._data)


def _mesh_or_none(data: Optional[MeshData]) -> Optional[Mesh]:
    return None if data is None else Mesh._of(data)


def _about(number: int, lines: Sequence[str]) -> List[str]:
    """The lines that name an object."""
    pattern = re.compile(r"\b(?:object|objects|label|labels) ((?:\d+(?:, | and )?)+)")
    return [line for line in lines
            if any(str(number) in re.findall(r"\d+", numbers) for numbers in pattern.findall(line))]


