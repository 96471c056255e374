#!/usr/bin/env python3
"""Runs clang-tidy, with the checks of .clang-tidy, on the sources of the libraries, and fails if it finds anything.

Usage: run_clang_tidy.py BUILD [FILE...]    BUILD has compile_commands.json; without FILE, all sources of the libraries

A source that passed is not looked at again before it, a header or .clang-tidy has changed.
"""
import concurrent.futures
import hashlib
import json
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent


def digest(paths):
    sha = hashlib.sha256()
    for path in sorted(paths):
        sha.update(str(path.relative_to(ROOT)).encode())
        sha.update(path.read_bytes())
    return sha.hexdigest()


def main():
    if len(sys.argv) < 2 or sys.argv[1].startswith("-"):
        print(__doc__)
        return 0 if sys.argv[1:] == ["--help"] else 2
    build = pathlib.Path(sys.argv[1])
    with open(build / "compile_commands.json") as file:
        compiled = {pathlib.Path(entry["file"]).resolve() for entry in json.load(file)}
    sources = [pathlib.Path(name).resolve() for name in sys.argv[2:]]
    if not sources:
        sources = sorted(path for path in compiled if ROOT / "pcl_cosection" in path.parents)
    headers = [*ROOT.glob("include/**/*.h*"), *ROOT.glob("pcl_cosection/**/*.h"), ROOT / ".clang-tidy"]
    common = digest(headers)
    stamps = build / "clang_tidy"
    stamps.mkdir(exist_ok=True)

    def check(source):
        stamp = stamps / hashlib.sha256((common + digest([source])).encode()).hexdigest()
        if stamp.exists():
            return ""
        run = subprocess.run(["clang-tidy", "-p", str(build), "--quiet", "--warnings-as-errors=*", str(source)],
                             capture_output=True, text=True)
        if run.returncode == 0:
            stamp.touch()
            return ""
        return run.stdout or run.stderr

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        findings = [finding for finding in pool.map(check, sources) if finding]
    print("\n".join(findings))
    print(f"clang-tidy: {len(findings)} of {len(sources)} sources have findings")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
