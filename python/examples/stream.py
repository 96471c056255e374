# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""Tracks a camera that goes around a table, frame by frame, and completes what stands on it. FOLDER gets the result."""
import sys

import numpy as np
import pcl_cosection
from simulated_table import pose_of_camera, view_of_table

folder, count = sys.argv[1], 12
intrinsics = view_of_table()[2]


def frames():
    """As from a camera: one after the other."""
    for number in range(count):
        depth, labels, _ = view_of_table(pose_of_camera(0.03 * number))
        yield pcl_cosection.Frame(depth, mask=labels if number % 5 == 0 else None)  # a mask now and then is enough


def show(frame):
    """After each frame."""
    if frame.T_world_camera is None:
        print(f"frame {frame.stamp:.0f}: the camera is lost")
    else:
        print(f"frame {frame.stamp:.0f}: moved by {1000 * np.linalg.norm(frame.T_world_camera[:3, 3]):.1f} mm, "
              f"objects {sorted(frame.T_world_object)}")


result = pcl_cosection.fuse(frames(), intrinsics, keyframe_every=5, on_frame=show)
for number, thing in result.objects.items():
    print(number, thing, f"{1000 * thing.volume:.3f} litres")
result.save(folder)
