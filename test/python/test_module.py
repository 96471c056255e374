# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""Streams of frames, and what goes out of the module: meshes, bodies, the examples and the stubs."""
import filecmp
import os
import shutil
import subprocess
import sys
import tempfile
import types
import unittest

import numpy as np
import pcl_cosection
from support import COARSE, EXAMPLES, PROGRAMS, SOURCE, pose_of_camera, small_view, view_of_table

SIZE = (120, 160)


def stream(count):
    """Frames of a camera that moves."""
    for number in range(count):
        depth, labels, _ = view_of_table(pose_of_camera(0.03 * number), SIZE)
        yield pcl_cosection.Frame(depth, mask=labels if number == 0 else None, stamp=0.1 * number)


class Streams(unittest.TestCase):
    """fuse() and Fusion."""

    def test_camera_and_objects_are_tracked(self):
        seen = []
        intrinsics = small_view()[2]
        result = pcl_cosection.fuse(stream(6), intrinsics, on_frame=seen.append, keyframe_every=3, options=COARSE)
        self.assertEqual(len(seen), 6)
        first = pose_of_camera()
        for number, frame in enumerate(seen):
            expected = np.linalg.inv(first) @ pose_of_camera(0.03 * number)
            self.assertLess(np.linalg.norm(frame.T_world_camera[:3, 3] - expected[:3, 3]), 0.004)
            self.assertEqual(sorted(frame.T_world_object), [1, 2])
            self.assertEqual(frame.instances.shape, SIZE)
        self.assertEqual([frame.keyframe for frame in seen][:2], [True, False])
        self.assertEqual((result.frames, result.frames_left_out), (6, 0))
        self.assertEqual(sorted(result.objects), [1, 2])
        ball = result.objects[1]
        self.assertTrue(ball.is_closed)
        self.assertEqual(ball.T_world_object.shape, (6, 4, 4))
        self.assertGreater(len(ball.seen.faces), 50)
        self.assertEqual(result.T_world_camera.shape, (6, 4, 4))

    def test_frame_by_frame(self):
        fusion = pcl_cosection.Fusion(SIZE, small_view()[2], masks=True, options=COARSE)
        frames = list(stream(4))
        for frame in frames[:2]:
            fusion.add(*frame)
        early = fusion.complete()
        with self.assertRaisesRegex(pcl_cosection.InvalidArgument, "stamp"):
            fusion.add(*frames[0])
        for frame in frames[2:]:
            fusion.add(*frame)
        late = fusion.complete()
        self.assertEqual((early.frames, late.frames), (2, 4))
        whole = pcl_cosection.fuse(frames, small_view()[2], options=COARSE)
        np.testing.assert_array_equal(late.objects[1].vertices, whole.objects[1].vertices)

    def test_callbacks_end_a_stream(self):
        intrinsics = small_view()[2]
        stopped = pcl_cosection.fuse(stream(6), intrinsics, on_frame=lambda frame: frame.stamp < 0.15, options=COARSE)
        self.assertEqual(stopped.frames, 3)
        with self.assertRaises(pcl_cosection.Cancelled):
            pcl_cosection.fuse(stream(2), intrinsics, progress=lambda stage, fraction: False, options=COARSE)

        def interrupted():
            yield from stream(2)
            raise KeyboardInterrupt
        with self.assertRaises(KeyboardInterrupt):
            pcl_cosection.fuse(interrupted(), intrinsics, options=COARSE)

    def test_same_as_program(self):
        with tempfile.TemporaryDirectory() as folder:
            data, program, mine = (os.path.join(folder, name) for name in ("data", "program", "module"))
            subprocess.run([os.path.join(PROGRAMS, "pcl_cosection_simulate"), "--quiet", "--preset", "table",
                            "--frames", "0:3", "--views-every", "0", data], check=True)
            options = ["--resolution", "16", "--priors", "none", "--background-voxel-size", "0.04",
                       "--keyframe-every", "2"]
            subprocess.run([os.path.join(PROGRAMS, "pcl_cosection_fusion"), "--quiet", *options, "--masks",
                            os.path.join(data, "mask"), data, program], check=True)
            frames = pcl_cosection.Sequence(data, os.path.join(data, "mask"))
            self.assertEqual((len(frames), frames.size), (3, (480, 640)))
            result = pcl_cosection.fuse(frames, keyframe_every=2, options={"resolution": 16, "priors": "none",
                                                                           "background_voxel_size": 0.04})
            names = [os.path.relpath(name, mine) for name in result.save(mine)]
            self.assertGreater(len(names), 6)
            for name in names:
                self.assertTrue(filecmp.cmp(os.path.join(mine, name), os.path.join(program, name), False), name)


class Segmentation(unittest.TestCase):
    """segment()."""

    def test_finds_what_stands_on_the_table(self):
        depth, labels, intrinsics = view_of_table()
        found = pcl_cosection.segment(depth, intrinsics)
        self.assertEqual(found.labels.max(), 2)
        for number in (1, 2):
            mine = found.labels[labels == number]
            self.assertGreater(np.mean(mine == np.bincount(mine).argmax()), 0.95)
        np.testing.assert_allclose(np.linalg.norm(found.planes[0][:3]), 1.0, atol=1e-5)
        points = pcl_cosection._segmentation.points_of_depth(depth, *intrinsics)
        np.testing.assert_array_equal(pcl_cosection.segment(points).labels, found.labels)


class Outputs(unittest.TestCase):
    """Meshes of other libraries, comparison, export."""

    def test_comparison_and_other_meshes(self):
        thing = pcl_cosection.complete(*small_view(), options=COARSE).objects[1]
        like_trimesh = types.SimpleNamespace(vertices=thing.vertices + np.float32(0.001), faces=thing.faces.astype(int))
        like_open3d = types.SimpleNamespace(vertices=thing.vertices, triangles=thing.faces.astype(np.int32))
        moved = pcl_cosection.evaluate.mesh(thing, like_trimesh, samples=2000)
        self.assertAlmostEqual(moved.accuracy_m.mean, 0.001, delta=0.0006)
        self.assertEqual(moved.f_score, 1.0)
        self.assertLess(pcl_cosection.evaluate.mesh(like_open3d, thing, samples=2000).accuracy_m.max, 1e-6)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "thing.ply")
            thing.save(path)
            loaded = pcl_cosection.load_mesh(path)
            np.testing.assert_array_equal(loaded.vertices, thing.vertices)
            self.assertLess(pcl_cosection.evaluate.mesh(path, thing).accuracy_m.max, 1e-6)
        arguments = thing.trimesh_arguments()
        self.assertEqual(arguments["vertices"].shape, thing.vertices.shape)

    def test_nothing_heavy_is_imported(self):
        code = ("import sys, pcl_cosection\n"
                "print([name for name in ('open3d', 'trimesh', 'cv2', 'matplotlib') if name in sys.modules])")
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
        self.assertEqual(done.stdout, "[]\n")

    def test_export(self):
        result = pcl_cosection.complete(*small_view(), options=COARSE)
        with tempfile.TemporaryDirectory() as folder:
            written = pcl_cosection.export(result, folder, ["mjcf", "urdf"], density_kg_m3=500.0, masses_kg={1: 2.5})
            names = {os.path.basename(name) for name in written.files}
            self.assertTrue({"scene.xml", "object_1.urdf", "scene.json"} <= names, names)
            with open(os.path.join(folder, "object_1.urdf"), encoding="utf-8") as file:
                self.assertIn("2.5", file.read())
            with self.assertRaisesRegex(pcl_cosection.InvalidArgument, "format"):
                pcl_cosection.export(result, folder, "blend")

    def test_a_full_place_is_one_line(self):
        result = pcl_cosection.complete(*small_view(), options=COARSE)
        with self.assertRaises(pcl_cosection.IoError):
            result.save("/proc/nothing")
        with self.assertRaises(pcl_cosection.InvalidArgument):
            result.save("result.pcd")


class Example(unittest.TestCase):
    """Runs an example."""

    def run_example(self, name, *arguments):
        """Its output."""
        done = subprocess.run([sys.executable, os.path.join(EXAMPLES, name), *arguments], capture_output=True,
                              text=True, check=False, env={**os.environ, "MPLBACKEND": "Agg"})
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout


class Documents(Example):
    """The examples run, the page's code gives what it says, the stubs are right, and help() says something."""

    def test_stream(self):
        with tempfile.TemporaryDirectory() as folder:
            text = self.run_example("stream.py", os.path.join(folder, "out"))
            self.assertIn("objects [1, 2]", text)
            self.assertTrue(os.path.exists(os.path.join(folder, "out/mesh/object_1.ply")))

    @unittest.skipIf(shutil.which("mypy") is None, "mypy is not installed")
    def test_stubs(self):
        package = os.path.join(SOURCE, "python/pcl_cosection")
        with tempfile.TemporaryDirectory() as cache:
            done = subprocess.run(["mypy", "--strict", "--cache-dir", cache, package,
                                   os.path.join(EXAMPLES, "simulated_table.py")], capture_output=True, text=True,
                                  check=False)
        self.assertEqual(done.returncode, 0, done.stdout)

    def test_doctests(self):
        for path in (os.path.join(EXAMPLES, "simulated_table.py"), os.path.join(SOURCE, "doc/pcl_cosection_python.md")):
            done = subprocess.run([sys.executable, "-m", "doctest", path], capture_output=True, text=True, check=False,
                                  env={**os.environ, "PYTHONPATH": os.pathsep.join((EXAMPLES, *sys.path))})
            self.assertEqual((done.returncode, done.stdout), (0, ""), path)

    def test_everything_public_is_described(self):
        for name in pcl_cosection.__all__:
            value = getattr(pcl_cosection, name)
            if name != "__version__":
                self.assertTrue((value.__doc__ or "").strip(), name)
        for kind in (pcl_cosection.Mesh, pcl_cosection.Fusion, pcl_cosection.SignedDistance, pcl_cosection.Sequence):
            for name, value in vars(kind).items():
                if not name.startswith("_"):
                    self.assertTrue((value.__doc__ or "").strip(), f"{kind.__name__}.{name}")


class Pictures(Example):
    """Examples that draw."""

    @classmethod
    def setUpClass(cls):
        try:
            import cv2
            import matplotlib
        except ImportError as error:
            raise unittest.SkipTest(str(error)) from None
        del matplotlib
        cls.cv2 = cv2

    def test_two_views(self):
        with tempfile.TemporaryDirectory() as folder:
            text = self.run_example("two_views.py", folder)
            self.assertIn("2 view(s)", text)
            for name in ("depth.png", "provenance.png"):
                self.assertGreater(np.std(self.cv2.imread(os.path.join(folder, name))), 10.0)

    def test_depth_image(self):
        with tempfile.TemporaryDirectory() as folder:
            depth, labels, _ = view_of_table(shape=(480, 640))
            os.mkdir(os.path.join(folder, "masks"))
            self.cv2.imwrite(os.path.join(folder, "depth.png"), np.rint(1000.0 * depth).astype(np.uint16))
            self.cv2.imwrite(os.path.join(folder, "colour.png"), np.full((480, 640, 3), (40, 160, 220), np.uint8))
            for number in (1, 2):
                self.cv2.imwrite(os.path.join(folder, f"masks/{number}.png"),
                                 (255 * (labels == number)).astype(np.uint8))
            self.run_example("depth_image.py", folder)
            self.assertGreater(np.std(self.cv2.imread(os.path.join(folder, "completed.png"))), 10.0)


if __name__ == "__main__":
    unittest.main()
