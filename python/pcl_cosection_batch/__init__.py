# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""Runs pcl_cosection and pcl_cosection_fusion on many inputs, on the cores of one machine or of a cluster."""
