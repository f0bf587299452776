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

constexpr std::array<Word, 23> kWords{
    {{"unplug", FaultKind::unplug, true},       {"garbage", FaultKind::garbage, false},
     {"torn", FaultKind::torn, true},           {"half", FaultKind::half, true},
     {"twice", FaultKind::twice, true},         {"swap", FaultKind::swap, true},
     {"freeze", FaultKind::freeze, true},       {"stall", FaultKind::stall, true},
     {"mute", FaultKind::mute, true},           {"late", FaultKind::late, true},
     {"saturate", FaultKind::saturate, true},   {"clock", FaultKind::clock, false},
     {"rate", FaultKind::rate, false},          {"slow", FaultKind::slow, true},
     {"step", FaultKind::step, true},           {"power", FaultKind::power, true},
     {"stranger", FaultKind::stranger, true},   {"exchange", FaultKind::exchange, true},
     {"turn", FaultKind::turn, true},           {"runaway", FaultKind::runaway, true},
     {"backwards", FaultKind::backwards, true}, {"limit", FaultKind::limit, true},
     {"restore", FaultKind::restore, false}}};

bool of_the_table(FaultKind kind) {
  return kind == FaultKind::runaway || kind == FaultKind::backwards || kind == FaultKind::limit;
}

bool of_the_sensors(FaultKind kind) { return kind == FaultKind::exchange || kind == FaultKind::turn; }

std::optional<double> seconds(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !(value > 0 && value < 1e9))
    return std::nullopt;
  return value;
}

}  // namespace

std::vector<std::string> port_names(std::size_t sensors) {
  std::vector<std::string> out;
  for (std::size_t i = 1; i <= sensors; ++i) out.push_back(fmt::format("fluxgate{}", i));
  for (const char* name : {"table", "scalar", "auxiliary"}) out.emplace_back(name);
  return out;
}

tl::expected<Fault, std::string> parse_fault(std::string_view text, std::size_t sensors) {
  std::istringstream in{std::string(text)};
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  const auto usage = [](const std::string& what) {
    return tl::unexpected(fmt::format("{}; say: {}", what, kFaultUsage));
  };
  const std::size_t ports = !words.empty() && words[0] == "exchange" ? 2 : 1;
  if (words.size() != 1 + ports && words.size() != 3 + ports)
    return usage(fmt::format("'{}' is not a fault and {}", text, ports == 2 ? "two ports" : "a port"));
  const auto* const found =
      std::find_if(kWords.begin(), kWords.end(), [&](const Word& w) { return w.name == words[0]; });
  if (found == kWords.end()) return usage(fmt::format("no fault '{}'", words[0]));
  const std::vector<std::string> names = port_names(sensors);
  for (std::size_t i = 1; i <= ports; ++i) {
    if (std::find(names.begin(), names.end(), words[i]) == names.end())
      return usage(fmt::format("no port '{}'; there are: {}", words[i], fmt::join(names, ", ")));
    if (of_the_sensors(found->kind) && !words[i].starts_with("fluxgate"))
      return usage(fmt::format("only a fluxgate has the fault '{}'", found->name));
  }
  Fault fault{found->kind, words[1], ports == 2 ? words[2] : "", std::nullopt};
  if (fault.port == fault.other) return usage("a plug is exchanged with another one");
  if (of_the_table(fault.kind) && fault.port != "table")
    return usage(fmt::format("only the table has the fault '{}'", found->name));
  if (fault.kind == FaultKind::power) fault.for_s = kPowerOff_s;
  if (words.size() == 1 + ports) return fault;
  if (!found->lasts) return usage(fmt::format("{} does not last, so no 'for'", words[0]));
  fault.for_s = seconds(words.back());
  if (words[1 + ports] != "for" || !fault.for_s)
    return usage(fmt::format("'{} {}' is not 'for SECONDS'", words[1 + ports], words.back()));
  return fault;
}

}  // namespace mgtd::rig
