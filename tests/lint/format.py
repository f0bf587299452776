#!/usr/bin/env python3
"""No source file differs from what clang-format makes of it (.clang-format).

  format.py ROOT          lists the files that do, exit code 1 when there are any; `clang-format -i FILE` mends one
  format.py --self-test   a planted offence is caught
"""
import concurrent.futures
import os
import pathlib
import subprocess
import sys

ROOMS = ("proto", "drivers", "calib", "daemon", "tests")
BATCH = 40


def differing(sources, style: pathlib.Path):
    """Those of the files that clang-format would change. One process for many: to start it costs more than to format."""
    done = subprocess.run(["clang-format", "--dry-run", f"--style=file:{style}", *map(str, sources)],
                          capture_output=True, text=True, check=True)
    return {line.split(":")[0] for line in done.stderr.splitlines() if "[-Wclang-format-violations]" in line}


def offences(root: pathlib.Path):
    sources = sorted(p for room in ROOMS for p in (root / room).rglob("*") if p.suffix in (".h", ".cc"))
    batches = [sources[i:i + BATCH] for i in range(0, len(sources), BATCH)]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        found = pool.map(lambda batch: differing(batch, root / ".clang-format"), batches)
    return sorted(pathlib.Path(p).relative_to(root).as_posix() for p in set().union(*found))


def self_test():
    import tempfile
    with tempfile.TemporaryDirectory() as scratch:
        root = pathlib.Path(scratch)
        (root / ".clang-format").write_text("BasedOnStyle: Google\n")
        for room in ROOMS:
            (root / room).mkdir()
        (root / "proto/neat.h").write_text("int neat(int x);\n")
        (root / "proto/messy.h").write_text("int  messy ( int x ) ;\n")
        return offences(root) == ["proto/messy.h"]


def main():
    if sys.argv[1:] == ["--self-test"]:
        return 0 if self_test() else 1
    found = offences(pathlib.Path(sys.argv[1]))
    for path in found:
        print(f"{path}: differs from its clang-format; mend it by clang-format -i {path}")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
