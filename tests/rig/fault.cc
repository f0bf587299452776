// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/fault.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <sstream>
#include <vector>

namespace mgtd::rig {
namespace {

constexpr std::array<std::pair<std::string_view, FaultKind>, 6> kKinds{{{"unplug", FaultKind::unplug},
                                                                        {"garbage", FaultKind::garbage},
                                                                        {"torn", FaultKind::torn},
                                                                        {"freeze", FaultKind::freeze},
                                                                        {"stall", FaultKind::stall},
                                                                        {"restore", FaultKind::restore}}};

}  // namespace

tl::expected<Fault, std::string> parse_fault(std::string_view text) {
  std::istringstream in{std::string(text)};
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  constexpr const char* kUsage = "say: unplug|garbage|torn|freeze|stall|restore PORT [for SECONDS]";
  if (words.size() != 2 && words.size() != 4) return tl::unexpected(std::string(kUsage));
  Fault fault;
  fault.port = words[1];
  bool known = false;
  for (const auto& [name, kind] : kKinds) {
    if (words[0] == name) fault.kind = kind, known = true;
  }
  if (!known) return tl::unexpected(fmt::format("no fault '{}'; {}", words[0], kUsage));
  if (words.size() == 4) {
    double seconds = 0;
    const auto [end, error] = std::from_chars(words[3].data(), words[3].data() + words[3].size(), seconds);
    if (words[2] != "for" || error != std::errc{} || *end != '\0' || !(seconds > 0))
      return tl::unexpected(std::string(kUsage));
    fault.for_s = seconds;
  }
  return fault;
}

}  // namespace mgtd::rig
