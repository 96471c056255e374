# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""Where items are done: on the cores of this machine, or by a Dask scheduler's workers elsewhere."""
import importlib.util
import logging
import os
import sys
import warnings
import zipfile
from typing import Any

from pcl_cosection_batch.arguments import Arguments
from pcl_cosection_batch.errors import BatchError
from pcl_cosection_batch.terminal import Terminal

CONNECT_TIMEOUT_S = 10


def require(module: str, package: str, option: str) -> None:
    """Says which package is missing, if it is."""
    if importlib.util.find_spec(module) is None:
        raise BatchError(f"{option} needs the Python package {module}, which is not installed (Debian: {package})")


def configure(verbose: bool) -> None:
    """Settings of Dask for this process and those that it starts."""
    require("distributed", "python3-distributed", "running items")
    import dask

    level = "warning" if verbose else "critical"
    dask.config.set({
        "logging.distributed": level,
        "logging.bokeh": "critical",
        "logging.tornado": "critical",
        "logging.asyncio": "critical",
        "distributed.scheduler.allowed-failures": 0,  # the batch counts the attempts
        "distributed.scheduler.work-stealing": False,
        "distributed.worker.multiprocessing-method": "forkserver",  # starts workers twice as fast as "spawn"
        "distributed.comm.timeouts.connect": f"{CONNECT_TIMEOUT_S}s",
        "distributed.admin.tick.limit": "1h",
        "distributed.nanny.pre-spawn-environ": {"OPENBLAS_NUM_THREADS": 1},  # nothing that slows memory down
    })
    for name in ("distributed", "tornado", "asyncio", "asyncssh"):
        logging.getLogger(name).setLevel(getattr(logging, level.upper()))


def package_archive(folder: str) -> str:
    """Packs this package, for workers that do not have it. Returns the path of the archive."""
    here = os.path.dirname(os.path.abspath(__file__))
    path = os.path.join(folder, "pcl_cosection_batch.zip")
    with zipfile.ZipFile(path, "w") as archive:
        for name in sorted(os.listdir(here)):
            if name.endswith(".py"):
                archive.write(os.path.join(here, name), f"pcl_cosection_batch/{name}")
    return path


class Cluster:
    """A scheduler and its workers. Subclasses start some; this one uses what is there at an address."""

    can_come_back = True  # whether it makes sense to connect again when the connection is lost
    waits_for_ever = False
    sends_package = True

    def __init__(self, address: str, folder: str) -> None:
        self.address = address
        self.folder = folder  # for files of this batch
        self.archive = ""

    def connect(self) -> Any:
        """A new client. Raises OSError."""
        from distributed import Client

        client: Any = Client(  # type: ignore[no-untyped-call]
            self.address, timeout=CONNECT_TIMEOUT_S, set_as_default=False)
        try:
            if self.sends_package:
                self.archive = self.archive or package_archive(self.folder)
                client.upload_file(self.archive)
        except BaseException:
            client.close(timeout=1)
            raise
        return client

    def look_after(self, workers: int) -> None:
        """Called every now and then, with the number of workers that are there."""

    def close(self) -> None:
        """Ends what was started."""


class OwnCluster(Cluster):
    """A cluster whose scheduler is in this process."""

    can_come_back = False

    def __init__(self, cluster: Any, folder: str) -> None:
        super().__init__(cluster.scheduler_address, folder)
        self.cluster = cluster

    def close(self) -> None:
        """Ends scheduler and workers."""
        try:
            self.cluster.close(timeout=10)
        except (OSError, TimeoutError):
            pass


class LocalCores(OwnCluster):
    """A process for each item at a time, on this machine."""

    sends_package = False

    def __init__(self, workers: int, folder: str) -> None:
        from distributed import LocalCluster

        super().__init__(
            LocalCluster(  # type: ignore[no-untyped-call]
                n_workers=workers, threads_per_worker=1, processes=True, memory_limit=0, host="127.0.0.1",
                dashboard_address="127.0.0.1:0", local_directory=folder, worker_dashboard_address=None,
                silence_logs=logging.CRITICAL), folder)


class SshHosts(OwnCluster):
    """Workers that are started by SSH."""

    def __init__(self, arguments: Arguments, folder: str) -> None:
        require("asyncssh", "python3-asyncssh", "--ssh")
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # asyncssh knows old ciphers, of which another package warns
            import asyncssh  # noqa: F401
        import dask
        from distributed import Scheduler, SpecCluster
        from distributed.deploy.ssh import Worker
        from distributed.utils import get_ip

        # The workers' own: that they have started is read from their log.
        dask.config.set({"logging.distributed": "info"})
        workers = arguments.workers or 1
        host = arguments.listen or get_ip()  # type: ignore[no-untyped-call]
        spec = {
            number: {"cls": Worker, "options": {
                "address": name, "connect_options": {}, "remote_python": arguments.python or sys.executable,
                "kwargs": {"nthreads": 1, "n_workers": workers, "memory_limit": 0, "dashboard": False}}}
            for number, name in enumerate(arguments.ssh)}
        scheduler = {"cls": Scheduler, "options": {"host": host, "dashboard_address": f"{host}:0"}}
        try:
            cluster = SpecCluster(  # type: ignore[no-untyped-call]
                workers=spec, scheduler=scheduler, name="pcl_cosection_batch", silence_logs=False)
        except Exception as error:  # asyncssh has many kinds
            cause: BaseException = error
            while cause.__context__ is not None:
                cause = cause.__context__
            raise BatchError(f"--ssh {','.join(arguments.ssh)}: no worker could be started: {cause}") from None
        super().__init__(cluster, folder)


def local_workers(arguments: Arguments, items: int) -> tuple[int, int]:
    """How many workers this machine gets, and how many threads each program."""
    cores = len(os.sched_getaffinity(0))
    workers = max(1, min(arguments.workers or cores, items))
    return workers, arguments.threads or max(1, cores // workers)


def threads_of_programs(arguments: Arguments, items: int) -> tuple[int, int]:
    """The threads of each program, or 0 for a share of the worker's cores, and by how many workers these are shared."""
    if arguments.is_local:
        return local_workers(arguments, items)[1], 1
    if arguments.ssh and not arguments.threads:
        return 0, arguments.workers or 1
    return arguments.threads or 1, 1


def open_cluster(arguments: Arguments, items: int, folder: str, terminal: Terminal) -> Cluster:
    """Starts, or names, what the user wants."""
    os.makedirs(folder, exist_ok=True)
    if arguments.scheduler:
        address = arguments.scheduler
        return Cluster(address if "://" in address else "tcp://" + address, folder)
    if arguments.ssh:
        return SshHosts(arguments, folder)
    if arguments.slurm:
        from pcl_cosection_batch.slurm import SlurmJobs

        return SlurmJobs(arguments, items, folder, terminal)
    return LocalCores(local_workers(arguments, items)[0], folder)


def dashboard_of(client: Any) -> str:
    """The address of the scheduler's pages: the dashboard, or the plain ones where there is no bokeh. Nothing, if the
    scheduler has no such."""
    if "dashboard" not in client.scheduler_info().get("services", {}):
        return ""
    link = str(client.dashboard_link)
    if importlib.util.find_spec("bokeh") is None:
        link = link.removesuffix("/status") + "/info/main/workers.html"
    return link
