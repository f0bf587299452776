#!/usr/bin/env python3
"""clang-tidy finds nothing in the headers of the rooms (.clang-tidy names the checks).

  tidy.py ROOT BUILD      reads all headers as one translation unit, with the options in BUILD/compile_commands.json;
                          prints what it finds, exit code 1 when there is anything
  tidy.py --self-test     a planted offence is caught

All headers together cost one reading of Eigen, Asio and the JSON library instead of four hundred: about a minute.
"""
import json
import pathlib
import shlex
import subprocess
import sys
import tempfile

ROOMS = ("proto", "drivers", "calib", "daemon")
KEPT = ("-D", "-I", "-std")


def options(build: pathlib.Path):
    """Definitions and include folders of the daemon's commands, which use every room."""
    for entry in json.loads((build / "compile_commands.json").read_text()):
        words = shlex.split(entry["command"])
        if not any("mgtd_cli.dir" in word for word in words):
            continue
        systems = [f"-isystem{words[i + 1]}" for i, word in enumerate(words) if word == "-isystem"]
        return [word for word in words if word.startswith(KEPT)] + systems
    raise SystemExit(f"{build}/compile_commands.json does not have the commands of the daemon (target mgtd_cli)")


def findings(root: pathlib.Path, compiler_options, style: pathlib.Path):
    headers = sorted(p for room in ROOMS for p in (root / room).rglob("*.h"))
    with tempfile.TemporaryDirectory() as scratch:
        unit = pathlib.Path(scratch) / "headers.cc"
        unit.write_text("".join(f'#include "{p}"\n' for p in headers))
        done = subprocess.run(["clang-tidy", "--quiet", f"--config-file={style}",
                               f"--header-filter=^{root}/({'|'.join(ROOMS)})/", str(unit), "--", *compiler_options],
                              capture_output=True, text=True)
    lines = [line for line in done.stdout.splitlines() if " error: " in line or " warning: " in line]
    if done.returncode != 0 and not lines:
        raise SystemExit(done.stdout + done.stderr)
    return lines


def self_test():
    style = pathlib.Path(__file__).resolve().parents[2] / ".clang-tidy"
    with tempfile.TemporaryDirectory() as scratch:
        root = pathlib.Path(scratch).resolve()
        for room in ROOMS:
            (root / room).mkdir()
        (root / "proto/neat.h").write_text("#pragma once\ninline int neat(int x) { return x; }\n")
        (root / "proto/idle.h").write_text("#pragma once\ninline const char* idle() { return 0; }\n")
        found = findings(root, ["-std=c++20"], style)
        return len(found) == 1 and "idle.h" in found[0] and "nullptr" in found[0]


def main():
    if sys.argv[1:] == ["--self-test"]:
        return 0 if self_test() else 1
    root, build = (pathlib.Path(p).resolve() for p in sys.argv[1:3])
    found = findings(root, options(build), root / ".clang-tidy")
    print("\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
