# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""Has CMake build the extension of the Python module. Everything else is in pyproject.toml.

PCL_COSECTION_CMAKE_ARGS holds further arguments of CMake, separated by spaces.
"""
import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

SOURCE = Path(__file__).resolve().parent


def version() -> str:
    """That of the project in CMakeLists.txt."""
    text = (SOURCE / "CMakeLists.txt").read_text(encoding="utf-8")
    found = re.search(r"^\s*VERSION ([\d.]+)$", text, re.MULTILINE)
    assert found, "CMakeLists.txt has no VERSION"
    return found.group(1)


class CMakeBuild(build_ext):
    """The extension and what it needs: built, and installed where setuptools collects the package."""

    def build_extension(self, ext: Extension) -> None:
        """Only the module: neither tests nor the window."""
        build = Path(self.build_temp).resolve()
        package = Path(self.get_ext_fullpath(ext.name)).resolve().parent
        off = [f"-DPCL_COSECTION_BUILD_{part}=OFF" for part in ("TESTS", "BENCHMARKS", "VIEWER")]
        subprocess.run(["cmake", "-S", str(SOURCE), "-B", str(build), "-DCMAKE_BUILD_TYPE=Release", *off,
                        "-DPCL_COSECTION_BUILD_PYTHON=ON", "-DPCL_COSECTION_PYTHON_DIR=.",
                        "-DPCL_COSECTION_PYTHON_STANDALONE=ON", f"-DPython3_EXECUTABLE={sys.executable}",
                        *shlex.split(os.environ.get("PCL_COSECTION_CMAKE_ARGS", ""))], check=True)
        subprocess.run(["cmake", "--build", str(build), "--target", "pcl_cosection_python", "--parallel",
                        str(os.cpu_count() or 1)], check=True)
        subprocess.run(["cmake", "--install", str(build), "--component", "python", "--prefix", str(package.parent)],
                       check=True)


setup(version=version(), ext_modules=[Extension("pcl_cosection._core", sources=[])], cmdclass={"build_ext": CMakeBuild})
