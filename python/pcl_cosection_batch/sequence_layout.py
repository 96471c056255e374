# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""Recognises what pcl_cosection and pcl_cosection_fusion read, by names alone."""
import os
import re

VIEW_ENDINGS = (".pcd", ".ply")
SEVEN_SCENES_DEPTH = re.compile(r"frame-[0-9]+\.depth\.(png|exr)")


def is_view(path: str) -> bool:
    """Whether a file has the name of a view: PCD or PLY, in capitals too."""
    return path.lower().endswith(VIEW_ENDINGS) and os.path.isfile(path)


def is_truth(name: str) -> bool:
    """Whether a file has the name of a true mesh, truth_LABEL.ply or truth_LABEL_NAME.ply."""
    return re.fullmatch(r"truth_[0-9]+(_.*)?\.ply", name) is not None


def is_sequence(folder: str) -> bool:
    """Whether a folder is laid out as pcl_cosection_fusion recognises sequences: 7-Scenes, TUM, Co-Fusion, Replica."""
    if any(os.path.isfile(os.path.join(folder, name)) for name in ("associations.txt", "depth.txt", "rgb.txt")):
        return True
    if any(os.path.isdir(os.path.join(folder, name)) for name in ("depth_noise", "depth")):
        return True
    if os.path.isdir(os.path.join(folder, "results")) and os.path.isfile(os.path.join(folder, "traj.txt")):
        return True
    return any(SEVEN_SCENES_DEPTH.fullmatch(name) for name in os.listdir(folder))


def natural_order(name: str) -> tuple[tuple[str, int], ...]:
    """A key that sorts view2 before view10."""
    parts = re.findall(r"([^0-9]*)([0-9]*)", name)
    return tuple((text, int(digits or 0)) for text, digits in parts if text or digits) + ((name, 0),)
