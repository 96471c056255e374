# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""complete(): what it returns, that it is what the program writes, and that it gets along with Python."""
import filecmp
import json
import os
import resource
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import numpy as np
import pcl_cosection
from support import COARSE, PROGRAMS, pose_of_camera, save_pcd, small_view, view_of_table


def same_mesh(first, second):
    """Whether both have the same bytes."""
    return first.vertices.tobytes() == second.vertices.tobytes() and first.faces.tobytes() == second.faces.tobytes()


class Result(unittest.TestCase):
    """What a result has."""

    @classmethod
    def setUpClass(cls):
        cls.result = pcl_cosection.complete(*small_view(), options={"save_bounds": True, "save_hull": True})

    def test_objects_are_closed_and_of_the_right_size(self):
        self.assertEqual(sorted(self.result.objects), [1, 2])
        self.assertEqual(self.result.failed, {})
        ball = self.result.objects[1]
        self.assertTrue(ball.is_closed)
        self.assertAlmostEqual(ball.volume / (4 / 3 * np.pi * 0.05**3), 1.0, delta=0.1)
        self.assertAlmostEqual(self.result.objects[2].volume / (0.1 * 0.08 * 0.12), 1.0, delta=0.25)
        self.assertAlmostEqual(np.trace(ball.inertia) / (6 / 5 * ball.volume * 0.05**2), 1.0, delta=0.1)

    def test_arrays(self):
        for thing in self.result.objects.values():
            count = len(thing.vertices)
            self.assertEqual((thing.vertices.dtype, thing.vertices.shape), (np.float32, (count, 3)))
            self.assertEqual((thing.faces.dtype, thing.faces.shape[1]), (np.uint32, 3))
            self.assertLess(thing.faces.max(), count)
            for name, dtype in (("confidence", np.float32), ("sigma_m", np.float32), ("provenance", np.uint8)):
                array = getattr(thing, name)
                self.assertEqual((array.dtype, array.shape), (dtype, (count,)), name)
            self.assertIsNone(thing.colours)
            self.assertTrue(set(np.unique(thing.provenance)) <= set(pcl_cosection.Provenance))
            np.testing.assert_allclose(np.linalg.norm(thing.normals, axis=1), 1.0, atol=1e-4)

    def test_arrays_are_no_copies_and_outlive_the_result(self):
        result = pcl_cosection.complete(*small_view(), options=COARSE)
        vertices, values = result.objects[1].vertices, result.objects[1].sdf.values
        again = result.objects[1].vertices
        self.assertEqual(vertices.ctypes.data, again.ctypes.data)
        self.assertFalse(vertices.flags.writeable or vertices.flags.owndata or values.flags.owndata)
        with self.assertRaises(ValueError):
            vertices[0] = 0.0
        expected = vertices.copy()
        del result, again
        trash = [np.random.default_rng(n).random(vertices.shape) for n in range(20)]
        np.testing.assert_array_equal(vertices, expected)
        del trash

    def test_signed_distance_is_zero_on_the_mesh(self):
        thing = self.result.objects[1]
        distances = thing.sdf.sample(thing.vertices)
        self.assertLess(np.abs(distances).max(), 0.5 * thing.sdf.voxel_size_m)
        self.assertLess(thing.sdf.sample([thing.centroid_m])[0], 0.0)
        self.assertTrue(np.isnan(thing.sdf.sample([(9.0, 9.0, 9.0)])[0]))
        index = np.unravel_index(np.argmin(thing.sdf.values), thing.sdf.values.shape)  # z, y, x
        place = thing.sdf.origin_m + thing.sdf.voxel_size_m * np.array(index[::-1])
        self.assertAlmostEqual(float(thing.sdf.sample([place])[0]), float(thing.sdf.values.min()), places=5)

    def test_bounds_enclose_each_other(self):
        thing = self.result.objects[2]
        self.assertLess(thing.inner_bound.volume, thing.volume)
        self.assertGreater(thing.outer_bound.volume, thing.volume)
        self.assertGreater(thing.hull.volume, 0.9 * thing.volume)
        self.assertIsNone(pcl_cosection.complete(*small_view(), options=COARSE).objects[1].hull)

    def test_planes_and_background(self):
        normal, distance = self.result.planes[0][:3], self.result.planes[0][3]
        np.testing.assert_allclose(np.linalg.norm(normal), 1.0, atol=1e-6)
        self.assertGreater(self.result.objects[1].centroid_m @ normal + distance, 0.0)
        self.assertGreater(len(self.result.background.faces), 100)

    def test_summary_and_warnings(self):
        depth, labels, intrinsics = small_view()
        labels = labels.copy()
        labels[0, :5] = 7
        result = pcl_cosection.complete(depth, labels, intrinsics, options=COARSE)
        self.assertTrue(any("label 7" in line for line in result.warnings), result.warnings)
        self.assertEqual(result.summary["warnings"], result.warnings)
        self.assertEqual([thing["id"] for thing in result.summary["objects"]], [1, 2])
        self.assertEqual(result.objects[1].warnings, [])


class SameAsProgram(unittest.TestCase):
    """The same input gives the same bytes."""

    def check(self, view_arguments, pcd_files, options, flags):
        """Compare the files of both."""
        with tempfile.TemporaryDirectory() as folder:
            files = []
            for number, arguments in enumerate(pcd_files):
                files.append(os.path.join(folder, f"view{number}.pcd"))
                save_pcd(files[-1], *arguments)
            subprocess.run([os.path.join(PROGRAMS, "pcl_cosection"), "--quiet", *flags, *files,
                            os.path.join(folder, "program")], check=True)
            with open(os.path.join(folder, "program", "summary.json"), encoding="utf-8") as file:
                expected = json.load(file)
            del expected["timings_s"]
            results = [pcl_cosection.complete(*view_arguments, options=options),
                       pcl_cosection.complete(files, options=pcl_cosection.Options(**options))]
            for number, result in enumerate(results):
                mine = os.path.join(folder, f"module{number}")
                names = [os.path.basename(name) for name in result.save(mine)]
                self.assertIn("object_1.ply", names)
                self.assertEqual(sorted([*names, "summary.json"]), sorted(os.listdir(os.path.join(folder, "program"))))
                for name in names:
                    self.assertTrue(filecmp.cmp(os.path.join(mine, name), os.path.join(folder, "program", name), False),
                                    name)
                with open(os.path.join(mine, "summary.json"), encoding="utf-8") as file:
                    summary = json.load(file)
                del summary["timings_s"]
                self.assertEqual(summary, expected)

    def test_depth_image(self):
        view = small_view()
        self.check(view, [view], {}, [])

    def test_options(self):
        view = small_view()
        self.check(view, [view], {"voxel_size": 0.004, "constraints": "hull", "save_sdf": True, "max_faces": 500},
                   ["--voxel-size", "0.004", "--constraints", "hull", "--save-sdf", "--max-faces", "500"])

    def test_two_views_with_poses(self):
        views, files = [], []
        for angle in (0.3, -0.9):
            T = pose_of_camera(angle)
            arguments = view_of_table(T, (120, 160))
            views.append(pcl_cosection.View(*arguments, T))
            files.append((*arguments, T))
        self.check((views,), files, {"resolution": 24}, ["--resolution", "24"])


class Inputs(unittest.TestCase):
    """The forms in which views may come."""

    def test_millimetres_and_points_are_the_same_view(self):
        depth, labels, intrinsics = small_view()
        millimetres = np.rint(1000.0 * depth).astype(np.uint16)
        metres = (millimetres * 0.001).astype(np.float32)
        first = pcl_cosection.complete(millimetres, labels, intrinsics, options=COARSE)
        second = pcl_cosection.complete(metres, labels, intrinsics, options=COARSE)
        tenths = pcl_cosection.complete(10 * millimetres.astype(np.int32), labels, intrinsics, depth_scale=0.0001,
                                        options=COARSE)
        self.assertTrue(same_mesh(first.objects[1], second.objects[1]))
        np.testing.assert_allclose(tenths.objects[1].volume, first.objects[1].volume, rtol=1e-3)

    def test_camera_matrix_and_layouts(self):
        depth, labels, (fx, fy, cx, cy) = small_view()
        plain = pcl_cosection.complete(depth, labels, (fx, fy, cx, cy), options=COARSE)
        matrix = [[fx, 0, cx], [0, fy, cy], [0, 0, 1]]
        for other in (pcl_cosection.complete(np.asfortranarray(depth), labels.astype(np.uint8), matrix, options=COARSE),
                      pcl_cosection.complete(np.repeat(depth, 2, 1)[:, ::2], labels.astype(np.int16), matrix,
                                             options=COARSE),
                      pcl_cosection.complete(pcl_cosection.View(depth, labels, matrix), options=COARSE)):
            self.assertTrue(same_mesh(plain.objects[1], other.objects[1]))

    def test_points_of_one_object(self):
        depth, labels, intrinsics = small_view()
        points = pcl_cosection._segmentation.points_of_depth(depth, *intrinsics)[labels == 1]
        for dtype in (np.float32, np.float64):
            result = pcl_cosection.complete(points.astype(dtype), options={"threads": 1})
            self.assertEqual(list(result.objects), [1])
            self.assertTrue(result.objects[1].is_closed)

    def test_colours_reach_the_mesh(self):
        depth, labels, intrinsics = small_view()
        colours = np.zeros((*depth.shape, 3), np.uint8)
        colours[labels == 1] = (200, 30, 60)
        for given in (colours, colours / 255.0):
            ball = pcl_cosection.complete(depth, labels, intrinsics, colours=given, options=COARSE).objects[1]
            seen = ball.provenance == pcl_cosection.Provenance.OBSERVED
            np.testing.assert_allclose(np.median(ball.colours[seen], axis=0), (200, 30, 60), atol=2)

    def test_masks_and_truth_values(self):
        depth, labels, intrinsics = small_view()
        made = pcl_cosection.labels_from_masks([labels == 1, 255 * (labels == 2)])
        np.testing.assert_array_equal(made, labels)
        self.assertEqual(pcl_cosection.labels_from_masks([labels == 1, labels > 0])[labels == 1].min(), 65535)
        one = pcl_cosection.complete(depth, labels == 2, intrinsics, options=COARSE)
        self.assertEqual(list(one.objects), [1])

    def test_planes_obstacles_and_proposals(self):
        depth, labels, intrinsics = small_view()
        T = pose_of_camera()
        plain = pcl_cosection.complete(depth, labels, intrinsics, T, options=COARSE)
        box = np.array([(x, y, z) for x in (-0.2, -0.1) for y in (-0.1, 0.2) for z in (-0.1, 0.2)], np.float32)
        faces = np.array([(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6),
                          (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)])
        with_box = pcl_cosection.complete(depth, labels, intrinsics, T, obstacles=[(box + np.array((0.0, 0.15, 0.0)),
                                                                                   faces)], options=COARSE)
        self.assertFalse(same_mesh(plain.objects[1], with_box.objects[1]))
        with_plane = pcl_cosection.complete(depth, np.where(labels == 0, 65535, labels), intrinsics, T,
                                            planes=[(0.0, 0.0, 1.0, -0.01)], options=COARSE)
        self.assertGreater(with_plane.objects[2].vertices[:, 2].min(), 0.005)
        truth = pcl_cosection.Mesh((box - box.mean(0)) / (0.1, 0.3, 0.3) * (0.1, 0.08, 0.12), faces)
        proposed = pcl_cosection.complete(depth, labels, intrinsics, T, proposals={2: truth})
        self.assertTrue(proposed.summary["objects"][1]["proposal"]["used"], proposed.summary["objects"][1])

    def test_free_space(self):
        depth, labels, intrinsics = small_view()
        side = pose_of_camera(1.0)
        other = pcl_cosection.View(view_of_table(side, (120, 160))[0], None, intrinsics, side)
        alone = pcl_cosection.complete(depth, labels, intrinsics, pose_of_camera(), options=COARSE)
        carved = pcl_cosection.complete(depth, labels, intrinsics, pose_of_camera(), free_space=[other], options=COARSE)
        self.assertFalse(same_mesh(alone.objects[2], carved.objects[2]))

    def test_objects_that_moved(self):
        depth, labels, intrinsics = small_view()
        T = pose_of_camera()
        moved = np.eye(4)
        moved[:3, 3] = (0.5, 0.2, 0.0)
        camera_too = moved @ T  # the same image: everything has moved, and the camera with it
        views = [pcl_cosection.View(depth, labels, intrinsics, T, T_world_object={1: np.eye(4)}),
                 pcl_cosection.View(depth, labels, intrinsics, camera_too, T_world_object={1: moved})]
        ball = pcl_cosection.complete(views, options=COARSE).objects[1]
        np.testing.assert_allclose(ball.centroid_m, (-0.10, 0.02, 0.05), atol=0.01)


class Running(unittest.TestCase):
    """Threads, signals, callbacks, memory and time."""

    def test_progress_and_cancellation(self):
        stages = []
        pcl_cosection.complete(*small_view(), progress=lambda stage, fraction: stages.append((stage, fraction)),
                               options=COARSE)
        fractions = [fraction for _, fraction in stages]
        self.assertEqual(fractions, sorted(fractions))
        self.assertGreater(len({stage for stage, _ in stages}), 2)
        with self.assertRaises(pcl_cosection.Cancelled):
            pcl_cosection.complete(*small_view(), progress=lambda stage, fraction: False)

    def test_errors_of_callbacks_arrive(self):
        def fail(stage, fraction):
            raise KeyError(stage)
        with self.assertRaises(KeyError):
            pcl_cosection.complete(*small_view(), progress=fail)
        with self.assertRaises(TypeError):
            pcl_cosection.complete(*small_view(), progress=lambda: True)

    def test_interrupt(self):
        code = ("import signal, threading, os, pcl_cosection\n"
                "from support import view_of_table\n"
                "def progress(stage, fraction):\n"
                "    if fraction > 0.1: os.kill(os.getpid(), signal.SIGINT)\n"
                "try:\n"
                "    pcl_cosection.complete(*view_of_table(), progress=progress)\n"
                "except KeyboardInterrupt:\n"
                "    print('interrupted')\n")
        done = subprocess.run([sys.executable, "-c", code], cwd=os.path.dirname(os.path.abspath(__file__)),
                              capture_output=True, text=True, check=False, timeout=120)
        self.assertEqual((done.stdout, done.returncode), ("interrupted\n", 0), done.stderr)

    def test_two_threads_at_once(self):
        expected = pcl_cosection.complete(*small_view(), options=COARSE)
        results, ticks = [], []
        def work():
            results.append(pcl_cosection.complete(*small_view(), options=COARSE))
        workers = [threading.Thread(target=work) for _ in range(2)]
        for worker in workers:
            worker.start()
        while any(worker.is_alive() for worker in workers):  # this thread goes on meanwhile
            ticks.append(time.perf_counter())
            time.sleep(0.001)
        for worker in workers:
            worker.join()
        self.assertEqual(len(results), 2)
        self.assertGreater(len(ticks), 10)
        for result in results:
            self.assertTrue(same_mesh(result.objects[1], expected.objects[1]))

    def test_memory_does_not_grow(self):
        def call():
            result = pcl_cosection.complete(*small_view(), options=COARSE)
            return result.objects[1].vertices.sum()
        for _ in range(10):
            call()
        before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        for _ in range(40):
            call()
        self.assertLess(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before, 20000)  # kilobytes

    def test_overhead(self):
        view = view_of_table(shape=(480, 640))
        overheads = []
        for _ in range(2):
            start = time.perf_counter()
            result = pcl_cosection.complete(*view)
            elapsed = time.perf_counter() - start
            overheads.append(1.0 - result.timings_s["total"] / elapsed)
        self.assertLess(min(overheads), 0.02)


if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.default_int_handler)
    unittest.main()
