# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""What the batch makes of its INPUTs, of list files and of wrong arguments; no item is run."""
import os
import re
import sys
import unittest

from batch_stand_in import SOURCE, BatchTest

sys.path.insert(0, str(SOURCE / "python"))
from pcl_cosection_batch.arguments import duration, make_parser, size  # noqa: E402
from pcl_cosection_batch.items import Item  # noqa: E402
from pcl_cosection_batch.names import assign_names, clean_name  # noqa: E402


class Items(BatchTest):
    """--dry-run prints the items."""

    def items(self, *inputs, options=()):
        """Names of items, and the names of their files."""
        printed, _ = self.batch("--dry-run", *options, *inputs, self.output)
        self.assertFalse(self.output.exists())
        items = {}
        for line in printed.splitlines():
            name, program, files = re.fullmatch(r"(.*?): (\w+) (.*)", line).groups()
            items[name] = program, [os.path.basename(file) for file in files.split(" /")]
        return items

    def test_a_folder_is_taken_apart(self):
        for name in ("b.pcd", "a.PLY", "scene/view10.pcd", "scene/view2.pcd", "scene/deep/x.pcd", ".hidden.pcd",
                     "notes.txt", "old/object_1.ply", "old/summary.json", "tum/associations.txt", "tum/mesh.ply",
                     "group/cofusion/depth/Depth0001.png", "seven/frame-000000.depth.png", "scene/truth_1.ply",
                     "truth_12_blue cup.ply", "room/traj.txt", "room/results/depth000000.png"):
            self.view(name)
        sequence, views = "pcl_cosection_fusion", "pcl_cosection"
        self.assertEqual(self.items(self.inputs), {
            "a": (views, ["a.PLY"]), "b": (views, ["b.pcd"]), "scene": (views, ["view2.pcd", "view10.pcd"]),
            "scene-deep": (views, ["x.pcd"]), "tum": (sequence, ["tum"]),
            "group-cofusion": (sequence, ["cofusion"]), "seven": (sequence, ["seven"]), "room": (sequence, ["room"])})

    def test_each_view_of_a_subfolder(self):
        self.view("scene/view1.pcd")
        self.view("scene/view2.pcd")
        self.assertEqual(list(self.items(self.inputs, options=["--subfolders", "views"])),
                         ["scene-view1", "scene-view2"])
        self.assertEqual(list(self.items(self.inputs / "scene")), ["view1", "view2"])

    def test_the_output_is_no_input(self):
        self.view("a.pcd")
        self.view("results/a/object_1.ply")
        (self.inputs / "link").symlink_to(self.inputs)
        printed, _ = self.batch("--dry-run", self.inputs, self.inputs / "results")
        self.assertEqual(len(printed.splitlines()), 1)

    def test_items_of_a_list(self):
        for name in ("a.pcd", "b c.pcd", "scene/1.pcd", "scene/2.pcd", "seq/depth.txt"):
            self.view(name)
        (self.inputs / "list.txt").write_text(
            "\ufeff# comment\r\n\r\na.pcd\r\n'b c.pcd' a.pcd -- --resolution 20\nscene\n"
            "'my cup:' scene/1.pcd\nseq\nmine: a.pcd\n"
            "gone.pcd\n")
        items = self.items(self.inputs / "list.txt")
        self.assertEqual(items["a"], ("pcl_cosection", ["a.pcd"]))
        self.assertEqual(items["b c"], ("pcl_cosection", ["b c.pcd", "a.pcd"]))
        self.assertEqual(items["scene"], ("pcl_cosection", ["1.pcd", "2.pcd"]))
        self.assertEqual(items["seq"], ("pcl_cosection_fusion", ["seq"]))
        self.assertEqual(items["my cup"], ("pcl_cosection", ["1.pcd"]))
        self.assertEqual(items["mine"], ("pcl_cosection", ["a.pcd"]))
        self.assertIn("gone.pcd is not there", items["gone"][1][-1])

    def refused(self, text, *expected):
        """A list file is refused; the line says why."""
        (self.inputs / "list.txt").write_bytes(text)
        _, errors = self.batch(self.inputs / "list.txt", self.output, status=2)
        self.assertEqual(len(errors.splitlines()), 1, errors)
        for words in expected:
            self.assertIn(words, errors)
        self.assertFalse(self.output.exists())

    def test_wrong_lists(self):
        self.view("a.pcd")
        self.view("seq/depth.txt")
        self.refused(b"a.pcd\n'a.pcd\n", "line 2", "no closing quotation")
        self.refused(b"", "has no items")
        self.refused(b"# nothing\n", "has no items")
        self.refused(b"a.pcd seq\n", "line 1", "alone")
        self.refused(b"-- --resolution 3\n", "line 1", "options")
        self.refused(b": a.pcd\n", "line 1", "name")
        self.refused(b"\x89PNG\0\0", "neither a view")
        self.refused(b"a.pcd\na.pcd -- --resolution 20\n", "twice")

    def test_wrong_arguments(self):
        self.view("a.pcd")
        (self.folder / "file").write_text("")
        (self.folder / "empty").mkdir()
        (self.folder / "result").mkdir()
        for name in ("summary.json", "object_1.stl"):
            (self.folder / "result" / name).write_text("{}")
        for arguments, expected in (
                ([self.inputs, self.folder / "result"], "has what a program wrote"),
                ([self.folder / "result", self.output], "and no input"),
                ([], "INPUT and an OUTPUT"), ([self.inputs], "INPUT and an OUTPUT"),
                ([self.inputs, self.output, "--nonsense"], "--nonsense"),
                (["gone", self.output], "no such file"), ([self.inputs, self.folder / "file"], "must be a folder"),
                ([self.folder / "empty", self.output], "has no views"),
                ([self.inputs, self.inputs], "INPUT and OUTPUT"),
                (["--workers", "0", self.inputs, self.output], "--workers"),
                (["--time-limit", "soon", self.inputs, self.output], "--time-limit"),
                (["--memory-limit", "-1", self.inputs, self.output], "--memory-limit"),
                (["--share", "3/2", self.inputs, self.output], "--share"),
                (["--options", "'", self.inputs, self.output], "quotation"),
                (["--slurm-time", "1:00", self.inputs, self.output], "needs --slurm"),
                (["--slurm", "--ssh", "a", self.inputs, self.output], "exclude"),
                (["--scheduler", "a:1", "--workers", "2", self.inputs, self.output], "--workers"),
                (["--collect", "--force", self.inputs, self.output], "--collect"),
                (["--only", "x", "--dry-run", self.inputs, self.output], "no such item"),
                (["--programs", "/nowhere", self.inputs, self.output], "no program")):
            with self.subTest(expected=expected):
                _, errors = self.batch(*arguments, status=2)
                self.assertEqual(len(errors.splitlines()), 1, errors)
                self.assertIn(expected, errors)

    def test_help_fits_and_is_documented(self):
        printed, _ = self.batch("--help")
        self.assertLessEqual(max(map(len, printed.splitlines())), 80)
        document = (SOURCE / "doc" / "pcl_cosection_batch.md").read_text()
        for action in make_parser()._actions:
            for option in action.option_strings:
                if option.startswith("--"):
                    self.assertIn(option, printed)
                    self.assertIn(f"`{option}", document)

    def test_version(self):
        self.assertEqual(self.batch("--version")[0], "pcl_cosection_batch of stand-in 1.0\n")


class Names(unittest.TestCase):
    """Names of result folders."""

    def test_names_are_harmless(self):
        for wanted, name in (("a/b", "a-b"), ("../x", "_.-x"), ("-rf", "_rf"), ("a\nb", "a_b"), ("", "_"),
                             ("index.html", "index.html_"), ("ü 'q' \"", "ü 'q' \""), (".batch", "_batch")):
            self.assertEqual(clean_name(wanted), name)
        self.assertLess(len(os.fsencode(clean_name("ä" * 300))), 200)
        self.assertNotEqual(clean_name("x" * 300 + "1"), clean_name("x" * 300 + "2"))

    def test_names_stay(self):
        here, there = Item("views", (__file__,), "cup"), Item("views", (str(SOURCE / "README.md"),), "Cup")
        first = assign_names([there], {})
        self.assertEqual(first, {there.source: "Cup"})
        second = assign_names([here, there], first)
        self.assertEqual(second[there.source], "Cup")
        self.assertEqual(second[here.source], "cup-2")
        self.assertEqual(assign_names([here], second)[here.source], "cup-2")
        gone = Item("views", ("/nowhere/cup.pcd",), "cup")
        self.assertEqual(assign_names([here], {gone.source: "cup"})[here.source], "cup")

    def test_units(self):
        self.assertEqual([duration(text) for text in ("90", "90s", "1.5m", "2h")], [90, 90, 90, 7200])
        self.assertEqual([size(text) for text in ("1000", "1K", "1.5M", "2G")], [1000, 1024, 3 << 19, 2 << 30])


if __name__ == "__main__":
    unittest.main()
