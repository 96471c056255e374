# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""Tracking and completion of streams of frames."""

from __future__ import annotations

import os
from typing import Any, Callable, Dict, Iterable, Iterator, List, Mapping, NamedTuple, Optional, Tuple

from . import _arrays
from ._completion import Object, Progress, _mesh_or_none
from ._core import FusionResultData, InvalidArgument, SequenceData, StreamData
from ._mesh import Mesh
from ._options import Options, option_arguments


class Frame(NamedTuple):
    """One frame of a stream."""

    depth: Any
    """(height, width): floats in metres, or whole numbers in millimetres; NaN or 0: no reading."""
    colour: Any = None
    """(height, width, 3) bytes, red, green, blue; None: none."""
    mask: Any = None
    """(height, width) whole numbers: the number of an instance, which may be another in the next mask; 0: none. None:
    it has no mask."""
    stamp: Optional[float] = None
    """Seconds, larger than that of the frame before; None: one more than that."""


class TrackedFrame(NamedTuple):
    """What is known of a frame."""

    stamp: float
    """Seconds."""
    T_world_camera: Optional[_arrays.Array]
    """4 x 4; None if the camera could not be tracked: the frame is left out."""
    T_world_object: Dict[int, _arrays.Array]
    """4 x 4, by the id of the object, of those that were tracked in the frame."""
    instances: Optional[_arrays.Array]
    """(height, width) uint16: id of the object, 0: background, 65535: neither; None: all is background."""
    keyframe: bool
    """Whether its points are used, too."""


class TrackedObject(Object):
    """A completed object of a stream, in its own frame; beside what an Object has:

    stamps          (n,) of the frames in which its pose is known, seconds
    T_world_object  (n, 4, 4): its poses then
    seen            Mesh of what was seen of it, open
    class_name      what it is, if a network has said so; else None
    """

    def __init__(self, values: Mapping[str, Any], warnings: List[str]) -> None:
        super().__init__(values, warnings)
        self.stamps: _arrays.Array
        self.T_world_object: _arrays.Array
        self.stamps, self.T_world_object = values["trajectory"]
        self.seen = _mesh_or_none(values["seen"])
        self.class_name: Optional[str] = values["class"][0] if values["class"] else None


class FusionResult:
    """What fuse() returns.

    objects          TrackedObject by id
    failed           why an object could not be completed, by id
    background       Mesh of the rest, open; None without one
    stamps           (n,) of the frames in which the camera was tracked, seconds
    T_world_camera   (n, 4, 4): its poses then; the world is the frame of the first camera
    frames           number of frames that were used
    frames_left_out  number of those that were not
    warnings         lines about the whole and its objects
    events           what tracking decided, and why
    timings_s        seconds by stage
    """

    def __init__(self, data: FusionResultData) -> None:
        self._data = data
        self.warnings: List[str] = data.warnings
        self.events: List[str] = data.events
        self.timings_s: Dict[str, float] = data.timings_s
        self.frames: int = data.frames
        self.frames_left_out: int = data.frames_left_out
        self.stamps: _arrays.Array
        self.T_world_camera: _arrays.Array
        self.stamps, self.T_world_camera = data.camera
        self.background: Optional[Mesh] = _mesh_or_none(data.background)
        given = data.objects
        self.objects: Dict[int, TrackedObject] = {one["id"]: TrackedObject(one, self.warnings)
                                                  for one in given if not one["error"]}
        self.failed: Dict[int, str] = {one["id"]: one["error"] for one in given if one["error"]}

    def save(self, output: str | os.PathLike[str]) -> List[str]:
        """Write meshes, trajectories and summary.json into a folder, as the program pcl_cosection_fusion does.

        Returns the names of the files. Raises IoError.
        """
        return self._data.save(os.fspath(output))

    def __repr__(self) -> str:
        return f"<pcl_cosection.FusionResult: {self.frames} frames, {len(self.objects)} objects>"


class Fusion:
    """Tracks the camera and the objects of frames that come one by one, and completes what they have shown.

        fusion = pcl_cosection.Fusion((480, 640), (fx, fy, cx, cy), masks=True)
        for depth, mask in frames:
            print(fusion.add(depth, mask=mask).T_world_camera)
        result = fusion.complete()

    Not for two threads at once.
    """

    def __init__(self, size: Tuple[int, int], intrinsics: Any, *, masks: bool = False, persistent_ids: bool = False,
                  segmentation: Optional[str] = None, keyframe_every: Optional[int] = None,
                  max_depth_m: Optional[float] = None, max_views: Optional[int] = None,
                  options: Options | Mapping[str, Any] | None = None) -> None:
        """Begin with nothing.

        size            (height, width) of all images
        intrinsics      (fx, fy, cx, cy) in pixels, or a 3 x 3 camera matrix
        masks           there will be masks, in some frames at least
        persistent_ids  an instance has the same number in all masks, that of its object
        segmentation    what finds objects in frames without a mask: "geometric" or "motion"
        keyframe_every  frames from one keyframe to the next; None: 10
        max_depth_m     readings beyond are left out; None: 10
        max_views       at most so many depth images are kept; None: 100
        options         Options of the method, or a dict of some

        Raises InvalidArgument.
        """
        try:
            height, width = (int(length) for length in size)
        except (TypeError, ValueError):
            raise InvalidArgument(f"size: expected (height, width), got {size!r}") from None
        if not (0 < height <= 16384 and 0 < width <= 16384):
            raise InvalidArgument(f"size: expected (height, width) of 1 to 16384 pixels each, got {size!r}")
        if segmentation not in (None, "geometric", "motion"):
            raise InvalidArgument(f'segmentation: expected "geometric", "motion" or None, got {segmentation!r}')
        arguments = option_arguments(options)
        for option, value in (("keyframe-every", keyframe_every), ("max-depth", max_depth_m),
                              ("max-views", max_views)):
            if value is not None:
                arguments.append(f"--{option}={value}")
        self._size = (height, width)
        self._masks = masks
        self._stamp: Optional[float] = None
        self._data = StreamData(arguments, _arrays.camera("intrinsics", intrinsics), height, width, masks,
                                 persistent_ids, segmentation or "")

    def add(self, depth: Any, colour: Any = None, mask: Any = None, stamp: Optional[float] = None) -> TrackedFrame:
        """Track, segment and map the next frame, as Frame describes it.

        Raises InvalidArgument; nothing is changed then.
        """
        image = _arrays.check_shape("depth", _arrays.depth_image("depth", depth), self._size)
        if mask is not None and not self._masks:
            raise InvalidArgument("mask: expected nothing, as masks=True was not given")
        labels = _arrays.label_array("mask", mask, self._size)
        if labels is not None and labels.size > 0 and int(labels.max()) > 65535:
            raise InvalidArgument(f"mask: expected numbers below 65536, got {labels.max()}")
        if stamp is None:
            stamp = 0.0 if self._stamp is None else self._stamp + 1.0
        known = self._data.add(image, _arrays.colour_array("colour", colour, self._size), labels, stamp)
        self._stamp = stamp
        if known is None:
            return TrackedFrame(stamp, None, {}, None, False)
        return TrackedFrame(stamp, **known)

    def complete(self, progress: Optional[Progress] = None) -> FusionResult:
        """Complete everything that was shown so far; further frames may follow.

        progress  called now and then with the name of a stage and the finished fraction; False cancels

        Raises DegenerateInput if no frame could be tracked, Cancelled, KeyboardInterrupt for Ctrl-C.
        """
        return FusionResult(self._data.complete(progress))


def fuse(frames: Iterable[Any], intrinsics: Any = None, *, masks: Optional[bool] = None, persistent_ids: bool = False,
          segmentation: Optional[str] = None, keyframe_every: Optional[int] = None, max_depth_m: Optional[float] = None,
          max_views: Optional[int] = None, on_frame: Optional[Callable[[TrackedFrame], Optional[bool]]] = None,
          progress: Optional[Progress] = None, options: Options | Mapping[str, Any] | None = None) -> FusionResult:
    """Track the camera and the objects of a stream of frames, and complete what they have shown.

    frames      Frames, or tuples (depth, colour, mask, stamp) of which the last ones may be missing; any iterable, as a
                generator that reads a camera; or a Sequence
    intrinsics  (fx, fy, cx, cy) in pixels, or a 3 x 3 camera matrix; a Sequence has its own
    masks       whether there will be masks; None: whether the first frame has one, or the Sequence
    on_frame    called with the TrackedFrame after each frame; False ends the stream, and what was shown is completed
    progress    called with the name of a stage and the finished fraction of the completion; False cancels
    persistent_ids, segmentation, keyframe_every, max_depth_m, max_views, options
                as of Fusion

    Returns a FusionResult. Raises InvalidArgument, DegenerateInput, Cancelled, KeyboardInterrupt for Ctrl-C.
    """
    if intrinsics is None:
        intrinsics = getattr(frames, "intrinsics", None)
    if masks is None:
        masks = getattr(frames, "has_masks", None)
    fusion: Optional[Fusion] = None
    for number, given in enumerate(_iterator(frames)):
        frame = _frame(number, given)
        if fusion is None:
            shape = _arrays.depth_image(f"frames[{number}].depth", frame.depth).shape
            fusion = Fusion((shape[0], shape[1]), intrinsics, masks=frame.mask is not None if masks is None else masks,
                             persistent_ids=persistent_ids, segmentation=segmentation, keyframe_every=keyframe_every,
                             max_depth_m=max_depth_m, max_views=max_views, options=options)
        tracked = fusion.add(frame.depth, frame.colour, frame.mask, frame.stamp)
        if on_frame is not None and on_frame(tracked) is False:
            break
    if fusion is None:
        raise InvalidArgument("frames: expected at least one frame, got none")
    result = fusion.complete(progress)
    if isinstance(frames, Sequence):
        result.warnings[:0] = frames.warnings
    return result


def _iterator(frames: Any) -> Iterator[Any]:
    try:
        return iter(frames)
    except TypeError:
        raise InvalidArgument(f"frames: expected an iterable of frames, got {type(frames).__name__}") from None


def _frame(number: int, given: Any) -> Frame:
    if isinstance(given, Frame):
        return given
    if isinstance(given, (tuple, list)) and 1 <= len(given) <= 4:
        return Frame(*given)
    if hasattr(given, "ndim") and given.ndim == 2:
        return Frame(given)
    raise InvalidArgument(f"frames[{number}]: expected a Frame, or a tuple (depth, colour, mask, stamp), "
                           f"got {type(given).__name__}")


class Sequence:
    """Frames of a sequence in a folder, as the program pcl_cosection_fusion reads them: in the layout of Co-Fusion, of
    TUM's benchmark, or of 7-Scenes. Frames are read when they are asked for.

    masks  folder of masks; None: there are none

    Raises IoError.
    """

    def __init__(self, folder: str | os.PathLike[str], masks: Optional[str | os.PathLike[str]] = None) -> None:
        self._data = SequenceData(os.fspath(folder), "" if masks is None else os.fspath(masks))
        self.has_masks = masks is not None

    @property
    def intrinsics(self) -> Tuple[float, float, float, float]:
        """fx, fy, cx, cy of the depth images, pixels."""
        fx, fy, cx, cy = self._data.intrinsics
        return (fx, fy, cx, cy)

    @property
    def size(self) -> Tuple[int, int]:
        """(height, width) of the images."""
        return self._data.size

    @property
    def warnings(self) -> List[str]:
        """Lines about what is odd: in the folders, and in the frames that were read."""
        return self._data.warnings

    def __len__(self) -> int:
        return len(self._data)

    def __getitem__(self, index: int) -> Frame:
        if not 0 <= index < len(self):
            raise IndexError(f"frame {index} is not there; the sequence has {len(self)}")
        stamp, depth, colour, mask = self._data.read(index)
        return Frame(depth, colour, mask, stamp)

    def __iter__(self) -> Iterator[Frame]:
        return (self[index] for index in range(len(self)))
