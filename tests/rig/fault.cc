// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/fault.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <sstream>
#include <vector>

namespace mgtd::rig {
namespace {

struct Word {
  std::string_view name;
  FaultKind kind;
  bool lasts;
};

constexpr std::array<Word, 19> kWords{{{"unplug", FaultKind::unplug, true},
                                       {"garbage", FaultKind::garbage, false},
                                       {"torn", FaultKind::torn, true},
                                       {"half", FaultKind::half, true},
                                       {"twice", FaultKind::twice, true},
                                       {"swap", FaultKind::swap, true},
                                       {"freeze", FaultKind::freeze, true},
                                       {"stall", FaultKind::stall, true},
                                       {"mute", FaultKind::mute, true},
                                       {"late", FaultKind::late, true},
                                       {"saturate", FaultKind::saturate, true},
                                       {"clock", FaultKind::clock, false},
                                       {"rate", FaultKind::rate, false},
                                       {"power", FaultKind::power, true},
                                       {"stranger", FaultKind::stranger, true},
                                       {"runaway", FaultKind::runaway, true},
                                       {"backwards", FaultKind::backwards, true},
                                       {"limit", FaultKind::limit, true},
                                       {"restore", FaultKind::restore, false}}};

bool of_the_table(FaultKind kind) {
  return kind == FaultKind::runaway || kind == FaultKind::backwards || kind == FaultKind::limit;
}

std::optional<double> seconds(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !(value > 0 && value < 1e9))
    return std::nullopt;
  return value;
}

}  // namespace

tl::expected<Fault, std::string> parse_fault(std::string_view text) {
  std::istringstream in{std::string(text)};
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  const auto usage = [](const std::string& what) {
    return tl::unexpected(fmt::format("{}; say: {}", what, kFaultUsage));
  };
  if (words.size() != 2 && words.size() != 4)
    return usage(fmt::format("'{}' is not a fault and a port", text));
  const auto* const found =
      std::find_if(kWords.begin(), kWords.end(), [&](const Word& w) { return w.name == words[0]; });
  if (found == kWords.end()) return usage(fmt::format("no fault '{}'", words[0]));
  if (std::find(kPortNames.begin(), kPortNames.end(), words[1]) == kPortNames.end())
    return usage(fmt::format("no port '{}'; there are: {}", words[1], fmt::join(kPortNames, ", ")));
  Fault fault{found->kind, words[1], std::nullopt};
  if (of_the_table(fault.kind) && fault.port != "table")
    return usage(fmt::format("only the table has the fault '{}'", found->name));
  if (fault.kind == FaultKind::power) fault.for_s = kPowerOff_s;
  if (words.size() == 2) return fault;
  if (!found->lasts) return usage(fmt::format("{} does not last, so no 'for'", words[0]));
  fault.for_s = seconds(words[3]);
  if (words[2] != "for" || !fault.for_s)
    return usage(fmt::format("'{} {}' is not 'for SECONDS'", words[2], words[3]));
  return fault;
}

}  // namespace mgtd::rig
