# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""Two views of a table are better than one: how far each completion is from the truth. FOLDER gets the pictures."""
# %% What one camera sees
import sys

import matplotlib.pyplot as plt
import numpy as np
import pcl_cosection
from simulated_table import BALL_PLACE, BALL_RADIUS, pose_of_camera, view_of_table

folder = sys.argv[1]
views = []
for angle in (0.0, -1.3):
    T_world_sensor = pose_of_camera(angle)
    depth, labels, intrinsics = view_of_table(T_world_sensor)
    views.append(pcl_cosection.View(depth, labels, intrinsics, T_world_sensor))
plt.imshow(depth)
plt.colorbar(label="depth, metres")
plt.savefig(f"{folder}/depth.png")

# %% One view, and both
for count in (1, 2):
    result = pcl_cosection.complete(views[:count])
    ball = result.objects[1]
    errors = np.abs(np.linalg.norm(ball.vertices - np.array(BALL_PLACE), axis=1) - BALL_RADIUS)
    print(f"{count} view(s): {1000 * ball.volume:.3f} litres, mean error {1000 * errors.mean():.2f} mm, "
          f"the largest {1000 * errors.max():.2f} mm, closed: {ball.is_closed}")

# %% What was seen and what was guessed
figure, axes = plt.subplots(1, 2, figsize=(11, 5), subplot_kw={"projection": "3d"})
for axis, thing in zip(axes, result.objects.values()):
    seen = thing.provenance == pcl_cosection.Provenance.OBSERVED
    for points, name in ((thing.vertices[seen], "seen"), (thing.vertices[~seen], "guessed")):
        axis.scatter(*points[::6].T, s=3, label=name)
    axis.set_aspect("equal")
    axis.legend(loc="upper left")
plt.savefig(f"{folder}/provenance.png")

# %% For a simulator
result.save(f"{folder}/meshes")
for name in pcl_cosection.export(result, f"{folder}/simulation", ["mjcf", "urdf"]).files:
    print(name)
