# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""python3 -m pcl_cosection_batch"""
import sys

from pcl_cosection_batch.main import main



def run() -> int:
    """The program, as pip installs it."""
    return main(sys.argv[1:])


if __name__ == "__main__":
    sys.exit(run())
