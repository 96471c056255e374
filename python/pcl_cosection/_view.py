# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""Views of a scene."""

from __future__ import annotations

import os
from typing import Any, Mapping, Optional

import numpy as np

from . import _arrays
from ._core import InvalidArgument, ViewData


class View:
    """One view of a scene: a depth image, points, or a file.

    Give depth and intrinsics, or points, or file.

    depth           (height, width): along the optical axis; floats in metres, or whole numbers in millimetres unless
                    depth_scale says otherwise; NaN, infinite or 0 where there is no reading
    labels          (height, width), or one per point: to which object it belongs; 0 is the background, 65535 and
                    negative numbers are neither. Truth values say what is object 1. None: everything is object 1
    intrinsics      (fx, fy, cx, cy) in pixels, or a 3 x 3 camera matrix
    T_world_sensor  4 x 4 pose of the sensor; None: the sensor's frame is the world's
    points          (n, 3), or (height, width, 3) as a sensor's driver gives them, metres, sensor frame; float32 or
                    float64
    colours         (height, width, 3), or (n, 3): red, green, blue as bytes, or floats in [0, 1]
    normals         (n, 3): of points; None: they are estimated
    depth_scale     metres per unit of depth
    T_world_object  4 x 4 poses by label, of objects that moved between views; in the first view that shows them, the
                    objects' frames may be anywhere
    file            a PCD or PLY file, with all of this in its fields and header

    Raises InvalidArgument.
    """

    def __init__(self, depth: Any = None, labels: Any = None, intrinsics: Any = None, T_world_sensor: Any = None, *,
                  points: Any = None, colours: Any = None, normals: Any = None, depth_scale: Optional[float] = None,
                  T_world_object: Optional[Mapping[int, Any]] = None,
                  file: Optional[str | os.PathLike[str]] = None) -> None:
        given = [name for name, value in (("depth", depth), ("points", points), ("file", file)) if value is not None]
        if len(given) != 1:
            raise InvalidArgument("depth: expected either depth, or points, or file"
                                   + (f", got {' and '.join(given)}" if given else ""))
        self.file = "" if file is None else os.fspath(file)
        self.data: Optional[ViewData] = None
        self.T_world_object = {label: _arrays.pose(f"T_world_object[{label}]", T)
                               for label, T in _arrays.by_label("T_world_object", T_world_object).items()}
        if file is not None:
            for name, value in (("labels", labels), ("intrinsics", intrinsics), ("T_world_sensor", T_world_sensor),
                                ("colours", colours), ("normals", normals), ("depth_scale", depth_scale)):
                if value is not None:
                    raise InvalidArgument(f"{name}: expected nothing beside file, which says it")
        elif depth is not None:
            if normals is not None:
                raise InvalidArgument("normals: expected nothing beside depth, from which they are computed")
            self.data = self._of_depth(_arrays.depth_image("depth", depth, depth_scale), labels, colours, intrinsics,
                                        T_world_sensor)
        else:
            for name, value in (("intrinsics", intrinsics), ("depth_scale", depth_scale)):
                if value is not None:
                    raise InvalidArgument(f"{name}: expected nothing beside points; it belongs to depth")
            self.data = self._of_points(points, labels, colours, normals, T_world_sensor)

    @staticmethod
    def _of_depth(depth: _arrays.Array, labels: Any, colours: Any, intrinsics: Any, T_world_sensor: Any) -> ViewData:
        return ViewData.of_depth(depth, _arrays.label_array("labels", labels, depth.shape),
                                  _arrays.colour_array("colours", colours, depth.shape),
                                  _arrays.camera("intrinsics", intrinsics),
                                  _arrays.pose("T_world_sensor", T_world_sensor))

    @staticmethod
    def _of_points(points: Any, labels: Any, colours: Any, normals: Any, T_world_sensor: Any) -> ViewData:
        array = _arrays.check_shape("points", _arrays.as_array("points", points), ("n", 3), ("height", "width", 3))
        if array.size == 0:
            raise InvalidArgument("points: expected at least one point")
        array = np.ascontiguousarray(array, dtype=np.float32 if array.dtype == np.float32 else np.float64)
        shape = array.shape[:-1]
        return ViewData.of_points(array, _arrays.label_array("labels", labels, shape),
                                   _arrays.colour_array("colours", colours, shape),
                                   None if normals is None else _arrays.vectors("normals", normals, (*shape, 3)),
                                   _arrays.pose("T_world_sensor", T_world_sensor))
