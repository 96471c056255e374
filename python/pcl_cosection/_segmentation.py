# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""Objects in an image."""

from __future__ import annotations

from typing import Any, NamedTuple, Optional, Sequence

import numpy as np

from . import _arrays
from . import _core
from ._core import InvalidArgument

IGNORED = 65535


class Segmentation(NamedTuple):
    """What segment() finds."""

    labels: _arrays.Array
    """(height, width) int32: 0 background or no reading, 1 ... objects, larger ones first; (n,) of points."""
    planes: _arrays.Array
    """(m, 4): (a, b, c, d) of the planes on which objects stand, a x + b y + c z + d = 0 (sensor frame, metres), the
    unit normal towards the sensor; the one that is seen best is the first."""


def segment(view: Any, intrinsics: Any = None, *, depth_scale: Optional[float] = None, max_object_size_m: float = 0.5,
             min_object_size_m: float = 0.02, min_support_area_m2: float = 0.03, concave_angle_rad: float = 0.45,
             threads: int = 0) -> Segmentation:
    """Find the objects that stand on planes, by their geometry alone: without masks, colour or learned weights.

    view                 a depth image (height, width) with intrinsics, or points (height, width, 3) or (n, 3), metres,
                         sensor frame
    intrinsics           (fx, fy, cx, cy) in pixels, or a 3 x 3 camera matrix, of a depth image
    depth_scale          metres per unit of depth; None: 1 for floats, 0.001 for whole numbers
    max_object_size_m    what is longer is furniture or room
    min_object_size_m    what is shorter is no object
    min_support_area_m2  the largest plane must have so much surface in view to carry objects
    concave_angle_rad    a crease that is concave by more than this separates two objects
    threads              0: all processors; the result does not depend on it

    Returns a Segmentation. Raises InvalidArgument, and DegenerateInput without readings or without a plane.
    """
    array = _arrays.as_array("view", view)
    if array.ndim == 2 and (intrinsics is not None or array.shape[1] != 3):
        points = points_of_depth(_arrays.depth_image("view", array, depth_scale),
                                  *_arrays.camera("intrinsics", intrinsics))
    else:
        points = _arrays.vectors("view", array, ("height", "width", 3), ("n", 3))
    organized = points if points.ndim == 3 else points[np.newaxis]
    labels, planes = _core.segment(organized, max_object_size_m=max_object_size_m,
                                    min_object_size_m=min_object_size_m, min_support_area_m2=min_support_area_m2,
                                    concave_angle_rad=concave_angle_rad, threads=threads)
    return Segmentation(labels.reshape(points.shape[:-1]), np.array(planes, dtype=np.float64).reshape(-1, 4))


def points_of_depth(depth: _arrays.Array, fx: float, fy: float, cx: float, cy: float) -> _arrays.Array:
    """(height, width, 3) points of a depth image in metres, sensor frame; NaN where there is no reading."""
    z = np.where(np.isfinite(depth) & (depth > 0.0), depth, np.nan).astype(np.float64)
    v, u = np.mgrid[0:depth.shape[0], 0:depth.shape[1]]
    return np.ascontiguousarray(np.stack(((u - cx) / fx * z, (v - cy) / fy * z, z), axis=-1), dtype=np.float32)


def labels_from_masks(masks: Sequence[Any]) -> _arrays.Array:
    """One (height, width) int32 label image from a mask per object, of which what is not zero belongs to it.

    The first mask is object 1. Pixels of several masks get 65535, which is neither an object nor the background.
    """
    labels: Optional[_arrays.Array] = None
    for number, mask in enumerate(masks):
        name = f"masks[{number}]"
        array = _arrays.as_array(name, mask)
        if labels is None:
            labels = np.zeros(_arrays.check_shape(name, array, ("height", "width")).shape, np.int32)
        inside = _arrays.check_shape(name, array, labels.shape) != 0
        labels[inside] = np.where(labels[inside] == 0, number + 1, IGNORED)
    if labels is None:
        raise InvalidArgument("masks: expected at least one mask, got none")
    return labels
