# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""What the programs can be told."""

from __future__ import annotations

import dataclasses
from typing import Any, List, Mapping, Optional, Sequence, Union

from ._core import InvalidArgument


@dataclasses.dataclass
class Options:
    """Options of the method, as those of the program pcl_cosection. None: as the method has it.

    Raises InvalidArgument when it is used, naming the option and what is right.
    """

    voxel_size: Optional[float] = None
    """Edge of an object's voxels, metres."""
    resolution: Optional[int] = None
    """Voxels along an object's longest observed side, instead."""
    padding: Optional[float] = None
    """Volume beyond the observed box on each side, as a fraction of its longest side."""
    background_voxel_size: Optional[float] = None
    """Edge of the background's voxels, metres."""
    max_memory: Union[None, int, str] = None
    """Refuse clouds and volumes that need more: bytes, or text such as "2G"."""
    preset: Optional[str] = None
    """"paper": the parameters of the publication."""
    constraints: Optional[str] = None
    """What bounds hidden surfaces: "none", "hull", "intersection" or "all"."""
    priors: Union[None, str, Sequence[str]] = None
    """What is expected where nothing bounds: names of priors, or "all", or "none"."""
    alpha: Optional[float] = None
    """Weight of smoothness, relative to the voxel."""
    beta_hull: Optional[float] = None
    """Weight of seen free space."""
    beta_inter: Optional[float] = None
    """Weight of other bodies."""
    sigma: Optional[float] = None
    """Width of a point's influence, voxels."""
    weighting: Optional[str] = None
    """How points near a voxel are combined: "mean" or "sum"."""
    solver: Optional[str] = None
    """"multigrid" or "fast-jacobi"."""
    max_iterations: Optional[int] = None
    """Most iterations on each level."""
    tolerance: Optional[float] = None
    """Stop when the surface is this near to the solution, voxels."""
    model: Optional[str] = None
    """File of the learned prior's network; None: the installed one."""
    no_planes: bool = False
    """Do not look for support planes in the background, nor guess them."""
    max_faces: Optional[int] = None
    """Simplify each mesh to at most so many triangles, still closed."""
    save_hull: bool = False
    """Compute each object's hull, too: all that may be it, as no view saw it free."""
    save_bounds: bool = False
    """Compute bounds for collision checks, too."""
    save_sdf: bool = False
    """Write each object's signed distance beside its mesh, when the result is saved."""
    scale: Optional[float] = None
    """Multiplies all coordinates: 0.001 for millimetres."""
    axes: Optional[str] = None
    """Axes of the sensor's frame: "optical" (x right, y down, z forward) or "opengl" (x right, y up, z backward)."""
    world_points: bool = False
    """Points are in the world frame already."""
    viewpoint: Optional[Sequence[Any]] = None
    """Where the sensor stood, for points in the world frame: x, y, z, or a list of such, one per view."""
    label_field: Optional[str] = None
    """Field of a file that says to which object a point belongs."""
    background: Union[None, int, Sequence[int]] = None
    """Label, or labels, of the background; None: 0."""
    ignore: Union[None, int, Sequence[int]] = None
    """Labels of points that are left out, beside negative ones and 65535."""
    threads: Optional[int] = None
    """Threads to use, without influence on results; None: all processors."""

    def arguments(self) -> List[str]:
        """The options as the programs' command line has them."""
        result: List[str] = []
        for field in dataclasses.fields(self):
            value = getattr(self, field.name)
            option = "--" + field.name.replace("_", "-")
            if value is None or value is False:
                continue
            if value is True:
                result.append(option)
            else:
                result += [f"{option}={text}" for text in _texts(field.name, value)]
        return result


_NUMBERS = ("viewpoint",)


def _texts(name: str, value: Any) -> List[str]:
    """One text for each time that an option is given."""
    if isinstance(value, str):
        if not value:
            raise InvalidArgument(f"{name}: expected a value, got nothing")
        return [value]
    if name == "priors":
        return [",".join(str(prior) for prior in value) or "none"]
    try:
        items = list(value)
    except TypeError:
        items = [value]
    if name in _NUMBERS and items and not hasattr(items[0], "__len__"):
        items = [items]
    try:
        return [",".join(_number(n) for n in item) if name in _NUMBERS else _number(item) for item in items]
    except TypeError:
        raise InvalidArgument(f"{name}: expected a number or numbers, got {value!r}") from None


def _number(value: Any) -> str:
    if isinstance(value, str):
        return value
    if isinstance(value, bool):
        raise TypeError
    try:
        return str(value.__index__())
    except AttributeError:
        return repr(float(value))


def option_arguments(options: Options | Mapping[str, Any] | None) -> List[str]:
    """Arguments of options that users give as they like."""
    if options is None:
        return []
    if isinstance(options, Options):
        return options.arguments()
    names = [field.name for field in dataclasses.fields(Options)]
    try:
        unknown = [name for name in options if name not in names]
    except TypeError:
        raise InvalidArgument(f"options: expected Options or a dict, got {type(options).__name__}") from None
    if unknown:
        raise InvalidArgument(f"options: there is no option {unknown[0]}; there are {', '.join(names)}")
    return Options(**options).arguments()
