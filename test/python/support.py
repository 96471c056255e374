# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""What the tests of the module share: a small view, and the folders that ctest names.

PCL_COSECTION_PROGRAMS is the folder of the programs, PCL_COSECTION_SOURCE that of the project.
"""
import os
import sys
from typing import Any, Tuple

import numpy as np

SOURCE = os.environ.get("PCL_COSECTION_SOURCE", os.path.join(os.path.dirname(os.path.abspath(__file__)), "../.."))
PROGRAMS = os.environ.get("PCL_COSECTION_PROGRAMS", os.path.join(SOURCE, "build/bin"))
EXAMPLES = os.path.join(SOURCE, "python/examples")
sys.path.insert(0, EXAMPLES)

from simulated_table import pose_of_camera, view_of_table  # noqa: E402

# Coarse voxels: these tests are about the module, not about shapes.
COARSE = {"resolution": 16, "priors": "none", "threads": 1}


def small_view() -> Tuple[Any, Any, Any]:
    """Depth, labels and intrinsics of 120 x 160 pixels."""
    return view_of_table(shape=(120, 160))


def save_pcd(path: str, depth: Any, labels: Any, intrinsics: Any, T_world_sensor: Any = None) -> None:
    """Write the view as an organised PCD file, as a sensor's driver would."""
    fx, fy, cx, cy = (float(number) for number in intrinsics)
    v, u = np.mgrid[0:depth.shape[0], 0:depth.shape[1]]
    z = np.where(depth > 0.0, depth.astype(np.float64), np.nan)
    points = np.zeros(depth.size, dtype=[("x", "<f4"), ("y", "<f4"), ("z", "<f4"), ("label", "<u4")])
    points["x"], points["y"], points["z"] = ((u - cx) / fx * z).ravel(), ((v - cy) / fy * z).ravel(), z.ravel()
    points["label"] = np.asarray(labels).ravel()
    T = np.eye(4) if T_world_sensor is None else T_world_sensor
    viewpoint = " ".join(repr(float(number)) for number in (*T[:3, 3], *_quaternion(T[:3, :3])))
    header = (f"# .PCD v0.7\nVERSION 0.7\nFIELDS x y z label\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\n"
              f"WIDTH {depth.shape[1]}\nHEIGHT {depth.shape[0]}\nVIEWPOINT {viewpoint}\n"
              f"POINTS {depth.size}\nDATA binary\n")
    with open(path, "wb") as file:
        file.write(header.encode() + points.tobytes())


def _quaternion(rotation: Any) -> Tuple[float, float, float, float]:
    """w, x, y, z of a rotation, to the last bit as Eigen has them (K. Shoemake, "Quaternion Calculus and Fast
    Animation", SIGGRAPH course notes 1987)."""
    trace = rotation[0, 0] + rotation[1, 1] + rotation[2, 2]
    xyz = [0.0, 0.0, 0.0]
    if trace > 0.0:
        root = np.sqrt(trace + 1.0)
        w = 0.5 * root
        factor = 0.5 / root
        for i in range(3):
            j, k = (i + 1) % 3, (i + 2) % 3
            xyz[i] = float((rotation[k, j] - rotation[j, k]) * factor)
    else:
        i = int(np.argmax(np.diag(rotation)))
        j, k = (i + 1) % 3, (i + 2) % 3
        root = np.sqrt(rotation[i, i] - rotation[j, j] - rotation[k, k] + 1.0)
        factor = 0.5 / root
        xyz[i] = float(0.5 * root)
        w = (rotation[k, j] - rotation[j, k]) * factor
        xyz[j] = float((rotation[j, i] + rotation[i, j]) * factor)
        xyz[k] = float((rotation[k, i] + rotation[i, k]) * factor)
    return float(w), xyz[0], xyz[1], xyz[2]


__all__ = ["COARSE", "EXAMPLES", "PROGRAMS", "SOURCE", "pose_of_camera", "save_pcd", "small_view", "view_of_table"]
