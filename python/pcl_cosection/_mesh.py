# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""Meshes and signed distances."""

from __future__ import annotations

import enum
import importlib
import os
from typing import Any, Dict, Optional, Tuple

import numpy as np

from . import _arrays
from . import _core
from ._core import FieldData, InvalidArgument, MeshData


class Provenance(enum.IntEnum):
    """Why a piece of surface is where it is."""

    OBSERVED = 0
    """Measured points are nearby."""
    INFERRED = 1
    """Neither seen nor bounded: by smoothness and priors."""
    HULL = 2
    """Bounded by space that was seen free."""
    INTERSECTION = 3
    """Bounded by another object or the background."""


class Mesh:
    """Triangles, counter-clockwise from outside.

    vertices    (n, 3) float32, metres
    faces       (m, 3) uint32, indices of vertices
    normals     (n, 3) float32, unit, outward
    colours     (n, 3) uint8, red, green, blue
    intensity   (n,) float32, as that of the points
    confidence  (n,) float32: exp (-d / 5), d voxels to the nearest data
    sigma_m     (n,) float32: expected error, metres; the truth is within two of it for 95 % of the vertices
    provenance  (n,) uint8: why a vertex is where it is, as Provenance

    What a mesh does not have is None. Arrays show the memory of the library, without a copy, and cannot be written;
    they stay valid as long as they are used.
    """

    def __init__(self, vertices: Any, faces: Any) -> None:
        """A mesh of (n, 3) vertices, metres, and (m, 3) faces, which are copied. Raises InvalidArgument."""
        points = _arrays.vectors("vertices", vertices, ("n", 3))
        indices = _arrays.check_shape("faces", _arrays.as_array("faces", faces), ("m", 3))
        if indices.dtype.kind not in "iu":
            raise InvalidArgument(f"faces: expected whole numbers, got an array of {indices.dtype}")
        if indices.size > 0 and not 0 <= int(indices.min()) <= int(indices.max()) < len(points):
            raise InvalidArgument(f"faces: expected indices below {len(points)}, the number of vertices")
        self._data = MeshData(points, np.ascontiguousarray(indices, dtype=np.uint32))

    @classmethod
    def _of(cls, data: MeshData) -> "Mesh":
        mesh = cls.__new__(cls)
        mesh._data = data
        return mesh

    @property
    def vertices(self) -> _arrays.Array:
        """(n, 3) float32, metres."""
        return self._data.vertices

    @property
    def faces(self) -> _arrays.Array:
        """(m, 3) uint32, counter-clockwise from outside."""
        return self._data.faces

    @property
    def normals(self) -> Optional[_arrays.Array]:
        """(n, 3) float32, unit, outward."""
        return self._data.normals

    @property
    def colours(self) -> Optional[_arrays.Array]:
        """(n, 3) uint8: red, green, blue."""
        return self._data.colours

    @property
    def intensity(self) -> Optional[_arrays.Array]:
        """(n,) float32, as that of the points."""
        return self._data.intensity

    @property
    def confidence(self) -> Optional[_arrays.Array]:
        """(n,) float32: exp (-d / 5), d voxels to the nearest data."""
        return self._data.confidence

    @property
    def sigma_m(self) -> Optional[_arrays.Array]:
        """(n,) float32: expected error, metres."""
        return self._data.sigma_m

    @property
    def provenance(self) -> Optional[_arrays.Array]:
        """(n,) uint8: see Provenance."""
        return self._data.provenance

    @property
    def is_closed(self) -> bool:
        """Whether each edge is in two triangles of opposite direction, and each vertex in one fan."""
        return self._data.is_closed

    @property
    def volume(self) -> float:
        """Of a closed mesh, cubic metres."""
        return self._data.mass_properties()[0]

    @property
    def centroid_m(self) -> _arrays.Array:
        """(3,): centre of mass of a closed mesh, metres."""
        return self._data.mass_properties()[1]

    @property
    def inertia(self) -> _arrays.Array:
        """(3, 3): about the centroid, for a density of 1 kg/m^3: kg m^2."""
        return self._data.mass_properties()[2]

    def save(self, path: str | os.PathLike[str], origin: Tuple[float, float, float] = (0.0, 0.0, 0.0)) -> None:
        """Write a .ply, .stl or .obj file. origin is added to the vertices, metres. Raises IoError."""
        self._data.save(os.fspath(path), origin)

    def to_open3d(self) -> Any:
        """An open3d.geometry.TriangleMesh, for which Open3D is imported."""
        open3d = importlib.import_module("open3d")
        utility = open3d.utility
        mesh = open3d.geometry.TriangleMesh(utility.Vector3dVector(self.vertices.astype(np.float64)),
                                             utility.Vector3iVector(self.faces.astype(np.int32)))
        if self.normals is not None:
            mesh.vertex_normals = utility.Vector3dVector(self.normals.astype(np.float64))
        if self.colours is not None:
            mesh.vertex_colors = utility.Vector3dVector(self.colours / 255.0)
        return mesh

    def trimesh_arguments(self) -> Dict[str, Any]:
        """Arguments of trimesh.Trimesh: trimesh.Trimesh(**mesh.trimesh_arguments())."""
        arguments: Dict[str, Any] = {"vertices": self.vertices.astype(np.float64),
                                     "faces": self.faces.astype(np.int64), "process": False}
        if self.normals is not None:
            arguments["vertex_normals"] = self.normals.astype(np.float64)
        if self.colours is not None:
            arguments["vertex_colors"] = self.colours
        return arguments

    def __repr__(self) -> str:
        return f"<pcl_cosection.{type(self).__name__}: {len(self.vertices)} vertices, {len(self.faces)} faces>"


def as_mesh(name: str, value: Any) -> Mesh:
    """A mesh from what has vertices and faces (trimesh) or triangles (Open3D), or from both as a pair."""
    if isinstance(value, Mesh):
        return value
    if hasattr(value, "vertices"):
        faces = getattr(value, "faces", getattr(value, "triangles", None))
        if faces is not None:
            return Mesh(np.asarray(value.vertices), np.asarray(faces))
    if isinstance(value, (tuple, list)) and len(value) == 2:
        return Mesh(*value)
    raise InvalidArgument(f"{name}: expected a mesh (with vertices and faces, or a pair of these) or the name of a "
                           f"file, got {type(value).__name__}")


def load_mesh(path: str | os.PathLike[str]) -> Mesh:
    """Read a mesh: .ply, .stl, .obj, .off, .vtk or .vtp, metres. Raises IoError."""
    return Mesh._of(_core.load_mesh(os.fspath(path)))


class SignedDistance:
    """A signed distance on a grid of cubic voxels: metres, positive outside, negative inside."""

    def __init__(self, data: FieldData) -> None:
        self._data = data

    @property
    def values(self) -> _arrays.Array:
        """(nz, ny, nx) float32, metres, at the centres of voxels; without a copy, not to be written."""
        return self._data.values

    @property
    def supported(self) -> Optional[_arrays.Array]:
        """(nz, ny, nx) uint8: 1 where a value is evidence, 0 where it is extrapolated; None: all are evidence."""
        return self._data.supported

    @property
    def voxel_size_m(self) -> float:
        """Edge of a voxel, metres."""
        return self._data.voxel_size_m

    @property
    def origin_m(self) -> _arrays.Array:
        """(3,): x, y, z of the centre of voxel values[0, 0, 0], metres."""
        return self._data.origin_m

    def sample(self, points: Any) -> _arrays.Array:
        """(n,) distances at (n, 3) points by trilinear interpolation, metres; NaN outside the grid."""
        return self._data.sample(_arrays.vectors("points", points, ("n", 3), dtype=np.float64))
