# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""Bodies for simulators and planners."""

from __future__ import annotations

import os
import tempfile
from typing import Any, List, Mapping, NamedTuple, Optional, Sequence, Union

from . import _core
from ._completion import Completion
from ._core import InvalidArgument
from ._fusion import FusionResult


class Export(NamedTuple):
    """What export() wrote."""

    files: List[str]
    """Their names."""
    warnings: List[str]
    """Lines about bodies."""


def export(result: Union[Completion, FusionResult, str, "os.PathLike[str]"], output: str | os.PathLike[str],
            formats: Union[str, Sequence[str]], *, density_kg_m3: Optional[float] = None,
            masses_kg: Optional[Mapping[int, float]] = None, collision: Optional[str] = None,
            frame: Optional[str] = None, max_parts: Optional[int] = None, save_points: Optional[int] = None,
            save_sdf: bool = False, sdf_margin_m: Optional[float] = None, threads: Optional[int] = None) -> Export:
    """Make rigid bodies of completed objects and write them as simulators and planners load them.

    result         a Completion or FusionResult, or the folder of one
    output         folder, made if there is none
    formats        one or several of "urdf", "sdf", "mjcf", "gltf", "usda", "moveit"
    density_kg_m3  of all objects
    masses_kg      of objects, by label, instead
    collision      by what objects collide: "hull", "parts" (convex ones), "mesh", or "outer" (Options.save_bounds)
    frame          of the scene: "result", "table" (on the support plane, z up), or "auto"
    max_parts      at most so many convex parts of an object
    save_points    so many points with normals, evenly over each object's surface, too
    save_sdf       each object's signed distance, too
    sdf_margin_m   how far it reaches around an object
    threads        None: all processors

    Returns an Export. Raises InvalidArgument, IoError.
    """
    arguments = [f"--format={name}" for name in ([formats] if isinstance(formats, str) else formats)]
    for option, value in (("density", density_kg_m3), ("collision", collision), ("frame", frame),
                          ("max-parts", max_parts), ("save-points", save_points), ("sdf-margin", sdf_margin_m),
                          ("threads", threads)):
        if value is not None:
            arguments.append(f"--{option}={value}")
    arguments += [f"--mass={label}={mass}" for label, mass in (masses_kg or {}).items()]
    if save_sdf:
        arguments.append("--save-sdf")
    if isinstance(result, (Completion, FusionResult)):
        with tempfile.TemporaryDirectory() as folder:
            result.save(folder)
            return _write(folder, output, arguments)
    if not isinstance(result, (str, os.PathLike)):
        raise InvalidArgument(f"result: expected a Completion, a FusionResult or a folder, got {type(result).__name__}")
    return _write(os.fspath(result), output, arguments)


def _write(folder: str, output: str | os.PathLike[str], arguments: List[str]) -> Export:
    files: Any
    warnings: Any
    files, warnings = _core.export_result(folder, os.fspath(output), arguments)
    return Export(files, warnings)
