#!/usr/bin/env python3
"""Namespaces follow folders: what stands in calib/fit/joint is in mgtd::calib::fit::joint.

Names of another room may be declared ahead (`namespace mgtd::calib::effects { class Effect; }`), and a template of
Eigen or the standard library may be specialised, but only declarations stand there: no definition of a function, no
class with a body.

  namespaces.py ROOT          lists offences, exit code 1 when there are any
  namespaces.py --self-test   planted offences are caught
"""
import pathlib
import re
import sys

ROOTS = ("calib", "daemon")
OPENS = re.compile(r"^namespace (mgtd(?:::\w+)*) \{", re.MULTILINE)
# A block whose every line is a declaration, a comment, or empty.
DECLARES = re.compile(r"(?:\s|//[^\n]*|(?:template <[^>]*>\s*)?(?:class|struct|enum class) \w+(?: : \w+)?;)*\}")


def expected(path: str):
    """The namespace of a file, or None where this rule does not speak of it."""
    parts = path.split("/")
    if len(parts) < 2 or parts[0] not in ROOTS:
        return None
    return "::".join(["mgtd", *parts[:-1]])


def offences(path: str, text: str):
    wanted = expected(path)
    if wanted is None:
        return
    seen = False
    for match in OPENS.finditer(text):
        found = match.group(1)
        if found == wanted:
            seen = True
        elif not DECLARES.match(text, match.end()):
            line = text.count("\n", 0, match.start()) + 1
            yield f"{path}:{line}: namespace {found} in the folder of {wanted}"
    if not seen and OPENS.search(text):
        yield f"{path}: nothing in namespace {wanted}"


def self_test():
    clean = "namespace mgtd::calib::effects {\nclass Effect;  // elsewhere\n}\nnamespace mgtd::calib::fit {\nint f();\n}\n"
    assert not list(offences("calib/fit/readings.h", clean))
    assert not list(offences("tests/rig/world.h", "namespace mgtd::rig {\n}\n"))
    assert list(offences("calib/fit/readings.h", "namespace mgtd::calib {\nint f();\n}\n"))
    assert list(offences("calib/fit/readings.h", clean + "namespace mgtd::calib::sensor {\nint g() { return 1; }\n}\n"))
    assert list(offences("daemon/run/dwell.cc", "namespace mgtd::daemon {\nint f();\n}\n"))


def main():
    if sys.argv[1:] == ["--self-test"]:
        self_test()
        return 0
    root = pathlib.Path(sys.argv[1])
    found = [offence for folder in ROOTS for path in sorted((root / folder).rglob("*"))
             if path.suffix in (".h", ".cc")
             for offence in offences(path.relative_to(root).as_posix(), path.read_text())]
    print("\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
