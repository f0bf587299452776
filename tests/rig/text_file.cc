// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/text_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>

namespace mgtd::rig {

std::optional<std::string> text_of_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::string text, piece(1U << 16U, '\0');
  while (in.read(piece.data(), static_cast<std::streamsize>(piece.size())), in.gcount() > 0)
    text.append(piece, 0, static_cast<std::size_t>(in.gcount()));
  if (in.is_open() && !in.bad()) return text;
  fmt::print(stderr, "mgt-rig: {} cannot be read: {}\n", path, std::strerror(errno));
  return std::nullopt;
}

int write_file(const std::string& path, const std::string& content) {
  if (path.empty() || path == "/dev/stdout") {  // opened anew it would begin at the start of its file
    fmt::print("{}", content);
    return 0;
  }
  std::ofstream out(path, std::ios::binary);
  if (out << content << std::flush) return 0;
  fmt::print(stderr, "mgt-rig: {} cannot be written\n", path);
  return 2;
}

}  // namespace mgtd::rig
