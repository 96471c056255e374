# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""The recipes of doc/pcl_cosection_batch.md, as they stand there. A program stands in for pcl_cosection."""
import os
import re
import shutil
import stat
import subprocess
import unittest

from batch_stand_in import COMMAND, SOURCE, TIMEOUT_S, BatchTest


def code_after(heading):
    """The first block of code below a heading of the document."""
    text = (SOURCE / "doc" / "pcl_cosection_batch.md").read_text()
    return re.search(r"```\w+\n(.*?)```", text.partition(f"\n{heading}\n")[2], re.DOTALL).group(1)


class Recipes(BatchTest):
    """The batch is found in PATH, beside the stand-in."""

    def setUp(self):
        super().setUp()
        launcher = self.bin / "pcl_cosection_batch"
        words = " ".join(f"'{word}'" for word in (*COMMAND, "--programs", self.bin))
        launcher.write_text(f'#!/bin/sh\nexec {words} "$@"\n')
        launcher.chmod(stat.S_IRWXU)
        self.inputs.rename(self.folder / "views")
        self.inputs = self.folder / "views"
        self.output = self.folder / "results"
        for name in ("a", "b c", "it's", "d", "e"):
            self.view(name + ".pcd")

    def run_here(self, command, status=0, **variables):
        """Runs a command in the folder."""
        ended = subprocess.run(command, cwd=self.folder, capture_output=True, text=True, timeout=TIMEOUT_S, check=False,
                               env={**self.environment(), **variables, "HOME": str(self.folder),
                                    "PATH": f"{self.bin}:{os.environ['PATH']}"})
        self.assertEqual(ended.returncode, status, ended)
        return ended

    def test_slurm_array(self):
        script = self.folder / "complete.sh"
        script.write_text(code_after("### A Slurm array job"))
        for task in ("1", "2"):
            self.run_here(["sh", script], SLURM_ARRAY_TASK_ID=task, SLURM_ARRAY_TASK_COUNT="2", SLURM_CPUS_PER_TASK="2")
        self.assertEqual(self.called(), ["a.pcd", "b c.pcd", "d.pcd", "e.pcd", "it's.pcd"])
        self.assertEqual({call["threads"] for call in self.calls()}, {"2"})
        self.run_here(["pcl_cosection_batch", "--collect", "views/", "results/"])
        self.assertEqual({row["status"] for row in self.summary().values()}, {"done"})

    @unittest.skipIf(shutil.which("snakemake") is None, "needs snakemake")
    def test_snakemake(self):
        (self.folder / "Snakefile").write_text(code_after("### Snakemake"))
        snakemake = [shutil.which("snakemake"), "--cores", "2", "--keep-going", "--quiet", "all"]
        self.run_here(snakemake)
        self.assertEqual(self.called(), ["a.pcd", "b c.pcd", "d.pcd", "e.pcd", "it's.pcd"])
        self.assertTrue((self.output / "index.html").exists())
        self.view("d.pcd", sigma=0.002)
        self.run_here(snakemake)
        self.assertEqual(self.called().count("d.pcd"), 2)
        self.assertEqual(len(self.calls()), 6)


if __name__ == "__main__":
    unittest.main()
