# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""Checks of what users give: each function returns what the bindings take, or says which argument is wrong."""

from __future__ import annotations

import operator
from typing import Any, Dict, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from ._core import InvalidArgument

Array = npt.NDArray[Any]
Shape = Tuple[Union[int, str], ...]

MILLIMETRE = 0.001
_ROUNDING = 1e-3  # of colours


def _text(shape: Sequence[object]) -> str:
    return "(" + ", ".join(str(length) for length in shape) + ("," if len(shape) == 1 else "") + ")"


def as_array(name: str, value: Any) -> Array:
    """Any array; of numbers or truth values."""
    if isinstance(value, np.ma.MaskedArray) and np.any(value.mask):
        raise InvalidArgument(f"{name}: is a masked array; give its filled(), with NaN for what was not measured "
                              "(0 among whole numbers)")
    try:
        array = np.asarray(value)
    except (TypeError, ValueError) as error:
        raise InvalidArgument(f"{name}: expected an array, got {type(value).__name__} ({error})") from None
    if array.dtype.kind not in "biuf":
        what = type(value).__name__ if array.dtype.kind == "O" else f"an array of {array.dtype}"
        raise InvalidArgument(f"{name}: expected an array of numbers, got {what}")
    return array


def check_shape(name: str, array: Array, *shapes: Shape) -> Array:
    """Any of some shapes, in which a word stands for any length."""
    for shape in shapes:
        if array.ndim == len(shape) and all(isinstance(wanted, str) or wanted == length
                                              for wanted, length in zip(shape, array.shape)):
            return array
    expected = " or ".join(_text(shape) for shape in shapes)
    raise InvalidArgument(f"{name}: expected an array of shape {expected}, got {_text(array.shape)}")


def depth_image(name: str, value: Any, scale: Optional[float] = None) -> Array:
    """Metres as floats; whole numbers are millimetres, unless a scale says otherwise."""
    array = check_shape(name, as_array(name, value), ("height", "width"))
    if array.dtype.kind == "b":
        raise InvalidArgument(f"{name}: expected depths, got an array of truth values")
    if array.dtype == np.uint16:  # the largest value is no measurement
        array = np.where(array == 65535, np.uint16(0), array)
    if scale is None:
        scale = 1.0 if array.dtype.kind == "f" else MILLIMETRE
    if not (np.isfinite(scale) and scale > 0.0):
        raise InvalidArgument(f"depth_scale: expected a positive number of metres per unit, got {scale}")
    if scale == 1.0:
        return np.ascontiguousarray(array, dtype=np.float32)
    return np.ascontiguousarray((array * np.float64(scale)).astype(np.float32))


def label_array(name: str, value: Any, shape: Sequence[int]) -> Optional[Array]:
    """Whole numbers, or truth values for one object; negative ones are ignored, as 65535 is."""
    if value is None:
        return None
    array = check_shape(name, as_array(name, value), tuple(shape))
    if array.dtype.kind == "f":
        raise InvalidArgument(f"{name}: expected whole numbers, got an array of {array.dtype}")
    if array.dtype.kind in "iu" and array.size > 0 and int(array.max()) > 0xffffffff:
        raise InvalidArgument(f"{name}: expected numbers below 4294967296, got {array.max()}")
    if array.dtype.kind == "i" and array.size > 0 and int(array.min()) < 0:
        array = np.where(array < 0, 65535, array)
    return np.ascontiguousarray(array, dtype=np.uint32)


def colour_array(name: str, value: Any, shape: Sequence[int]) -> Optional[Array]:
    """Red, green and blue as bytes; floats are in [0, 1]."""
    if value is None:
        return None
    array = check_shape(name, as_array(name, value), (*shape, 3))
    if array.dtype.kind == "f":
        if array.size > 0 and (np.nanmax(array) > 1.0 + _ROUNDING or np.nanmin(array) < -_ROUNDING):
            raise InvalidArgument(f"{name}: expected bytes or floats in [0, 1], got floats from {np.nanmin(array)} to "
                                  f"{np.nanmax(array)}")
        array = np.rint(np.clip(np.nan_to_num(array), 0.0, 1.0) * 255.0)
    elif array.dtype != np.uint8:
        raise InvalidArgument(f"{name}: expected bytes or floats in [0, 1], got an array of {array.dtype}")
    return np.ascontiguousarray(array, dtype=np.uint8)


def vectors(name: str, value: Any, *shapes: Shape, dtype: npt.DTypeLike = np.float32) -> Array:
    """Real numbers of a type."""
    return np.ascontiguousarray(check_shape(name, as_array(name, value), *shapes), dtype=dtype)


def pose(name: str, value: Any) -> Array:
    """A rigid transform as a 4 x 4 matrix; nothing is the identity."""
    if value is None:
        return np.eye(4)
    matrix = vectors(name, value, (4, 4), dtype=np.float64)
    if not np.isfinite(matrix).all():
        raise InvalidArgument(f"{name}: expected finite numbers")
    rotation = matrix[:3, :3]
    if not (np.allclose(matrix[3], (0.0, 0.0, 0.0, 1.0)) and np.linalg.det(rotation) > 0.0
            and np.allclose(rotation @ rotation.T, np.eye(3), atol=1e-3)):
        raise InvalidArgument(f"{name}: expected a rotation and a translation, T_world_sensor, as a 4 x 4 matrix")
    return matrix


def by_label(name: str, value: Any) -> Dict[int, Any]:
    """What is given by label: whole numbers; nothing is nothing."""
    if value is None:
        return {}
    if not isinstance(value, Mapping):
        raise InvalidArgument(f"{name}: expected a mapping from labels, got {type(value).__name__}")
    result: Dict[int, Any] = {}
    for label, one in value.items():
        try:
            result[operator.index(label)] = one
        except TypeError:
            raise InvalidArgument(f"{name}: expected labels, which are whole numbers, got {label!r}") from None
    return result


def items(name: str, value: Any) -> List[Any]:
    """The items of a list, or of anything else that has some."""
    try:
        return list(value)
    except TypeError:
        raise InvalidArgument(f"{name}: expected a list, got {type(value).__name__}") from None


def camera(name: str, value: Any) -> Tuple[float, float, float, float]:
    """fx, fy, cx, cy from these four, or from a 3 x 3 camera matrix."""
    if value is None:
        raise InvalidArgument(f"{name}: expected (fx, fy, cx, cy) or a 3 x 3 matrix, got nothing")
    array = vectors(name, value, (4,), (3, 3), dtype=np.float64)
    if array.ndim == 2:
        if abs(array[0, 1]) > 1e-6 * abs(array[0, 0]) or array[1, 0] != 0.0 or not np.allclose(array[2], (0, 0, 1)):
            raise InvalidArgument(f"{name}: expected a camera matrix [[fx, 0, cx], [0, fy, cy], [0, 0, 1]]")
        array = array[(0, 1, 0, 1), (0, 1, 2, 2)]
    if not (np.isfinite(array).all() and array[0] > 0.0 and array[1] > 0.0):
        raise InvalidArgument(f"{name}: expected positive focal lengths and finite numbers, got {array.tolist()}")
    return (float(array[0]), float(array[1]), float(array[2]), float(array[3]))
