# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""Completes the hidden surfaces of objects in depth images and point clouds.

    import pcl_cosection

    result = pcl_cosection.complete(depth, labels, intrinsics=(fx, fy, cx, cy))
    for number, thing in result.objects.items():
        print(number, thing.volume, thing.vertices.shape, thing.faces.shape)
    result.save("meshes")

Units are metres, radians and pixels. A pose T_a_b is a 4 x 4 matrix that takes points of frame b to frame a. Sensor
frames have x to the right, y down and z forward. Label 0 is the background, 1, 2 ... are objects, 65535 is neither.

complete      objects in one or several views, at once
segment       finds the objects in an image by their geometry
fuse          tracks the camera and the objects of a stream of frames, and completes them
Fusion        the same, frame by frame
evaluate      compares meshes
export        bodies for simulators and planners, from a result
View          one view with its camera and pose
Options       what the programs can be told, too

Everything that goes wrong raises a subclass of Error, whose text is one line. Functions release the interpreter's lock
while they work, so several threads can work at once.
"""

from . import evaluate
from ._completion import Completion, Object, complete
from ._core import (Cancelled, DegenerateInput, Error, InvalidArgument, IoError, MemoryLimitExceeded, __version__)
from ._export import export
from ._fusion import Frame, Fusion, FusionResult, Sequence, TrackedFrame, TrackedObject, fuse
from ._mesh import Mesh, Provenance, SignedDistance, load_mesh
from ._options import Options
from ._segmentation import Segmentation, labels_from_masks, segment
from ._view import View

__all__ = [
    "Cancelled", "Completion", "DegenerateInput", "Error", "Frame", "Fusion", "FusionResult", "InvalidArgument",
    "IoError", "MemoryLimitExceeded", "Mesh", "Object", "Options", "Provenance", "Segmentation", "Sequence",
    "SignedDistance", "TrackedFrame", "TrackedObject", "View", "__version__", "complete", "evaluate", "export",
    "fuse", "labels_from_masks", "load_mesh", "segment",
]
