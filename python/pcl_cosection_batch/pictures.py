# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""The pictures of a result: from the side of the sensors and from behind, coloured by provenance."""
import os
import shutil
import subprocess

VIEWER = "pcl_cosection_viewer"
PICTURES = {"overview": "picture.png", "behind": "picture_behind.png"}  # by the viewer's name of the view
SIZE = "400x340"
HIDDEN = ("path", "frustum", "legend", "caption")
TIMEOUT_S = 120


def draw_result(program: str, folder: str, staging: str) -> list[str]:
    """Draws what PROGRAM wrote to FOLDER, with the viewer beside it or in PATH. Returns the names of the pictures, in
    FOLDER too; none, if it cannot be drawn."""
    viewer = os.path.join(os.path.dirname(program), VIEWER)
    found = viewer if os.access(viewer, os.X_OK) else shutil.which(VIEWER)
    if not found:
        return []
    hidden = [word for part in HIDDEN for word in ("--hide", part)]
    for view, name in PICTURES.items():
        made = os.path.join(staging, name)  # the viewer writes nothing into what it shows
        command = [found, "--quiet", "--threads", "1", "--colour", "provenance", "--size", SIZE, *hidden,
                   "--view", view, "--screenshot", made, folder]
        try:
            subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                           check=True, timeout=TIMEOUT_S)
        except (OSError, subprocess.SubprocessError):
            return []
    for name in PICTURES.values():
        os.rename(os.path.join(staging, name), os.path.join(folder, name))
    return list(PICTURES.values())
