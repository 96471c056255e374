# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""The pictures of a result: from the side of the sensors and from behind, coloured by provenance."""
import contextlib
import os
import shutil
import signal
import subprocess

VIEWER = "pcl_cosection_viewer"
PICTURES = {"overview": "picture.png", "behind": "picture_behind.png"}  # by the viewer's name of the view
SIZE = "400x340"
HIDDEN = ("path", "frustum", "legend", "caption")
TIMEOUT_S = 60
PNG = b"\x89PNG\r\n\x1a\n"


def draw_result(program: str, folder: str, staging: str, working_folder: str) -> tuple[list[str], list[str]]:
    """Draws what PROGRAM wrote to FOLDER, with the viewer beside it or in PATH. Returns the names of the pictures, in
    FOLDER too, and what there is to say about it."""
    viewer = os.path.join(os.path.dirname(program), VIEWER)
    found = viewer if os.access(viewer, os.X_OK) else shutil.which(VIEWER)
    if not found:
        return [], []
    hidden = [word for part in HIDDEN for word in ("--hide", part)]
    for view, name in PICTURES.items():
        made = os.path.join(staging, name)  # the viewer writes nothing into what it shows
        command = [found, "--quiet", "--threads", "1", "--colour", "provenance", "--size", SIZE, *hidden,
                   "--view", view, "--screenshot", made, folder]
        failure = run(command, working_folder)
        if not failure and not is_png(made):
            failure = "it wrote no picture"
        if failure:
            return [], [f"there are no pictures: {VIEWER}: {failure}"]
    for name in PICTURES.values():
        os.rename(os.path.join(staging, name), os.path.join(folder, name))
    return list(PICTURES.values()), []


def run(command: list[str], working_folder: str) -> str:
    """Runs the viewer in a process group of its own. Returns what went wrong; nothing, if all is well."""
    environment = {**os.environ, "OMP_NUM_THREADS": "1", "OMP_WAIT_POLICY": "passive"}
    try:
        with subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                              cwd=working_folder, env=environment, start_new_session=True) as viewer:
            try:
                _, said = viewer.communicate(timeout=TIMEOUT_S)
            except subprocess.TimeoutExpired:
                said = f"it took longer than {TIMEOUT_S} s".encode()
            finally:
                with contextlib.suppress(ProcessLookupError):
                    os.killpg(viewer.pid, signal.SIGKILL)
    except OSError as error:
        return f"it cannot be run: {error.strerror}"
    lines = said.decode(errors="replace").strip().splitlines()
    return "" if viewer.returncode == 0 else lines[-1] if lines else f"exit status {viewer.returncode}"


def is_png(path: str) -> bool:
    """Whether a file is there and begins as a picture does."""
    try:
        with open(path, "rb") as file:
            return file.read(len(PNG)) == PNG
    except OSError:
        return False
