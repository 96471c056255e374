# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""Completes the objects of one depth image: FOLDER has colour.png, depth.png (millimetres) and masks/, a mask each."""
import glob
import sys

import cv2
import matplotlib.pyplot as plt
import pcl_cosection

folder = sys.argv[1]
colour = cv2.imread(f"{folder}/colour.png")[:, :, ::-1]
depth = cv2.imread(f"{folder}/depth.png", cv2.IMREAD_UNCHANGED)
masks = [cv2.imread(name, cv2.IMREAD_GRAYSCALE) for name in sorted(glob.glob(f"{folder}/masks/*.png"))]
result = pcl_cosection.complete(depth, pcl_cosection.labels_from_masks(masks), (600, 600, 319.5, 239.5), colours=colour,
                                options={"max_faces": 2000})
axes = plt.figure().add_subplot(projection="3d", elev=-60, azim=-90)
for thing in result.objects.values():
    axes.plot_trisurf(*thing.vertices.T, triangles=thing.faces)
axes.set_aspect("equal")
plt.savefig(f"{folder}/completed.png")
