# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""Draws triangles into a picture, with a depth buffer and smooth edges; needs numpy and no display."""
import struct
import zlib
from dataclasses import dataclass
from typing import Any, Iterator

import numpy as np

OVERSAMPLING = 2  # in each direction
FRAGMENTS = 1 << 18  # that are worked on at a time
FIELD_OF_VIEW_DEG = 30.0
NEAR = 0.05  # of the distance to the target
AMBIENT = 0.35


@dataclass
class Triangles:
    """What is drawn."""

    vertices: Any  # n x 3, metres
    normals: Any  # n x 3
    colours: Any  # n x 3, 0 to 255
    corners: Any  # m x 3
    one_sided: Any  # m: whether it is left out where it faces away


@dataclass
class Camera:
    """A place to look from."""

    eye: Any
    target: Any
    up: Any

    def axes(self) -> Any:
        """Right, down, forward as rows."""
        forward = self.target - self.eye
        forward = forward / np.linalg.norm(forward)
        right = np.cross(forward, self.up)
        right = right / np.linalg.norm(right)
        return np.stack([right, np.cross(forward, right), forward])


def project(camera: Camera, points: Any, width: int, height: int) -> Any:
    """Column, row and inverse depth of points; the inverse depth is negative for points behind the camera."""
    seen = (points - camera.eye) @ camera.axes().T
    focal = 0.5 * min(width, height) / np.tan(np.radians(0.5 * FIELD_OF_VIEW_DEG))
    near = NEAR * np.linalg.norm(camera.target - camera.eye)
    depth = np.where(seen[:, 2] > near, seen[:, 2], 1.0)
    inverse = np.where(seen[:, 2] > near, 1.0 / depth, -1.0)
    return np.stack([0.5 * width + focal * seen[:, 0] / depth, 0.5 * height + focal * seen[:, 1] / depth, inverse], 1)


def fragments(corners: Any, chosen: Any, low: Any, size: int, width: int,
              height: int) -> Iterator[tuple[Any, Any, Any]]:
    """Pixels, inverse depths and numbers of the triangles that cover them; boxes have at most SIZE pixels a side."""
    steps = np.arange(size, dtype=np.float32)
    at_a_time = max(1, FRAGMENTS // size**2)
    for begin in range(0, len(chosen), at_a_time):
        numbers = chosen[begin:begin + at_a_time]
        # Weights of the corners are linear over the box: their values at its first pixel, and from pixel to pixel.
        first, right, below = (barycentric(corners[numbers], low[numbers] + 0.5 + offset).astype(np.float32)
                               for offset in ((0, 0), (1, 0), (0, 1)))
        columns = (right - first)[:, :, None] * steps  # triangle, corner, column
        rows = first[:, :, None] + (below - first)[:, :, None] * steps
        least = columns[:, 0, None, :] + rows[:, 0, :, None]
        for corner in (1, 2):
            np.minimum(least, columns[:, corner, None, :] + rows[:, corner, :, None], out=least)
        which, row, column = np.nonzero(least >= 0)
        depths = ((columns[which, :, column] + rows[which, :, row]) * corners[numbers[which], :, 2]).sum(-1)
        x, y = low[numbers[which], 0] + column, low[numbers[which], 1] + row
        on_screen = (x < width) & (y < height)
        yield (y * width + x)[on_screen], depths[on_screen], numbers[which[on_screen]]


def barycentric(corners: Any, points: Any) -> Any:
    """Weights of the three corners (... x 3 x 2 or more) at points (... x 2)."""
    a, b, c = corners[..., 0, :2], corners[..., 1, :2], corners[..., 2, :2]

    def area(p: Any, q: Any, r: Any) -> Any:
        return (q[..., 0] - p[..., 0]) * (r[..., 1] - p[..., 1]) - (q[..., 1] - p[..., 1]) * (r[..., 0] - p[..., 0])

    whole = area(a, b, c)
    whole = np.where(np.abs(whole) > 1e-12, whole, np.inf)
    return np.stack([area(b, c, points), area(c, a, points), area(a, b, points)], -1) / whole[..., None]


def visible_triangles(screen: Any, scene: Triangles, width: int, height: int) -> Any:
    """The number of the triangle that each pixel shows, -1 for nothing."""
    corners = screen[scene.corners]
    flat = corners[..., :2]
    low = np.floor(flat.min(1)).astype(np.int64)
    high = np.floor(flat.max(1)).astype(np.int64)
    edge, other = flat[:, 1] - flat[:, 0], flat[:, 2] - flat[:, 0]
    faces_away = edge[:, 0] * other[:, 1] - edge[:, 1] * other[:, 0] >= 0  # rows count downward
    drawn = (corners[..., 2] > 0).all(1) & (high >= 0).all(1) & (low < (width, height)).all(1)
    drawn &= ~(faces_away & scene.one_sided)
    low, high = np.maximum(low, 0), np.minimum(high, (width - 1, height - 1))
    sizes = (high - low).max(1) + 1
    nearest, shown = np.zeros(width * height), np.full(width * height, -1)
    size = 2
    while size < 2 * max(width, height):
        chosen = np.nonzero(drawn & (sizes <= size) & (sizes > size // 2 if size > 2 else sizes > 0))[0]
        for pixels, depths, numbers in fragments(corners, chosen, low, size, width, height):
            order = np.argsort(depths, kind="stable")
            order = order[depths[order] > nearest[pixels[order]]]
            nearest[pixels[order]] = depths[order]  # of several for one pixel, the last one stays
            shown[pixels[order]] = numbers[order]
        size *= 2
    return shown


def draw(scene: Triangles, camera: Camera, width: int, height: int) -> Any:
    """A picture, height x width x 3 bytes."""
    wide, high = OVERSAMPLING * width, OVERSAMPLING * height
    screen = project(camera, scene.vertices, wide, high)
    shown = visible_triangles(screen, scene, wide, high)
    pixels = np.nonzero(shown >= 0)[0]
    corners = scene.corners[shown[pixels]]
    points = np.stack([pixels % wide, pixels // wide], -1) + 0.5
    weights = barycentric(screen[corners], points)
    colours = np.einsum("nk,nkc->nc", weights, scene.colours[corners])
    normals = np.einsum("nk,nkc->nc", weights, scene.normals[corners])
    right, down, forward = camera.axes()
    light = -forward - 0.5 * down - 0.25 * right
    light = light / np.linalg.norm(light)
    lengths = np.sqrt(np.einsum("nc,nc->n", normals, normals))
    cosines = np.clip((normals @ light) / np.where(lengths > 0, lengths, 1), 0, 1)
    picture = np.full((high * wide, 3), 255, np.float32)  # white paper
    picture[pixels] = colours * (AMBIENT + (1 - AMBIENT) * cosines)[:, None]
    picture = picture.reshape(high, wide, 3)
    steps = [(row, column) for row in range(OVERSAMPLING) for column in range(OVERSAMPLING)]
    smooth = sum(picture[row::OVERSAMPLING, column::OVERSAMPLING] for row, column in steps) / len(steps)
    return np.clip(np.rint(smooth), 0, 255).astype(np.uint8)


def write_png(path: str, picture: Any) -> None:
    """Writes a picture as PNG."""
    height, width, _ = picture.shape
    rows = np.concatenate([np.zeros((height, 1), np.uint8), picture.reshape(height, -1)], axis=1)

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
                   chunk(b"IDAT", zlib.compress(rows.tobytes(), 6)) + chunk(b"IEND", b""))
