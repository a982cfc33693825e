#!/usr/bin/env python3
"""Do the tests notice a wrong line? Changes one line at a time in a copy of the tree, builds, and runs the named tests.

    tests/mutate.py                       all changes of tests/mutations.txt
    tests/mutate.py --only WORD           those with WORD in their title, file or tests
    tests/mutate.py --check               only looks whether every line is there

The copy and its build folder stay in --scratch (default: gim-mutate in the folder for temporary files), so that the next
run builds only what has changed; ccache is used where there is one. The tree itself is never written to.

A change in mutations.txt is a block of lines; blank lines separate blocks, # begins a comment:

    PSNR is taken from one direction only           what is wrong with it
    @ compare.cpp                                   the file's name, without folders; may be left out
    - result.rms = std::max(to_test.rms, b.rms);    the line, without the blanks around it
    + result.rms = to_test.rms;                     what stands there instead
    ! encoder_test Compare.*                        program and filter of the tests that should fail; one or more lines

The line must be there exactly once: in the files of that name, or without a name in all of format/, decoder/, encoder/,
corpus/ and tools/. Otherwise nothing is run, exit status 2. First the tests must pass without any change. A change is
noticed when a test fails, crashes or runs longer than --timeout. Exit status 0: all were noticed; 1: some were not.
"""
import argparse
import filecmp
import os
import re
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

TREE = Path(__file__).resolve().parent.parent
SOURCES = ("format", "decoder", "encoder", "corpus", "tools")


@dataclass
class Change:
    title: str
    name: str = ""
    old: str = ""
    new: str = ""
    tests: list = field(default_factory=list)  # (program, filter)
    file: str = ""  # relative to the tree
    number: int = 0  # of the line, from 1

    def matches(self, word):
        return not word or word in self.title or word in self.file or any(word in " ".join(t) for t in self.tests)


def fail(message):
    print("mutate.py: " + message, file=sys.stderr)
    sys.exit(2)


def read_changes(path):
    changes = []
    for block in re.split(r"\n\s*\n", path.read_text()):
        lines = [line.strip() for line in block.splitlines() if line.strip() and not line.startswith("#")]
        if not lines:
            continue
        change = Change(lines[0])
        for line in lines[1:]:
            mark, rest = line[0], line[1:].strip()
            if mark == "@":
                change.name = rest
            elif mark == "-":
                change.old = rest
            elif mark == "+":
                change.new = rest
            elif mark == "!" and len(rest.split()) == 2:
                change.tests.append(tuple(rest.split()))
            else:
                fail(f"{path.name}: do not understand '{line}'")
        if not change.old or not change.tests:
            fail(f"{path.name}: '{change.title}' needs a line to change and tests")
        changes.append(change)
    return changes


def locate(changes):
    """Sets file and number of each change."""
    where = {}  # stripped line -> [(file, number)]
    for folder in SOURCES:
        for path in sorted((TREE / folder).rglob("*")):
            if path.suffix in (".cpp", ".h"):
                for number, line in enumerate(path.read_text().splitlines(), 1):
                    where.setdefault(line.strip(), []).append((path.relative_to(TREE), number))
    wrong = []
    for change in changes:
        found = [place for place in where.get(change.old, []) if change.name in ("", place[0].name)]
        if len(found) == 1:
            change.file, change.number = str(found[0][0]), found[0][1]
        else:
            wrong.append(f"'{change.title}': the line is there {len(found)} times: {change.old}")
    if wrong:
        fail("\n".join(wrong))


def copy_tree(scratch):
    """Files that git knows or would add. Equal ones keep their time, so that nothing is built twice."""
    listed = subprocess.run(["git", "ls-files", "-coz", "--exclude-standard"], cwd=TREE, check=True, text=True,
                            capture_output=True).stdout.split("\0")
    wanted = {name for name in listed if name and (TREE / name).is_file()}
    for name in wanted:
        target = scratch / name
        if not target.exists() or not filecmp.cmp(TREE / name, target, shallow=False):
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(TREE / name, target)
    for path in list(scratch.rglob("*")):
        name = path.relative_to(scratch)
        if name.parts[0] != "build" and path.is_file() and str(name) not in wanted:
            path.unlink()


class Builder:
    def __init__(self, scratch, jobs):
        self.folder, self.jobs = scratch / "build" / "release", jobs
        command = ["cmake", "-G", "Ninja", "-S", str(scratch), "-B", str(self.folder), "-DCMAKE_BUILD_TYPE=Release"]
        if shutil.which("ccache"):
            command += ["-DCMAKE_C_COMPILER_LAUNCHER=ccache", "-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode != 0:
            fail("cmake failed:\n" + done.stderr)

    def build(self, programs):
        """None, or what the compiler said."""
        command = ["cmake", "--build", str(self.folder), "-j", str(self.jobs), "--target", *sorted(programs)]
        done = subprocess.run(command, capture_output=True, text=True)
        return None if done.returncode == 0 else done.stdout + done.stderr

    def run(self, program, filter, timeout):
        """What was noticed; empty where all tests passed."""
        command = [str(self.folder / "tests" / program), "--gtest_filter=" + filter, "--gtest_fail_fast"]
        try:
            done = subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=timeout)
        except subprocess.TimeoutExpired:
            return f"{program} ran for more than {timeout} s"
        if re.search(r"Running 0 tests", done.stdout):
            fail(f"{program} has no test '{filter}'")
        if done.returncode == 0:
            return ""
        failed = re.search(r"\[  FAILED  \] (\S+)", done.stdout)
        return failed.group(1).rstrip(",") if failed else f"{program} ended with status {done.returncode}"


def with_change(text, change):
    lines = text.split("\n")
    old = lines[change.number - 1]
    if old.strip() != change.old:
        fail(f"{change.file} changed while this ran")
    lines[change.number - 1] = old[:len(old) - len(old.lstrip())] + change.new
    return "\n".join(lines)


def attempt(builder, scratch, change, timeout):
    """(noticed | not noticed | did not build, details)"""
    path = scratch / change.file
    before = path.read_text()
    path.write_text(with_change(before, change))
    try:
        complaint = builder.build({program for program, _ in change.tests})
        if complaint is not None:
            return "did not build", complaint
        for program, filter in change.tests:
            seen = builder.run(program, filter, timeout)
            if seen:
                return "noticed", seen
        return "not noticed", ""
    finally:
        path.write_text(before)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="", metavar="WORD")
    parser.add_argument("--check", action="store_true", help="look only whether every line is there exactly once")
    parser.add_argument("--list", type=Path, default=TREE / "tests" / "mutations.txt", metavar="FILE")
    parser.add_argument("--scratch", type=Path, default=Path(tempfile.gettempdir()) / "gim-mutate", metavar="FOLDER")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--timeout", type=int, default=300, metavar="SECONDS", help="of one run of tests")
    arguments = parser.parse_args()

    changes = read_changes(arguments.list)
    locate(changes)
    changes = [change for change in changes if change.matches(arguments.only)]
    if arguments.check or not changes:
        print(f"{len(changes)} changes, each line is there once")
        return 0
    scratch = arguments.scratch.resolve()
    if scratch == TREE or scratch in TREE.parents:
        fail("--scratch is the tree itself or a folder around it")
    scratch.mkdir(parents=True, exist_ok=True)
    copy_tree(scratch)
    builder = Builder(scratch, arguments.jobs)
    tests = sorted({test for change in changes for test in change.tests})
    complaint = builder.build({program for program, _ in tests})
    if complaint is not None:
        fail("the tree does not build:\n" + complaint)
    for program, filter in tests:
        seen = builder.run(program, filter, arguments.timeout)
        if seen:
            fail(f"without any change: {seen} fails")

    counts = {"noticed": 0, "not noticed": 0, "did not build": 0}
    for change in changes:
        result, details = attempt(builder, scratch, change, arguments.timeout)
        counts[result] += 1
        print(f"{result:13}  {change.file}:{change.number}  {change.title}", flush=True)
        if result == "did not build":
            print(details[-2000:], flush=True)
        elif details:
            print(f"{'':13}  by {details}", flush=True)
    print(f"{len(changes)} changes: " + ", ".join(f"{count} {name}" for name, count in counts.items()))
    return 0 if counts["noticed"] == len(changes) else 1


if __name__ == "__main__":
    sys.exit(main())
