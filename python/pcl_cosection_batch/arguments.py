# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""The command line."""
import argparse
import math
import os
import re
import shlex
from dataclasses import dataclass, field
from typing import Callable, NoReturn, Sequence

from pcl_cosection_batch.errors import UsageError

PROGRAM = "pcl_cosection_batch"
UNITS = {"": 1, "K": 1 << 10, "M": 1 << 20, "G": 1 << 30, "T": 1 << 40}
SECONDS = {"": 1.0, "s": 1.0, "m": 60.0, "h": 3600.0}

DESCRIPTION = """\
Runs pcl_cosection on many views and pcl_cosection_fusion on many sequences, on
all cores or on a cluster. Each item gets a folder in OUTPUT, and OUTPUT an
overview, index.html, and summary.csv and summary.json. A batch that was
interrupted goes on where it was: call it again.

An INPUT is a view (.pcd, .ply), a sequence, a list file, or a folder: each view
in it is an item, and so is each sequence below it; a folder below it with views
is one item with several views of one scene. A line of a list file is an item:
one view, several views of one scene, or a folder; "NAME:" before, and "--" and
options for the program behind it, may be left out.

Options behind "--" are passed on to the programs. In them, {input} is the first
view or the sequence of an item, {folder} the folder of the views or the
sequence, {name} the name of the item."""

EPILOG = """\
Exit status: 0 all items are done, 1 something failed, 2 wrong usage, 130 or 143
interrupted."""


@dataclass
class Arguments:
    """What the user wants."""

    inputs: list[str] = field(default_factory=list)
    output: str = ""
    options: list[str] = field(default_factory=list)  # of pcl_cosection
    fusion_options: list[str] = field(default_factory=list)
    more_options: list[str] = field(default_factory=list)  # of both
    subfolders: str = "scenes"
    programs: str = ""
    only: list[str] = field(default_factory=list)
    share: tuple[int, int] = (1, 1)
    force: bool = False
    collect: bool = False
    dry_run: bool = False
    workers: int = 0
    threads: int = 0
    time_limit: float = 0.0
    memory_limit: int = 0
    retries: int = 2
    scheduler: str = ""
    ssh: list[str] = field(default_factory=list)
    slurm: bool = False
    slurm_partition: str = ""
    slurm_time: str = ""
    slurm_memory: str = ""
    slurm_options: list[str] = field(default_factory=list)
    listen: str = ""
    python: str = ""
    wait: float = 600.0
    quiet: bool = False
    verbose: bool = False

    @property
    def is_part(self) -> bool:
        """Whether only some of the items are wanted."""
        return bool(self.only) or self.share != (1, 1)

    @property
    def is_local(self) -> bool:
        """Whether all is done on this machine."""
        return not (self.scheduler or self.ssh or self.slurm)


class Parser(argparse.ArgumentParser):
    """A parser that throws."""

    def error(self, message: str) -> NoReturn:
        """Throws what is wrong, as one line."""
        raise UsageError(message[:1].lower() + message[1:])


def whole_number(lowest: int) -> Callable[[str], int]:
    """Whole numbers from LOWEST."""

    def convert(text: str) -> int:
        if not re.fullmatch(r"[0-9]{1,6}", text) or int(text) < lowest:
            raise argparse.ArgumentTypeError(f"{text!r} is not a whole number from {lowest}")
        return int(text)

    return convert


def duration(text: str) -> float:
    """Seconds: 90, 90s, 1.5m, 2h."""
    found = re.fullmatch(r"([0-9]*\.?[0-9]+)([smh]?)", text)
    seconds = float(found.group(1)) * SECONDS[found.group(2)] if found else 0.0
    if not (0 < seconds < math.inf):
        raise argparse.ArgumentTypeError(f"{text!r} is not a time, such as 90, 15m or 2h")
    return seconds


def size(text: str) -> int:
    """Bytes: 500M, 2G."""
    found = re.fullmatch(r"([0-9]*\.?[0-9]+)([KMGT]?)", text)
    count = int(float(found.group(1)) * UNITS[found.group(2)]) if found else 0
    if count < 1:
        raise argparse.ArgumentTypeError(f"{text!r} is not a size, such as 500M or 2G")
    return count


def words(text: str) -> list[str]:
    """The words of a text, quoted as in a shell."""
    try:
        return shlex.split(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(f"{text!r}: {str(error).lower()}") from None


def fraction(text: str) -> tuple[int, int]:
    """I/N."""
    found = re.fullmatch(r"([0-9]{1,6})/([0-9]{1,6})", text)
    part, whole = (int(found.group(1)), int(found.group(2))) if found else (0, 0)
    if not 1 <= part <= whole:
        raise argparse.ArgumentTypeError(f"{text!r} is not I/N with I from 1 to N")
    return part, whole


def hosts(text: str) -> list[str]:
    """Names separated by commas."""
    names = [name.strip() for name in text.split(",") if name.strip()]
    if not names:
        raise argparse.ArgumentTypeError("there are no hosts")
    return names


def add_items(parser: Parser) -> None:
    """Options that say what is done."""
    group = parser.add_argument_group("Items")
    group.add_argument("--options", metavar="TEXT", type=words, default=[], help="Options for pcl_cosection")
    group.add_argument("--fusion-options", metavar="TEXT", type=words, default=[],
                       help="Options for pcl_cosection_fusion")
    group.add_argument("--subfolders", choices=("scenes", "views"), default="scenes", metavar="scenes|views",
                       help="The views in a folder below an INPUT are one item (scenes, default), or one item each")
    group.add_argument("--programs", metavar="DIR", default="", help="Where the programs are (default: beside this "
                       "one, else in PATH)")
    group.add_argument("--only", metavar="NAME", action="append", default=[],
                       help="Only this item; repeatable. Leaves the overview as it is")
    group.add_argument("--share", metavar="I/N", type=fraction, default=(1, 1),
                       help="Only every N-th item from the I-th on, as in an array job. Leaves the overview as it is")
    group.add_argument("--force", action="store_true", help="Also do items again that are done and unchanged")
    group.add_argument("--collect", action="store_true", help="Do nothing but write the overview of what is there")
    group.add_argument("--dry-run", action="store_true", help="Print the items and their names, and do nothing")


def add_limits(parser: Parser) -> None:
    """Options that say how it is done."""
    group = parser.add_argument_group("Work")
    group.add_argument("--workers", metavar="N", type=whole_number(1), default=0,
                       help="How many items are done at a time (default: one for each core), with --ssh on each host")
    group.add_argument("--threads", metavar="N", type=whole_number(1), default=0,
                       help="Threads of each program (default: the machine's cores, divided by its workers)")
    group.add_argument("--time-limit", metavar="TIME", type=duration, default=0.0,
                       help="End a program after this time: 90, 15m, 2h")
    group.add_argument("--memory-limit", metavar="BYTES", type=size, default=0,
                       help="End a program that has more memory: 500M, 2G")
    group.add_argument("--retries", metavar="N", type=whole_number(0), default=2,
                       help="How often to try again after a crash, the time limit or the loss of a worker (default 2)")


def add_cluster(parser: Parser) -> None:
    """Options that say where it is done."""
    group = parser.add_argument_group("Cluster")
    group.add_argument("--scheduler", metavar="ADDRESS", default="", help="Use the workers of a Dask scheduler")
    group.add_argument("--ssh", metavar="HOSTS", type=hosts, default=[],
                       help="Start workers on these hosts, separated by commas, by SSH")
    group.add_argument("--slurm", action="store_true", help="Submit an array job of --workers workers by sbatch")
    group.add_argument("--slurm-partition", metavar="NAME", default="", help="Partition of the job")
    group.add_argument("--slurm-time", metavar="TIME", default="", help="Time limit of the job, as sbatch has it")
    group.add_argument("--slurm-memory", metavar="SIZE", default="", help="Memory of each worker, as sbatch has it")
    group.add_argument("--slurm-options", metavar="TEXT", type=words, default=[], help="More options for sbatch")
    group.add_argument("--listen", metavar="HOST", default="",
                       help="This machine's address that workers by SSH and Slurm connect to")
    group.add_argument("--python", metavar="PATH", default="", help="Python on those hosts (default: as here)")
    group.add_argument("--wait", metavar="TIME", type=duration, default=600.0,
                       help="How long to wait for a scheduler or for workers while there is no such (default 10m); "
                       "without limit with --slurm")


def make_parser() -> Parser:
    """All options."""
    parser = Parser(prog=PROGRAM, usage=f"{PROGRAM} [OPTIONS] INPUT [INPUT ...] OUTPUT [-- OPTIONS]",
                    description=DESCRIPTION, epilog=EPILOG, add_help=False, allow_abbrev=False,
                    formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("paths", nargs="*", help=argparse.SUPPRESS)
    add_items(parser)
    add_limits(parser)
    add_cluster(parser)
    group = parser.add_argument_group("General")
    group.add_argument("--quiet", action="store_true", help="Print errors only")
    group.add_argument("--verbose", action="store_true", help="Also print what the cluster's parts say")
    group.add_argument("--version", action="store_true", help="Print the version of the programs")
    group.add_argument("-h", "--help", action="store_true", help="Print this")
    return parser


def check(arguments: Arguments) -> None:
    """Refuses what contradicts itself. Raises UsageError."""
    places = [name for name, given in (("--scheduler", arguments.scheduler), ("--ssh", arguments.ssh),
                                       ("--slurm", arguments.slurm)) if given]
    if len(places) > 1:
        raise UsageError(f"{' and '.join(places)} exclude each other")
    if not arguments.slurm:
        for name in ("partition", "time", "memory", "options"):
            if getattr(arguments, "slurm_" + name):
                raise UsageError(f"--slurm-{name} needs --slurm")
    if arguments.scheduler and arguments.workers:
        raise UsageError("--workers has no effect with --scheduler: the scheduler has its workers")
    if arguments.collect and (arguments.is_part or arguments.force or arguments.dry_run):
        raise UsageError("--collect does no items: it excludes --only, --share, --force and --dry-run")
    if os.path.exists(arguments.output) and not os.path.isdir(arguments.output):
        raise UsageError(f"{arguments.output}: OUTPUT must be a folder")
    for path in arguments.inputs:
        if not os.path.exists(path):
            raise UsageError(f"{path}: there is no such file or folder")
        if os.path.isdir(path) and os.path.realpath(path) == os.path.realpath(arguments.output):
            raise UsageError(f"{path}: cannot be INPUT and OUTPUT")


def join_texts(argv: list[str]) -> list[str]:
    """Joins options with texts that may look like options: --options --segment becomes --options=--segment."""
    joined: list[str] = []
    for word in argv:
        if joined and joined[-1] in ("--options", "--fusion-options", "--slurm-options"):
            joined[-1] += "=" + word
        else:
            joined.append(word)
    return joined


def parse_arguments(argv: Sequence[str]) -> tuple[Arguments, Parser, str]:
    """The arguments, and "help" or "version" if that is all that is wanted. Raises UsageError."""
    own = list(argv)
    passed: list[str] = []
    if "--" in own:
        own, passed = own[:own.index("--")], own[own.index("--") + 1:]
    parser = make_parser()
    given = vars(parser.parse_intermixed_args(join_texts(own)))
    asked = next((name for name in ("help", "version") if given[name]), "")
    paths = given["paths"]
    arguments = Arguments(more_options=passed, **{
        name: value for name, value in given.items() if name not in ("paths", "help", "version")})
    if asked:
        return arguments, parser, asked
    if len(paths) < 2:
        raise UsageError("there must be an INPUT and an OUTPUT; --help shows how")
    arguments.inputs, arguments.output = paths[:-1], paths[-1]
    check(arguments)
    return arguments, parser, ""
