#!/usr/bin/env python3
"""Attacks the programs of a build: kills them at random times, and runs them where nothing can be written.

Usage: hostile_machine.py BUILD [KILLS] [--seed N]      exit status 0: no violation, 1: some, 2: wrong usage

Each program runs on small simulated inputs.

* KILLS (default: 1000) runs get SIGKILL, SIGTERM or SIGHUP, half of them at a random time, half of them while they
  write. Then each output that is there is whole, and after a run that is not disturbed no temporary file is left.
* Each program runs on a full and a nearly full disk (needs root, to mount a tmpfs), with files that cannot grow, with
  its standard output or its standard error closed, full, or a pipe that nobody reads, in a folder that may only be
  read, where no more threads can be made, and with little memory. The exit status is 1 and standard error has one line beside warnings, unless all was delivered. Nothing that is
  not whole is left, and no temporary file.
"""
import collections
import json
import os
import pathlib
import random
import re
import resource
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree
import zlib

TIMEOUT_S = 60
KILLS_BETWEEN_RUNS = 5
FILE_LIMIT = 100  # bytes; every program has an output that is larger
NEARLY_FULL_KIB = 8
NOBODY = 65534
CANNOT_BE_LOADED = 127  # the system's loader says so

SCENE = {
    "frames": 4,
    "rate": 10,
    "camera": {"width": 160, "height": 120, "fx": 150, "fy": 150, "cx": 79.5, "cy": 59.5, "keys": [
        {"position": [0, -0.5, 0.35], "look_at": [0, 0, 0.03]},
        {"time": 0.1, "position": [0.02, -0.5, 0.36], "look_at": [0, 0, 0.03]},
        {"time": 0.2, "position": [0.02, -0.48, 0.34], "look_at": [0, 0, 0.03]},
        {"time": 0.3, "position": [0.05, -0.5, 0.35], "look_at": [0, 0, 0.03]}]},
    "views": {"every": 2},
    "background": {"parts": [{"type": "box", "size": [0.8, 0.8, 0.02], "position": [0, 0, -0.01]}]},
    "objects": [
        {"name": "ball", "shape": {"type": "sphere", "radius": 0.06}, "keys": [{"position": [-0.1, 0, 0.06]}]},
        {"name": "box", "shape": {"type": "box", "size": [0.1, 0.1, 0.1]}, "keys": [{"position": [0.1, 0, 0.05]}]}]}


class Case:
    """A command line that writes to the folder OUT; inputs are in DATA and RUN."""

    def __init__(self, name, words):
        self.name = name
        self.words = words
        self.prints = True  # something on standard output
        self.seconds = 0.0
        self.outputs = {}  # of a run that is not disturbed: name and size

    def command(self, build, inputs, out):
        places = {"DATA": inputs / "data", "RUN": inputs / "run", "SCENE": inputs / "scene.json", "OUT": out}
        words = self.words.split()
        for name, place in places.items():
            words = [re.sub(rf"\b{name}\b", str(place), word) for word in words]
        return [str(build / "bin" / words[0]), *words[1:], *([] if words[-1] in TEXTS else ["--threads", "1"])]


FUSE = ("--resolution 16 --background-voxel-size 0.05 --camera-trajectory DATA/gt-cam-0.txt --masks DATA/mask --object-trajectory "
        "1=DATA/gt-ball-1.txt --object-trajectory 2=DATA/gt-box-2.txt")
CASES = [
    Case("complete", "pcl_cosection --resolution 16 --json OUT/c.json DATA/views/View0000.pcd OUT/objects"),
    Case("complete one file", "pcl_cosection --resolution 12 --no-planes --json OUT/c.json RUN/one.pcd OUT/one.ply"),
    Case("segment", "pcl_cosection_segment --json OUT/s.json DATA/views/View0000.pcd OUT/s.pcd"),
    Case("simulate", "pcl_cosection_simulate --json OUT/sim.json SCENE OUT/data"),
    Case("simulate tables", "pcl_cosection_simulate --json OUT/sim.json --meshes DATA/gt-mesh --scenes 1 OUT/scenes"),
    Case("fusion", f"pcl_cosection_fusion {FUSE} --save-keyframes --json OUT/f.json DATA OUT/run"),
    Case("export", "pcl_cosection_export --format mjcf --format urdf --format gltf --format usda RUN OUT/scene"),
    Case("report", "pcl_cosection_report -o OUT/report.html RUN"),
    Case("evaluate mesh", "pcl_cosection_evaluate mesh --samples 200 --json OUT/m.json --csv OUT/m.csv --error-mesh "
                          "OUT/m.ply RUN/mesh/object_1.ply RUN/mesh/object_1.ply"),
    Case("evaluate picture", "pcl_cosection_evaluate mesh --samples 200 --error-picture OUT/m.png "
                             "RUN/mesh/object_1.ply RUN/mesh/object_1.ply"),
    Case("evaluate run", "pcl_cosection_evaluate run --samples 200 --json OUT/e.json --csv OUT/e.csv RUN DATA"),
    Case("evaluate trajectory", "pcl_cosection_evaluate trajectory --json OUT/t.json --csv OUT/t.csv "
                                "DATA/gt-cam-0.txt RUN/trajectory/camera.txt"),
    Case("viewer picture", "pcl_cosection_viewer --size 160x120 --screenshot OUT/v.png RUN"),
    Case("viewer record", "pcl_cosection_viewer --size 160x120 --record OUT/frames RUN"),
]
TEXTS = ("--help", "--version", "--list-presets", "table")
TEXT_CASES = [Case(f"{program[12:]} {text}".strip(), f"{program} {text}")
              for program in ("pcl_cosection", "pcl_cosection_segment", "pcl_cosection_simulate", "pcl_cosection_fusion",
                              "pcl_cosection_report", "pcl_cosection_evaluate", "pcl_cosection_export", "pcl_cosection_viewer")
              for text in ("--help", "--version")]
TEXT_CASES += [Case("simulate --list-presets", "pcl_cosection_simulate --list-presets"),
               Case("simulate --print-preset", "pcl_cosection_simulate --print-preset table")]


# --- Whether a file is whole ----------------------------------------------------------------------------------------

SIZES = {"char": "b", "uchar": "B", "short": "h", "ushort": "H", "int": "i", "uint": "I", "float": "f", "double": "d",
         "int8": "b", "uint8": "B", "int16": "h", "uint16": "H", "int32": "i", "uint32": "I", "float32": "f",
         "float64": "d"}


def require(holds, what):
    if not holds:
        raise ValueError(what)


def check_ply(data):
    header, separator, body = data.partition(b"end_header\n")
    require(header.startswith(b"ply") and separator, "no PLY header")
    elements = []
    for line in header.decode().split("\n"):
        words = line.split()
        if words[:1] == ["element"]:
            elements.append((int(words[2]), []))
        elif words[:1] == ["property"]:
            elements[-1][1].append(words[1:])
    if b"format ascii" in header:
        require(len(body.split(b"\n")) - 1 == sum(count for count, _ in elements), "lines are missing")
        return
    place = 0
    for count, properties in elements:
        if all(words[0] != "list" for words in properties):
            place += count * sum(struct.calcsize(SIZES[words[0]]) for words in properties)
            continue
        for _ in range(count):
            for words in properties:
                if words[0] != "list":
                    place += struct.calcsize(SIZES[words[0]])
                    continue
                (length,) = struct.unpack_from("<" + SIZES[words[1]], body, place)
                place += struct.calcsize(SIZES[words[1]]) + length * struct.calcsize(SIZES[words[2]])
    require(place == len(body), f"{len(body)} bytes instead of {place}")


def check_pcd(data):
    header, separator, body = data.partition(b"\nDATA ")
    require(separator, "no PCD header")
    fields = {line.split()[0]: line.split()[1:] for line in header.decode().split("\n") if line and line[0] != "#"}
    kind, _, points = body.partition(b"\n")
    count = int(fields["POINTS"][0])
    size = count * sum(int(s) * int(c) for s, c in zip(fields["SIZE"], fields["COUNT"]))
    if kind == b"binary":
        require(len(points) == size, f"{len(points)} bytes instead of {size}")
    elif kind == b"binary_compressed":
        packed, unpacked = struct.unpack_from("<II", points)
        require(len(points) == 8 + packed and unpacked == size, "compressed points are cut")
    else:
        require(points.count(b"\n") == count, "lines are missing")


def check_png(data):
    require(data.startswith(b"\x89PNG\r\n\x1a\n"), "no PNG")
    place = 8
    while True:
        length, name = struct.unpack_from(">I4s", data, place)
        (checksum,) = struct.unpack_from(">I", data, place + 8 + length)
        require(checksum == zlib.crc32(data[place + 4:place + 8 + length]), "a wrong checksum")
        place += 12 + length
        if name == b"IEND":
            require(place == len(data), "bytes behind the end")
            return


def check_text(data):
    require(data.endswith(b"\n"), "the last line is cut")


def check_obj(data):
    check_text(data)
    kinds = collections.Counter(line.partition(b" ")[0] for line in data.split(b"\n"))
    largest = max(int(word.partition(b"/")[0]) for line in data.split(b"\n") if line.startswith(b"f ")
                  for word in line.split()[1:])
    require(kinds[b"v"] == largest, "the last vertex has no face, or a face no vertex")


def check_glb(data):
    magic, _, length = struct.unpack_from("<4sII", data)
    require(magic == b"glTF" and length == len(data), "not as long as its header says")


CHECKS = {".ply": check_ply, ".pcd": check_pcd, ".png": check_png, ".txt": check_text, ".csv": check_text,
          ".json": lambda data: json.loads(data.decode()), ".obj": check_obj, ".glb": check_glb,
          ".urdf": xml.etree.ElementTree.fromstring, ".xml": xml.etree.ElementTree.fromstring,
          ".usda": lambda data: require(data.count(b"{") == data.count(b"}") > 0, "a block is open"),
          ".html": lambda data: require(data.endswith(b"</body></html>\n"), "the page is cut")}


def files_in(folder):
    return sorted(path for path in folder.rglob("*") if path.is_file())


def is_hidden(path, folder):
    return any(part.startswith(".") for part in path.relative_to(folder).parts)


def torn_files(folder):
    """A line for each file that is not whole, but for temporary ones."""
    lines = []
    for path in files_in(folder):
        if is_hidden(path, folder):
            continue
        try:
            CHECKS[path.suffix](path.read_bytes())
        except Exception as error:  # whatever stands in the way of reading it
            lines.append(f"{path.relative_to(folder)} is torn: {error!r}")
    return lines


def temporaries(folder):
    found = []
    for place, folders, files in os.walk(folder):  # which a running program changes
        found += [pathlib.Path(place, name).relative_to(folder) for name in folders + files if name.startswith(".")]
    return [f"{path} is left" for path in sorted(found)]


# --- Running --------------------------------------------------------------------------------------------------------

class Attack:
    def __init__(self, build, work, seed):
        self.build = build
        self.work = work
        self.inputs = work / "inputs"
        self.random = random.Random(seed)
        self.violations = 0
        self.left_out = []

    def violation(self, text):
        self.violations += 1
        print("VIOLATION: " + text, flush=True)

    def run(self, command, **given):
        options = {"stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **given}
        return subprocess.run(command, timeout=TIMEOUT_S, check=False, **options)

    def make_inputs(self):
        self.inputs.mkdir()
        (self.inputs / "scene.json").write_text(json.dumps(SCENE))
        data, run = self.inputs / "data", self.inputs / "run"
        scene = Case("", "pcl_cosection_simulate SCENE DATA").command(self.build, self.inputs, self.work)
        fusion = Case("", f"pcl_cosection_fusion {FUSE} DATA RUN").command(self.build, self.inputs, self.work)
        for command in (scene, fusion):
            done = self.run(command)
            if done.returncode != 0:
                raise SystemExit(f"{' '.join(command)}\n{done.stderr.decode()}")
        cloud = "\n".join(f"{0.1 * x / n:.5f} {0.1 * y / n:.5f} {0.5 + 0.1 * z / n:.5f}" for x, y, z, n in ball())
        count = len(ball())
        (run / "one.pcd").write_text("VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n"
                                     f"WIDTH {count}\nHEIGHT 1\nPOINTS {count}\nDATA ascii\n{cloud}\n")
        for path in [self.inputs, *self.inputs.rglob("*")]:
            path.chmod(0o755 if path.is_dir() else 0o644)
        assert data.is_dir()

    def new_folder(self, place=None):
        folder = (place or self.work) / "out"
        if folder.exists():
            shutil.rmtree(folder)
        folder.mkdir()
        return folder

    def measure(self, case):
        """How long a run takes, what it writes and that nothing is wrong with it."""
        out = self.new_folder()
        start = time.monotonic()
        done = self.run(case.command(self.build, self.inputs, out))
        case.seconds = time.monotonic() - start
        case.outputs = {str(path.relative_to(out)): path.stat().st_size for path in files_in(out)}
        case.prints = bool(done.stdout)
        if done.returncode != 0 or not case.outputs:
            raise SystemExit(f"{case.name}: {done.returncode} {done.stderr.decode()}")
        for line in torn_files(out) + temporaries(out):
            self.violation(f"{case.name}, not disturbed: {line}")

    # --- Kills

    def wait_for_moment(self, case, process, out):
        """Half of the kills come at a random time, the others while a temporary file is there."""
        end = time.monotonic() + self.random.uniform(0.0, 1.1 * case.seconds)
        if self.random.random() < 0.5:
            while process.poll() is None and time.monotonic() < end:
                time.sleep(0.001)
            return
        old = set(temporaries(out))
        while process.poll() is None and set(temporaries(out)) <= old:
            pass
        time.sleep(self.random.uniform(0.0, 0.001))

    def kill_once(self, case, out):
        """How it ended."""
        number = self.random.choice([signal.SIGKILL, signal.SIGKILL, signal.SIGTERM, signal.SIGHUP])
        with open(self.work / "errors", "w+b") as errors:
            process = subprocess.Popen(case.command(self.build, self.inputs, out), stdin=subprocess.DEVNULL,
                                       stdout=subprocess.DEVNULL, stderr=errors)
            self.wait_for_moment(case, process, out)
            process.send_signal(number)
            try:
                status = process.wait(timeout=TIMEOUT_S)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
                self.violation(f"{case.name} goes on after {number.name}")
                return "hung"
            if status not in (0, 130, -number):
                errors.seek(0)
                said = errors.read().decode(errors="replace").strip()
                self.violation(f"{case.name} after {number.name}: status {status}: {said}")
        return "finished" if status == 0 else "stopped" if status == 130 else "killed"

    @staticmethod
    def clear_new_folder(case, out):
        """pcl_cosection_simulate writes into new folders alone."""
        if case.name.startswith("simulate"):
            for name in ("data", "scenes"):
                shutil.rmtree(out / name, ignore_errors=True)

    def check_new_folder(self, case, out):
        """A folder that is made at once has all of its files, or is not there."""
        there = {str(path.relative_to(out)) for path in files_in(out)}
        folders = {name.split("/")[0] for name in there if "/" in name}
        for name in sorted(set(case.outputs) - there):
            if name.split("/")[0] in folders:
                self.violation(f"{case.name}, killed: {name} is missing in its folder")

    def kill(self, case, kills):
        out = self.new_folder()
        ends = {}
        left = 0
        for n in range(1, kills + 1):
            self.clear_new_folder(case, out)
            end = self.kill_once(case, out)
            ends[end] = ends.get(end, 0) + 1
            left += bool(temporaries(out))
            for line in torn_files(out):
                self.violation(f"{case.name}, killed: {line}")
            if case.name.startswith("simulate"):
                self.check_new_folder(case, out)
            if n % KILLS_BETWEEN_RUNS == 0 or n == kills:
                self.clear_new_folder(case, out)
                done = self.run(case.command(self.build, self.inputs, out))
                if done.returncode != 0:
                    self.violation(f"{case.name} after kills: status {done.returncode} {done.stderr.decode()}")
                for line in torn_files(out) + temporaries(out):
                    self.violation(f"{case.name}, after a run that followed kills: {line}")
        print(f"{case.name:23} {kills:4} runs of {case.seconds:.2f} s: "
              + ", ".join(f"{count} {end}" for end, count in sorted(ends.items()))
              + f"; temporary files after {left}", flush=True)

    # --- Where nothing can be written

    def judge(self, case, condition, done, out, may_succeed):
        """Print a line of the table. done.stderr is None: it was not to be seen."""
        errors = None if done.stderr is None else done.stderr.decode(errors="replace")
        lines = [line for line in (errors or "").splitlines() if ": warning: " not in line]
        faults = torn_files(out) + temporaries(out)
        whole = {str(path.relative_to(out)) for path in files_in(out)} >= set(case.outputs)
        if done.returncode == 0:
            if not may_succeed:
                faults.append("the status is 0")
            if not whole and not (errors and ": warning: " in errors):
                faults.append("the status is 0, but outputs are missing")
        elif done.returncode != 1:
            faults.append("the status is not 1")
        elif errors is not None and (len(lines) != 1 or ": error: " not in lines[0]):
            faults.append(f"standard error has {len(lines)} lines beside warnings")
        text = (lines[0] if lines else "").replace(str(self.work), "...")
        print(f"{case.name:23} {condition:20} {done.returncode:3}  {text[:150]}", flush=True)
        for fault in faults:
            self.violation(f"{case.name}, {condition}: {fault}" + "".join(f"\n    {line}" for line in lines[1:6]))

    def on_full_disk(self, case, free_kib):
        disk = self.work / "disk"
        disk.mkdir(exist_ok=True)
        mounted = self.run(["mount", "-t", "tmpfs", "-o", "size=64k", "tmpfs", str(disk)])
        if mounted.returncode != 0:
            self.left_out.append("a full disk: a tmpfs cannot be mounted")
            return
        try:
            out = self.new_folder(disk)
            (disk / "filling").write_bytes(b"x" * (1024 * (64 - free_kib)))
            condition = "full disk" if free_kib == 0 else f"{free_kib} KiB left"
            may_succeed = sum(case.outputs.values()) <= 1024 * free_kib
            done = self.run(case.command(self.build, self.inputs, out))
            self.judge(case, condition, done, out, may_succeed)
        finally:
            self.run(["umount", str(disk)])

    def with_small_files(self, case):
        out = self.new_folder()
        done = self.run(case.command(self.build, self.inputs, out),
                        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (FILE_LIMIT, FILE_LIMIT)))
        self.judge(case, f"files of {FILE_LIMIT} bytes", done, out, max(case.outputs.values()) <= FILE_LIMIT)

    def with_streams(self, case):
        """Standard output that takes nothing, and standard error."""
        out = self.new_folder()
        command = case.command(self.build, self.inputs, out)
        self.judge(case, "output closed", self.run(command, stdout=None, preexec_fn=lambda: os.close(1)), out,
                   not case.prints)
        with open("/dev/full", "wb") as full:
            out = self.new_folder()
            self.judge(case, "output full", self.run(command, stdout=full), out, not case.prints)
            out = self.new_folder()
            done = self.run(command, stderr=full)
            self.judge(case, "errors full", done, out, True)
        reading, writing = os.pipe()
        os.close(reading)
        out = self.new_folder()
        self.judge(case, "output a closed pipe", self.run(command, stdout=writing), out, not case.prints)
        os.close(writing)
        out = self.new_folder()
        done = self.run(command, stderr=None, preexec_fn=lambda: os.close(2))
        self.judge(case, "errors closed", done, out, True)
        out = self.new_folder()
        done = self.run(command, stdin=None, stdout=None, stderr=None, preexec_fn=lambda: os.closerange(0, 3))
        self.judge(case, "all streams closed", done, out, not case.prints)

    def in_read_only_folder(self, case):
        out = self.new_folder()
        out.chmod(0o555)
        user = {"user": NOBODY, "group": NOBODY, "extra_groups": []} if os.geteuid() == 0 else {}
        try:
            done = self.run(case.command(self.build, self.inputs, out), **user)
        except PermissionError as error:
            self.left_out.append(f"a folder that may only be read: {error}")
            return
        self.judge(case, "read-only folder", done, out, False)
        out.chmod(0o755)

    def with_few_threads(self, case):
        """Four threads are asked for; one, or two, can be made."""
        command = [*case.command(self.build, self.inputs, self.new_folder())[:-1], "4"]
        if os.geteuid() != 0:
            self.left_out.append("few threads: only root can become a user without processes")
            return
        for more in (0, 1):
            out = self.new_folder()
            out.chmod(0o777)

            def become_nobody(limit=1 + more):
                resource.setrlimit(resource.RLIMIT_NPROC, (limit, limit))
                os.setgroups([])
                os.setgid(NOBODY)
                os.setuid(NOBODY)

            try:
                done = self.run(command, preexec_fn=become_nobody)
            except (PermissionError, subprocess.SubprocessError) as error:
                self.left_out.append(f"few threads: {error}")
                return
            self.judge(case, f"{more} more threads", done, out, True)

    def with_little_memory(self, case):
        """Limits of address space, for four threads."""
        for mib in (150, 250, 350, 500, 700):
            out = self.new_folder()
            command = [*case.command(self.build, self.inputs, out)[:-1], "4"]
            limit = mib * 1024 * 1024
            done = self.run(command, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)))
            if done.returncode != CANNOT_BE_LOADED:
                self.judge(case, f"{mib} MiB", done, out, True)

    def refuse_everything(self, case):
        self.on_full_disk(case, 0)
        self.on_full_disk(case, NEARLY_FULL_KIB)
        self.with_small_files(case)
        self.with_streams(case)
        self.in_read_only_folder(case)
        self.with_few_threads(case)
        self.with_little_memory(case)


def ball():
    """Directions all over a sphere, and their lengths."""
    steps = range(-6, 7)
    points = [(x, y, z) for x in steps for y in steps for z in steps if max(abs(x), abs(y), abs(z)) == 6]
    return [(x, y, z, (x * x + y * y + z * z) ** 0.5) for x, y, z in points]


def kills_of(cases, kills):
    """How many each gets: slow ones fewer."""
    weights = [case.seconds ** -0.5 for case in cases]
    shares = [int(kills * weight / sum(weights)) for weight in weights]
    shares[0] += kills - sum(shares)
    return shares


def attack(build, kills, seed, work):
    work.chmod(0o755)
    attacker = Attack(build, work, seed)
    attacker.make_inputs()
    for case in CASES:
        attacker.measure(case)
    print("program                 condition        status  standard error", flush=True)
    for case in CASES:
        attacker.refuse_everything(case)
    for case in TEXT_CASES:
        attacker.with_streams(case)
    for case, share in zip(CASES, kills_of(CASES, kills)):
        if share > 0:
            attacker.kill(case, share)
    for line in sorted(set(attacker.left_out)):
        print("left out: " + line)
    print(f"{kills} kills, {attacker.violations} violations")
    return 1 if attacker.violations > 0 else 0


def main(words):
    seed = 1
    if len(words) > 2 and words[-2] == "--seed":
        seed = int(words[-1])
        words = words[:-2]
    if "--help" in words:
        print(__doc__)
        return 0
    if len(words) not in (1, 2) or not (pathlib.Path(words[0]) / "bin" / "pcl_cosection").exists():
        print(__doc__, file=sys.stderr)
        return 2
    with tempfile.TemporaryDirectory(prefix="hostile_machine_") as work:
        return attack(pathlib.Path(words[0]).resolve(), int(words[1]) if len(words) > 1 else 1000, seed,
                      pathlib.Path(work))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
