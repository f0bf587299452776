#!/usr/bin/env python3
"""Every file includes, itself or through others, the header of each name of the project that it uses.

In a jumbo build another file of the batch may have included it: the file then does not compile alone, as the presets
fuzz and tidy want it. Looked at are types, aliases and constants that exactly one header defines, at the top of a
namespace; a name that the file declares itself is its own.

  self_contained.py ROOT          lists offences, exit code 1 when there are any
  self_contained.py --self-test   planted offences are caught
"""
import pathlib
import re
import sys

ROOMS = ("proto", "drivers", "calib", "daemon", "tests")
INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.M)
COMMENT_OR_TEXT = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"', re.S)
DEFINITION = re.compile(
    r"^(?:template <[^\n]*>\n)?"
    r"(?:(?:struct|class|enum class) ([A-Z]\w+)\b[^;\n]*\{?$|using ([A-Z]\w+) =|inline constexpr [^=;(]*?\b(k[A-Z]\w+)\b)",
    re.M)
DECLARED = re.compile(r"\b(?:enum class|struct|class|enum|using|concept|typename|template <int) (\w+)"
                      r"|\b(?:constexpr|static const) [^=;(]*?\b(k[A-Z]\w+)\b|, (k[A-Z]\w+) = ")
SUITE = re.compile(r"^(?:TEST|TEST_P|INSTANTIATE_TEST_SUITE_P|RC_GTEST_PROP)\([^)]*", re.M)
NAME = re.compile(r"(?<![\w:])(?:[a-z]\w*::)*([A-Z]\w*[a-z]\w*|k[A-Z]\w+)\b")


def bare(text: str) -> str:
    """Without comments, texts, names of tests and the headers of libraries; included paths stay."""
    text = SUITE.sub("", re.sub(r"#\s*include\s*<[^>]*>", "", text))
    return COMMENT_OR_TEXT.sub(lambda m: m[0] if m[0].startswith('"') and m[0].endswith('.h"') else "", text)


def homes(files):
    """Name -> the only header that defines it."""
    found = {}
    for path, text in files.items():
        if path.endswith(".h"):
            for groups in DEFINITION.findall(text):
                found.setdefault(next(g for g in groups if g), set()).add(path)
    return {name: next(iter(paths)) for name, paths in found.items() if len(paths) == 1}


def reached(path, files, known):
    if path not in known:
        known[path] = {path}  # against a circle
        for target in INCLUDE.findall(files.get(path, "")):
            known[path] |= {target} | reached(target, files, known)
    return known[path]


def offences(texts):
    files = {path: bare(text) for path, text in texts.items()}
    declared = {path: {name for groups in DECLARED.findall(text) for name in groups} for path, text in files.items()}
    home, known = homes(files), {}
    for path, text in sorted(files.items()):
        there = reached(path, files, known)
        own = set().union(*(declared.get(p, set()) for p in there))
        for number, line in enumerate(text.splitlines(), 1):
            for name in set(NAME.findall(line)) & home.keys() - own:
                own.add(name)  # said once
                yield f"{path}:{number}: {name} is of {home[name]}, which is not included"


def self_test():
    world = {
        "proto/per_sensor.h": "namespace mgtd {\ntemplate <class T>\nclass PerSensor : public Base {\n};\n}\n",
        "proto/limits.h": "inline constexpr std::size_t kMostPoses = 9;\n",
        "proto/both.h": '#include "proto/per_sensor.h"\n#include "proto/limits.h"\n',
    }
    caught = {
        "calib/a.h": "PerSensor<int> a();\n",
        "calib/b.cc": '#include "proto/per_sensor.h"\nint b() { return kMostPoses; }\n',
    }
    clean = {
        "calib/c.cc": '#include "proto/both.h"\nPerSensor<int> c(int n = kMostPoses);\n',
        "calib/d.h": "class PerSensor;\nvoid d(const PerSensor& a);\n",
        "calib/e.cc": '// PerSensor\nconst char* e = "PerSensor";\nconstexpr int kMostPoses = 3;\nint f = kMostPoses;\n',
    }
    found = [o.split(":")[0] for o in offences({**world, **caught, **clean})]
    for path in caught.keys() - set(found):
        print(f"not caught: {path}")
    for path in set(found) & clean.keys():
        print(f"caught, though it is right: {path}")
    return 0 if set(found) == caught.keys() else 1


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    root = pathlib.Path(sys.argv[1])
    found = list(offences({p.relative_to(root).as_posix(): p.read_text() for room in ROOMS
                           for p in (root / room).rglob("*") if p.suffix in (".h", ".cc")}))
    print("\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
