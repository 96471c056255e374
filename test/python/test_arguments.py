# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""Wrong arguments get one line that names the argument and says what was expected."""
import dataclasses
import unittest

import numpy as np
import pcl_cosection
from support import COARSE, small_view

DEPTH, LABELS, CAMERA = small_view()
TRIANGLE = (np.eye(3), np.array([[0, 1, 2]]))


class Arguments(unittest.TestCase):
    """One case a line: the call, and what its message must have."""

    def check(self, call, *words, error=pcl_cosection.InvalidArgument):
        """The error has one line with these words."""
        with self.assertRaises(error) as caught:
            call()
        text = str(caught.exception)
        self.assertNotIn("\n", text)
        for word in words:
            self.assertIn(word, text)

    def complete(self, *args, **kwargs):
        """A call that is refused before the work."""
        return lambda: pcl_cosection.complete(*args, **kwargs)

    def test_shapes(self):
        self.check(self.complete(DEPTH, LABELS[:10], CAMERA), "labels: expected an array of shape (120, 160)",
                   "(10, 160)")
        self.check(self.complete(DEPTH, LABELS), "intrinsics: expected")
        self.check(self.complete(DEPTH, LABELS, (1, 2, 3)), "intrinsics: expected an array of shape (4,) or (3, 3)")
        self.check(self.complete(DEPTH[None], LABELS, CAMERA), "view: expected an array of shape (height, width)",
                   "(1, 120, 160)")
        self.check(self.complete(DEPTH, LABELS, CAMERA, np.eye(3)), "T_world_sensor: expected an array of shape (4, 4)")
        self.check(self.complete(DEPTH, LABELS, CAMERA, colours=LABELS), "colours: expected", "(120, 160, 3)")
        self.check(self.complete(DEPTH, LABELS, CAMERA, planes=[(1, 2)]), "planes: expected an array of shape (4,)")
        self.check(self.complete(np.zeros((0, 3))), "points: expected at least one point")
        self.check(lambda: pcl_cosection.Mesh(np.zeros((3, 2)), [[0, 1, 2]]), "vertices: expected", "(n, 3)")
        self.check(lambda: pcl_cosection.Mesh(np.eye(3), [[0, 1, 3]]), "faces: expected indices below 3")

    def test_types(self):
        self.check(self.complete(DEPTH, LABELS.astype(float), CAMERA), "labels: expected whole numbers", "float64")
        self.check(self.complete(None), "view: expected an array of numbers", "NoneType")
        self.check(self.complete(3), "view: expected an array of shape")
        self.check(self.complete([]), "view: expected at least one view")
        self.check(self.complete(["a.pcd", 3]), "view[1]: expected a View or the name of a file, got int")
        self.check(self.complete(np.array(["a"])), "view: expected an array of numbers")
        self.check(self.complete(DEPTH > 0, LABELS, CAMERA), "depth: expected depths, got an array of truth values")
        self.check(self.complete(DEPTH, LABELS, CAMERA, colours=np.zeros((120, 160, 3), np.int64)),
                   "colours: expected bytes")
        self.check(self.complete(DEPTH, LABELS, CAMERA, colours=np.full((120, 160, 3), 255.0)),
                   "colours: expected bytes or floats in [0, 1], got floats from 255.0")
        self.check(self.complete(np.ma.masked_less(DEPTH, 1.0), LABELS, CAMERA), "view: is a masked array")
        self.check(self.complete(DEPTH, LABELS, CAMERA, obstacles=[3]), "obstacles[0]: expected a mesh", "got int")
        self.check(self.complete(DEPTH, LABELS, CAMERA, obstacles=3), "obstacles[0]: expected a mesh", "got int")
        self.check(self.complete(DEPTH, LABELS, CAMERA, planes=None), "planes: expected a list, got NoneType")
        self.check(self.complete(DEPTH, LABELS, CAMERA, free_space=3), "free_space: expected a list, got int")
        self.check(self.complete(DEPTH, LABELS, CAMERA, proposals=[3]), "proposals: expected a mapping from labels")
        self.check(self.complete(DEPTH, LABELS, CAMERA, options={"model": ""}), "model: expected a value, got nothing")
        self.check(lambda: pcl_cosection.View(DEPTH, LABELS, CAMERA, T_world_object={1.7: np.eye(4)}),
                   "T_world_object: expected labels, which are whole numbers, got 1.7")
        self.check(self.complete(DEPTH, LABELS, CAMERA, progress=3), "progress: expected a function", "got int")
        self.check(lambda: pcl_cosection.evaluate.mesh(TRIANGLE, 3), "reconstruction: expected a mesh")
        self.check(lambda: pcl_cosection.export(3, "out", "mjcf"), "result: expected a Completion")
        self.check(lambda: pcl_cosection.fuse(3), "frames: expected an iterable of frames, got int")
        self.check(lambda: pcl_cosection.fuse([3], CAMERA), "frames[0]: expected a Frame")

    def test_values(self):
        self.check(self.complete(DEPTH, LABELS, (0, 1, 2, 3)), "intrinsics: expected positive focal lengths")
        self.check(self.complete(DEPTH, LABELS, CAMERA, np.zeros((4, 4))), "T_world_sensor: expected a rotation")
        self.check(self.complete(DEPTH, LABELS, CAMERA, np.full((4, 4), np.nan)), "T_world_sensor: expected finite")
        self.check(self.complete(DEPTH, LABELS, CAMERA, depth_scale=-1.0), "depth_scale: expected a positive number")
        self.check(self.complete("view.pcd", LABELS), "labels: expected nothing beside a View or a file")
        self.check(lambda: pcl_cosection.View(DEPTH, points=np.zeros((4, 3))),
                   "depth: expected either depth, or points")
        self.check(lambda: pcl_cosection.View(points=np.zeros((4, 3)), intrinsics=CAMERA),
                   "intrinsics: expected nothing")
        self.check(lambda: pcl_cosection.fuse([]), "frames: expected at least one frame")
        self.check(lambda: pcl_cosection.Fusion((0, 5), CAMERA), "size: expected (height, width)")
        self.check(lambda: pcl_cosection.Fusion(DEPTH.shape, CAMERA, segmentation="x"), "segmentation: expected")
        self.check(lambda: pcl_cosection.labels_from_masks([]), "masks: expected at least one mask")
        self.check(lambda: pcl_cosection.labels_from_masks([LABELS, LABELS[1:]]),
                   "masks[1]: expected an array of shape")

    def test_options(self):
        def options(**given):
            return self.complete(DEPTH, LABELS, CAMERA, options=given)
        self.check(options(voxel_sise=1), "options: there is no option voxel_sise", "voxel_size")
        self.check(options(voxel_size=-1), "voxel_size:", "greater than 0")
        self.check(options(voxel_size="large"), "voxel_size:")
        self.check(options(voxel_size=[1, 2]), "voxel_size")
        self.check(options(resolution=2.5), "resolution:")
        self.check(options(constraints="some"), "constraints:", "hull")
        self.check(options(priors=["extent", "magic"]), "priors:", "magic")
        self.check(options(voxel_size=0.01, resolution=64), "voxel_size and resolution exclude each other")
        self.check(options(model="no.onnx"), "no.onnx", error=pcl_cosection.IoError)
        self.check(self.complete(DEPTH, LABELS, CAMERA, options=3), "options: expected Options or a dict")
        self.check(lambda: pcl_cosection.Fusion(DEPTH.shape, CAMERA, options={"scale": 2.0}), "unknown option", "scale")

    def test_data(self):
        none = np.full(DEPTH.shape, np.nan, np.float32)
        degenerate = pcl_cosection.DegenerateInput
        self.check(self.complete(none, LABELS, CAMERA), "view 0: none of its 19200 points", error=degenerate)
        self.check(self.complete(DEPTH, 0 * LABELS, CAMERA), "all points have label 0", error=degenerate)
        self.check(self.complete("missing.pcd"), "missing.pcd: no such file", error=pcl_cosection.IoError)
        self.check(lambda: pcl_cosection.segment(none, CAMERA), "", error=degenerate)
        self.check(lambda: pcl_cosection.load_mesh("missing.ply"), "missing.ply", error=pcl_cosection.IoError)
        self.check(lambda: pcl_cosection.fuse([none], CAMERA), "could not be tracked", error=degenerate)
        self.check(lambda: pcl_cosection.fuse([DEPTH, DEPTH[1:]], CAMERA),
                   "depth: expected an array of shape (120, 160)")
        self.check(lambda: pcl_cosection.evaluate.mesh((np.zeros((3, 3)), [[0, 1, 2]]), TRIANGLE), "", error=degenerate)

    def test_hierarchy(self):
        for error, parent in ((pcl_cosection.InvalidArgument, ValueError), (pcl_cosection.IoError, OSError),
                              (pcl_cosection.DegenerateInput, ValueError),
                              (pcl_cosection.MemoryLimitExceeded, MemoryError)):
            self.assertTrue(issubclass(error, pcl_cosection.Error) and issubclass(error, parent))
            self.assertEqual(error.__module__, "pcl_cosection")
        self.check(self.complete(DEPTH, LABELS, CAMERA, options={"max_memory": 100000}),
                   "view 0: its 19200 points need",
                   error=pcl_cosection.MemoryLimitExceeded)

    def test_an_object_that_fails_loses_nothing(self):
        result = pcl_cosection.complete(DEPTH, LABELS, CAMERA, options={**COARSE, "max_memory": "3M"})
        self.assertEqual((list(result.objects), list(result.failed)), ([1], [2]))
        self.assertIn("are allowed", result.failed[2])
        self.assertTrue(any("object 2" in line for line in result.warnings))

    def test_every_option_of_the_program_is_there(self):
        elsewhere = {"help", "version", "config", "verbose", "quiet", "json", "export", "format", "segment",
                     "save-labels", "max-object-size", "intrinsics", "object-trajectory", "free-space", "plane",
                     "obstacle", "proposal"}
        names = {field.name.replace("_", "-") for field in dataclasses.fields(pcl_cosection.Options)}
        self.assertEqual(set(pcl_cosection._core.option_names()) - elsewhere, names)


if __name__ == "__main__":
    unittest.main()
