#!/usr/bin/env python3
# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""A minute of training: the loss falls, and the program can use the network. Arguments: the folder of the programs."""
import json
import os
import re
import subprocess
import sys
import tempfile

here = os.path.dirname(os.path.abspath(__file__))
programs = os.path.abspath(sys.argv[1])
with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    command = [sys.executable, os.path.join(here, "../tools/prior_training/train.py"), "--generator",
               os.path.join(programs, "make_training_samples"), "--minutes", "0.7", "--batch", "4", "--kept", "80",
               "--report", "5", "--output", "short.onnx", "--checkpoint", "short.pt"]
    text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    losses = [float(value) for value in re.findall(r"loss ([\d.]+)", text)]
    print("losses", losses)
    assert len(losses) >= 4 and sum(losses[-3:]) < 3 * 0.75 * losses[0], "the loss does not fall"

    again = command + ["--start", "short.onnx", "--minutes", "0.1", "--output", "again.onnx", "--checkpoint", "again.pt"]
    text = subprocess.run(again, check=True, capture_output=True, text=True).stdout
    first = float(re.search(r"loss ([\d.]+)", text).group(1))
    print("first loss from the short run's weights", first)
    assert first < 0.9 * losses[0], "it does not begin with the weights of the file"
    wrong = subprocess.run(command + ["--start", os.path.join(here, "check_training.py")], check=False, capture_output=True, text=True)
    assert wrong.returncode == 2 and "--start" in wrong.stderr.splitlines()[-1], wrong.stderr

    subprocess.run([os.path.join(programs, "pcl_cosection_simulate"), "--quiet", "--preset", "table", "--frames", "0:1",
                    "--views-every", "1", "scene"], check=True)
    view = os.path.join("scene/views", sorted(os.listdir("scene/views"))[0])
    subprocess.run([os.path.join(programs, "pcl_cosection"), "--quiet", "--model", "short.onnx", "--json", "run.json",
                    view, "result"], check=True)
    with open("run.json", encoding="utf-8") as file:
        summary = json.load(file)
    assert any("learned" in thing for thing in summary["objects"]), "the network was not asked"
