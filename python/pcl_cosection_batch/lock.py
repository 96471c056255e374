# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""Keeps two batches from doing the same item of one OUTPUT.

The lock is one of the system's on bytes of a file: it ends with the process, however that ends, and works on NFS. A
whole batch locks all bytes, one that does some of the items only a byte for each of these.
"""
import errno
import fcntl
import hashlib
import os
import socket
from types import TracebackType

from pcl_cosection_batch.errors import BatchError

NAMES_BYTE = 0
FIRST_ITEM_BYTE = 1
BYTES = 1 << 48
BUSY = (errno.EACCES, errno.EAGAIN)


class OutputLock:
    """The lock of one OUTPUT. Use it in a with statement."""

    def __init__(self, output: str, path: str) -> None:
        self.output = output
        self.path = path
        try:
            self.file = open(path, "r+b" if os.path.exists(path) else "w+b", buffering=0)
        except OSError as error:
            raise BatchError(f"{output}: cannot be written: {error.strerror}") from None

    def __enter__(self) -> "OutputLock":
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None,
                 trace: TracebackType | None) -> None:
        self.file.close()

    def lock_names(self) -> None:
        """Waits until no other process assigns names."""
        fcntl.lockf(self.file, fcntl.LOCK_EX, 1, NAMES_BYTE)

    def unlock_names(self) -> None:
        """Lets others assign names."""
        fcntl.lockf(self.file, fcntl.LOCK_UN, 1, NAMES_BYTE)

    def lock_all(self) -> None:
        """Locks all items."""
        self._lock(FIRST_ITEM_BYTE, BYTES, "another batch is writing to it")
        self.file.truncate(0)
        self.file.seek(0)
        self.file.write(f"process {os.getpid()} on {socket.gethostname()}\n".encode())

    def lock_item(self, name: str) -> None:
        """Locks one item."""
        digest = hashlib.sha256(os.fsencode(name)).digest()
        byte = FIRST_ITEM_BYTE + int.from_bytes(digest[:8], "big") % (BYTES - 1)
        self._lock(byte, 1, f"another batch is working on {name}")

    def _lock(self, begin: int, length: int, what: str) -> None:
        try:
            fcntl.lockf(self.file, fcntl.LOCK_EX | fcntl.LOCK_NB, length, begin)
        except OSError as error:
            if error.errno not in BUSY:
                raise BatchError(f"{self.output}: cannot be locked: {error.strerror}") from None
            self.file.seek(0)
            owner = self.file.read(200).decode(errors="replace").strip()
            raise BatchError(f"{self.output}: {what}" + (f" ({owner})" if owner else "")) from None
