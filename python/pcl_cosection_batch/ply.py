# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""Reads the triangle meshes that the programs write: binary PLY, little endian."""
from dataclasses import dataclass
from typing import Any

import numpy as np

MAX_HEADER_BYTES = 1 << 16
TYPES = {
    "char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "<i2", "int16": "<i2", "ushort": "<u2",
    "uint16": "<u2", "int": "<i4", "int32": "<i4", "uint": "<u4", "uint32": "<u4", "float": "<f4", "float32": "<f4",
    "double": "<f8", "float64": "<f8"}


@dataclass
class Mesh:
    """Triangles with a provenance for each vertex: 0 observed, 1 inferred, 2 free space, 3 another body."""

    vertices: Any  # n x 3, metres
    normals: Any  # n x 3
    provenance: Any  # n
    triangles: Any  # m x 3


def parse_header(header: bytes) -> dict[str, tuple[int, list[list[str]]]]:
    """Number and properties of each element."""
    lines = header.decode("ascii", "replace").split("\n")
    if lines[0].strip() != "ply" or not any(line.startswith("format binary_little_endian") for line in lines):
        raise ValueError("not a binary PLY file")
    elements: dict[str, tuple[int, list[list[str]]]] = {}
    name = ""
    for words in (line.split() for line in lines):
        if words[:1] == ["element"]:
            name = words[1]
            elements[name] = int(words[2]), []
        elif words[:1] == ["property"]:
            elements[name][1].append(words[1:])
    return elements


def read_mesh(path: str) -> Mesh:
    """Reads a mesh. Raises ValueError."""
    with open(path, "rb") as file:
        data = file.read()
    end = data.find(b"end_header\n", 0, MAX_HEADER_BYTES)
    if end < 0:
        raise ValueError(f"{path}: not a PLY file")
    elements = parse_header(data[:end])
    begin = end + len(b"end_header\n")
    count, properties = elements["vertex"]
    layout = np.dtype([(words[-1], TYPES[words[0]]) for words in properties])
    rows = np.frombuffer(data, layout, count, begin)
    vertices = np.stack([rows[axis].astype(float) for axis in "xyz"], axis=1)
    faces, face_properties = elements.get("face", (0, []))
    if faces and [words[0] for words in face_properties] != ["list"]:
        raise ValueError(f"{path}: faces have other properties than their corners")
    if not faces:
        triangles = np.empty((0, 3), dtype=np.int64)
    else:
        _, length, index, _ = face_properties[0]
        face = np.dtype([("n", TYPES[length]), ("corners", TYPES[index], 3)])
        table = np.frombuffer(data, face, faces, begin + rows.nbytes)
        if (table["n"] != 3).any():
            raise ValueError(f"{path}: has faces that are no triangles")
        triangles = table["corners"].astype(np.int64)
    if len(triangles) and (triangles.min() < 0 or triangles.max() >= count):
        raise ValueError(f"{path}: a face has a corner that is not there")
    names = layout.names or ()
    provenance = rows["provenance"].astype(np.int64) if "provenance" in names else np.zeros(count, np.int64)
    return Mesh(vertices, normals_of(rows, names, vertices, triangles), np.clip(provenance, 0, 3), triangles)


def normals_of(rows: Any, names: tuple[str, ...], vertices: Any, triangles: Any) -> Any:
    """The normals of a file; those of the triangles, if it has none."""
    if "nx" in names:
        normals = np.stack([rows[axis].astype(float) for axis in ("nx", "ny", "nz")], axis=1)
    else:
        normals = np.zeros_like(vertices)
        a, b, c = (vertices[triangles[:, corner]] for corner in range(3))
        of_triangles = np.cross(b - a, c - a)
        for corner in range(3):
            np.add.at(normals, triangles[:, corner], of_triangles)
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    return normals / np.where(lengths > 0, lengths, 1)
