#!/usr/bin/env python3
"""No class is too large to be held in one's head: at most 20 data members, and in a header at most 150 lines.

Data members of a `class` end with an underscore; those of a class inside count for that class alone. A `struct` is
values with names (a configuration, a report) and may have as many as there are. Of the tests, the simulated rig alone is measured.

  class_size.py ROOT          lists offences, exit code 1 when there are any
  class_size.py --self-test   planted offences are caught
"""
import pathlib
import re
import sys

ROOMS = ("proto", "drivers", "calib", "daemon", "tests/rig")
MOST_MEMBERS = 20
MOST_LINES = 150

# Blanked, with the line ends kept: comments, then literals. (A digit before the quote is a separator: 13'000.)
UNREAD = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<![0-9A-Fa-f])\'(?:\\.|[^\'\\\n])+\'',
                    re.DOTALL)
OPENS = re.compile(r"(?<!enum )\bclass (?:\[\[\w+\]\] )?(\w+)(?: final)?(?: ?:[^;{()]*)?\s*\{")
INNERMOST_BRACES = re.compile(r"\{[^{}]*\}")
INNERMOST_ANGLES = re.compile(r"<[^<>;{}]*>")
FUNCTION_BODY = re.compile(r"(\)[^;{}]*)@")
NO_MEMBER = re.compile(r"\s*(?:using|friend|typedef|enum|struct|class|union|static|template|explicit|operator)\b")
MEMBER = re.compile(r"\b(\w+_)\s*(?:\[[^\]]*\]\s*)*(?=[@=,]|$)")


def collapsed(pattern, text: str, mark: str):
    while True:
        shorter = pattern.sub(mark, text)
        if shorter == text:
            return text
        text = shorter


def body_end(text: str, begin: int):
    """Where the brace that was opened just before `begin` is closed."""
    depth = 1
    for at in range(begin, len(text)):
        depth += {"{": 1, "}": -1}.get(text[at], 0)
        if depth == 0:
            return at
    return len(text)


def members(body: str):
    flat = collapsed(INNERMOST_ANGLES, collapsed(INNERMOST_BRACES, body, "@"), "")
    flat = re.sub(r"\b(?:public|private|protected):", "", FUNCTION_BODY.sub(r"\1;", flat))
    for statement in flat.split(";"):
        declared = statement.split("=")[0].strip()  # not what it is set to
        if "(" not in declared and not NO_MEMBER.match(declared):
            yield from MEMBER.findall(declared)


def offences(path: str, text: str):
    text = UNREAD.sub(lambda m: "\n" * m.group(0).count("\n"), text)
    for match in OPENS.finditer(text):
        end = body_end(text, match.end())
        line = text.count("\n", 0, match.start()) + 1
        found = list(members(text[match.end():end]))
        lines = text.count("\n", match.start(), end) + 1
        if len(found) > MOST_MEMBERS:
            yield f"{path}:{line}: class {match.group(1)} has {len(found)} data members, more than {MOST_MEMBERS}"
        if path.endswith(".h") and lines > MOST_LINES:
            yield f"{path}:{line}: class {match.group(1)} has {lines} lines, more than {MOST_LINES}"


def self_test():
    def of(count: int, before: str = "", path: str = "daemon/run/settle.h"):
        values = "\n".join(f"  std::map<int, std::function<void(int)>> value{i}_{{f({i})}};" for i in range(count))
        return list(offences(path, f"class Settle final : public Base<int> {{\n{before}\n private:\n{values}\n}};\n"))

    # What is no member: functions, types, constants, what stands in comments and in classes within.
    besides = ("  explicit Settle(int a) : a_(a), b_{a} {}\n  int at(int x_) const { int y_ = x_; return y_; }\n"
               "  bool ready(std::string_view s_ = \"}\") const;\n  using Time_ = int;\n  static constexpr int kMost_{3};\n"
               "  // int told_;\n  struct Inner { int a_, b_, c_; };\n  enum class Phase_ { one_, two_ };\n")
    assert not of(20) and len(of(21)) == 1 and "21 data members" in of(21)[0]
    assert not of(20, besides) and len(of(21, besides)) == 1
    assert len(of(20, "  int one_{0}, two_[3];")) == 1 and "22 data" in of(20, "  int one_{0}, two_[3];")[0]
    assert len(of(0, "\n" * 150)) == 1 and not of(0, "\n" * 140) and not of(0, "\n" * 150, "daemon/run/settle.cc")
    assert len(of(21, "", "daemon/run/settle.cc")) == 1
    assert list(members("class Inner { int a_; };\n int x_; Worst worst_ = a_;")) == ["x_", "worst_"]
    assert not list(offences("proto/kind.h", "enum class Kind {" + "".join(f"k{i}_," for i in range(30)) + "};"))


def main():
    if sys.argv[1:] == ["--self-test"]:
        self_test()
        return 0
    root = pathlib.Path(sys.argv[1])
    found = [offence for room in ROOMS for path in sorted((root / room).rglob("*")) if path.suffix in (".h", ".cc")
             for offence in offences(path.relative_to(root).as_posix(), path.read_text())]
    print("\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
