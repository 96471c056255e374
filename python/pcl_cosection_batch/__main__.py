# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""python3 -m pcl_cosection_batch"""
import sys

from pcl_cosection_batch.main import main

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
