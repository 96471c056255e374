# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""A table in a corner with a ball and a box, as a depth camera sees it: something to try the module with.

>>> depth, labels, intrinsics = view_of_table()
>>> depth.shape, depth.dtype, np.unique(labels).tolist()
((240, 320), dtype('float32'), [0, 1, 2])
"""
from typing import Any, Tuple

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[Any]

BALL_RADIUS = 0.05  # metres
BOX_SIZE = (0.10, 0.08, 0.12)
BALL_PLACE = (-0.10, 0.02, BALL_RADIUS)  # world frame: z upwards, the table at z = 0
BOX_PLACE = (0.08, 0.0, BOX_SIZE[2] / 2)
WALLS = ((0.6, 0.8), (-0.8, 0.6))  # directions (x, y) in which they stand, each at ...
WALL_DISTANCE = 0.45  # ... from the middle of the table


def pose_of_camera(angle: float = 0.0, distance: float = 0.55, height: float = 0.4) -> Array:
    """T_world_sensor of a camera that looks at the middle of the table. angle: around it, radians."""
    place = np.array((distance * np.sin(angle), -distance * np.cos(angle), height))
    forward = -place / np.linalg.norm(place)
    right = np.cross(forward, (0.0, 0.0, 1.0))
    right /= np.linalg.norm(right)
    T = np.eye(4)
    T[:3, :3] = np.stack((right, np.cross(forward, right), forward), axis=1)
    T[:3, 3] = place
    return T


def view_of_table(T_world_sensor: Any = None, shape: Tuple[int, int] = (240, 320)) -> Tuple[Array, Array, Array]:
    """The depth image of a view (height, width), metres; its labels (1: ball, 2: box); and fx, fy, cx, cy."""
    T = pose_of_camera() if T_world_sensor is None else np.asarray(T_world_sensor)
    height, width = shape
    intrinsics = np.array((0.9375 * width, 0.9375 * width, (width - 1) / 2, (height - 1) / 2))
    v, u = np.mgrid[0:height, 0:width]
    rays = np.stack(((u - intrinsics[2]) / intrinsics[0], (v - intrinsics[3]) / intrinsics[1], np.ones(shape)), axis=-1)
    rays = rays @ T[:3, :3].T  # world frame; the depth of a point is its multiple of the ray
    room = [_plane(T[:3, 3], rays, (0.0, 0.0, -1.0), 0.0)]
    room += [_plane(T[:3, 3], rays, (x, y, 0.0), WALL_DISTANCE) for x, y in WALLS]
    hits = np.stack((np.min(room, axis=0), _ball(T[:3, 3], rays), _box(T[:3, 3], rays)))
    labels = np.argmin(hits, axis=0)
    depth = np.min(hits, axis=0)
    return np.where(np.isfinite(depth), depth, 0.0).astype(np.float32), labels, intrinsics


def _plane(place: Array, rays: Array, normal: Tuple[float, float, float], distance: float) -> Array:
    towards = rays @ np.array(normal)
    reached: Array = (distance - place @ np.array(normal)) / np.where(towards > 1e-9, towards, 1e-12)
    return reached


def _ball(place: Array, rays: Array) -> Array:
    offset = place - np.array(BALL_PLACE)
    a, b, c = (rays**2).sum(-1), rays @ offset, offset @ offset - BALL_RADIUS**2
    root = b**2 - a * c
    return np.where(root > 0.0, (-b - np.sqrt(np.maximum(root, 0.0))) / a, np.inf)


def _box(place: Array, rays: Array) -> Array:
    half = np.array(BOX_SIZE) / 2
    offset = np.array(BOX_PLACE) - place
    safe = np.where(np.abs(rays) < 1e-12, 1e-12, rays)
    first, second = (offset - half) / safe, (offset + half) / safe
    enter, leave = np.minimum(first, second).max(-1), np.maximum(first, second).min(-1)
    return np.where((enter < leave) & (enter > 0.0), enter, np.inf)
