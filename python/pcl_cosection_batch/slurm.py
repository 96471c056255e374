# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""Workers as an array job of Slurm. The scheduler is in this process."""
import os
import shlex
import subprocess
import sys
import time

from pcl_cosection_batch.arguments import Arguments
from pcl_cosection_batch.clusters import OwnCluster
from pcl_cosection_batch.errors import BatchError
from pcl_cosection_batch.terminal import Terminal

COMMAND_TIMEOUT_S = 60
LOOK_EVERY_S = float(os.environ.get("PCL_COSECTION_BATCH_SLURM_LOOK_S", "30"))
WORKER_LOOKS_FOR_SCHEDULER_S = 120


def job_script(arguments: Arguments, scheduler_file: str, workers: int, log: str) -> str:
    """The script that sbatch gets: each task of the array is a worker."""
    settings = {"job-name": "pcl_cosection_batch", "array": f"1-{workers}", "output": log, "open-mode": "append",
                "cpus-per-task": str(arguments.threads or 1)}
    for name, value in (("partition", arguments.slurm_partition), ("time", arguments.slurm_time),
                        ("mem", arguments.slurm_memory)):
        if value:
            settings[name] = value
    command = [arguments.python or sys.executable, "-m", "distributed.cli.dask_worker", "--scheduler-file",
               scheduler_file, "--nthreads", "1", "--nworkers", "1", "--memory-limit", "0", "--no-dashboard",
               "--death-timeout", str(WORKER_LOOKS_FOR_SCHEDULER_S)]
    lines = [f"#SBATCH --{name}={shlex.quote(value)}" for name, value in settings.items()]
    return "\n".join(["#!/bin/sh", *lines, "exec " + shlex.join(command) + ' --local-directory "${TMPDIR:-/tmp}"', ""])


def run_command(command: list[str]) -> str:
    """What a command of Slurm prints. Raises BatchError."""
    try:
        run = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, check=False,
                             timeout=COMMAND_TIMEOUT_S)
    except (OSError, subprocess.TimeoutExpired) as error:
        raise BatchError(f"{command[0]}: cannot be run: {getattr(error, 'strerror', None) or 'no answer'}") from None
    if run.returncode:
        said = run.stderr.decode(errors="replace").strip().splitlines()
        raise BatchError(f"{command[0]}: " + (said[-1] if said else f"exit status {run.returncode}"))
    return run.stdout.decode(errors="replace").strip()


class SlurmJobs(OwnCluster):
    """An array job with a worker in each task. It is submitted again when it has ended and items are left."""

    waits_for_ever = True

    def __init__(self, arguments: Arguments, items: int, folder: str, terminal: Terminal) -> None:
        from distributed import LocalCluster
        from distributed.utils import get_ip

        self.terminal = terminal
        self.options = arguments.slurm_options
        host = arguments.listen or get_ip()  # type: ignore[no-untyped-call]
        super().__init__(LocalCluster(  # type: ignore[no-untyped-call]
            n_workers=0, host=host, dashboard_address=f"{host}:0", silence_logs=False), folder)
        scheduler_file = os.path.join(folder, "scheduler.json")
        self.script = os.path.join(folder, "workers.sh")
        workers = max(1, min(arguments.workers or items, items))
        logs = os.path.join(os.path.dirname(os.path.dirname(folder)), "slurm.log")
        self.job = ""
        self.looked = 0.0
        try:
            self.cluster.scheduler.scheduler_file = scheduler_file
            write_scheduler_file(scheduler_file, self.cluster)
            with open(self.script, "w", encoding="utf-8", errors="surrogateescape") as file:
                file.write(job_script(arguments, scheduler_file, workers, logs))
            self._submit()
        except BaseException:
            self.close()
            raise

    def _submit(self) -> None:
        self.job = run_command(["sbatch", "--parsable", *self.options, self.script]).split(";")[0]
        self.looked = time.monotonic()
        self.terminal.note(f"submitted job {self.job} to Slurm")

    def look_after(self, workers: int) -> None:
        """Submits the job again, if it has ended."""
        if workers or time.monotonic() - self.looked < LOOK_EVERY_S:
            return
        self.looked = time.monotonic()
        try:
            waiting = run_command(["squeue", "--noheader", "--format=%i", f"--jobs={self.job}"])
        except BatchError:
            waiting = ""  # Slurm does not know jobs for long that have ended
        if not waiting:
            self._submit()

    def close(self) -> None:
        """Ends scheduler, workers and the job."""
        if self.job:
            try:
                run_command(["scancel", self.job])
            except BatchError as error:
                self.terminal.note(str(error))
        super().close()


def write_scheduler_file(path: str, cluster: object) -> None:
    """What dask-worker --scheduler-file reads."""
    from pcl_cosection_batch.store import write_json

    write_json(path, cluster.scheduler.identity())  # type: ignore[attr-defined]
