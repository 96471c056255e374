# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""What ends a batch, and the exit status that it ends with."""


class UsageError(Exception):
    """The command line or a list file is wrong: exit status 2."""


class BatchError(Exception):
    """Something of the machine or of the cluster is wrong: exit status 1."""


class Stopped(Exception):
    """A signal asked the batch to end: exit status 128 + its number."""

    def __init__(self, signal_number: int) -> None:
        super().__init__(f"signal {signal_number}")
        self.signal_number = signal_number
