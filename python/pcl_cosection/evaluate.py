# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""Comparison of meshes."""

from __future__ import annotations

import os
from typing import Any, Dict, List, NamedTuple

from . import _core
from ._mesh import Mesh, as_mesh, load_mesh


class Errors(NamedTuple):
    """What distances are like, metres."""

    mean: float
    rmse: float
    median: float
    p95: float
    max: float


class MeshComparison(NamedTuple):
    """How near two surfaces are to each other."""

    accuracy_m: Errors
    """From samples of the reconstruction to the truth."""
    completeness_m: Errors
    """From samples of the truth to the reconstruction."""
    precision: float
    """Share of the reconstruction's samples within the threshold."""
    recall: float
    """Share of the truth's samples within the threshold."""
    f_score: float
    """Harmonic mean of the two."""
    warnings: List[str]
    """Why the comparison may mean nothing."""


def mesh(truth: Any, reconstruction: Any, *, samples: int = 10000, seed: int = 0, f_threshold_m: float = 0.01,
          threads: int = 0) -> MeshComparison:
    """Compare a reconstruction with the truth, in one frame, by exact distances of area-uniform samples.

    truth, reconstruction  a Mesh, one of Open3D or trimesh, a pair of (n, 3) vertices and (m, 3) faces, or the name of
                           a file; metres
    samples                on each mesh
    seed                   of the samples
    f_threshold_m          of precision, recall and F-score
    threads                0: all processors; the result does not depend on it

    Raises InvalidArgument, DegenerateInput, IoError.
    """
    values: Dict[str, Any] = _core.compare_meshes(_mesh("truth", truth)._data,
                                                   _mesh("reconstruction", reconstruction)._data, samples=samples,
                                                   seed=seed, f_threshold_m=f_threshold_m, threads=threads)
    for name in ("accuracy_m", "completeness_m"):
        values[name] = Errors(**values[name])
    return MeshComparison(**values)


def _mesh(name: str, value: Any) -> Mesh:
    return load_mesh(value) if isinstance(value, (str, os.PathLike)) else as_mesh(name, value)
