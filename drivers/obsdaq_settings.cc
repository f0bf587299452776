// SPDX-License-Identifier: Apache-2.0
#include "drivers/obsdaq_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "drivers/baud.h"
#include "drivers/identity.h"
#include "proto/number.h"

namespace mgtd::drivers::obsdaq {
namespace {

constexpr double kProfileVolts = 10.0;
constexpr std::array<std::string_view, kInputs> kInputNames{"p", "q", "r"};
constexpr std::array<int, 5> kProfileRanges_uT{70, 100, 250, 500, 1000};

/// "mag-13-100" -> 10000 nT/V
std::optional<double> profile_scale(std::string_view name) {
  if (!name.starts_with("mag-03-") && !name.starts_with("mag-13-")) return std::nullopt;
  const auto range_uT = parse_integer(name.substr(7));
  if (!range_uT ||
      std::find(kProfileRanges_uT.begin(), kProfileRanges_uT.end(), *range_uT) == kProfileRanges_uT.end())
    return std::nullopt;
  return static_cast<double>(*range_uT) * 1000.0 / kProfileVolts;
}

void read_scale(Settings& s, ObsdaqSettings& out) {
  const std::string profile = s.text("profile", "");
  const std::vector<double> scale = s.numbers("scale_nT_per_V", 3, {0, 0, 0});
  const std::vector<double> offset = s.numbers("offset_nT", 3, {0, 0, 0});
  out.offset_nT = {offset[0], offset[1], offset[2]};
  if (s.has("profile") == s.has("scale_nT_per_V")) {
    s.object("profile",
             "name the sensor (like \"mag-13-100\") or give its scale_nT_per_V = [x, y, z], one of both");
  } else if (s.has("scale_nT_per_V")) {
    out.sensor = "own scale";
    out.scale_nT_per_V = {scale[0], scale[1], scale[2]};
    if (!(out.scale_nT_per_V.array() != 0).all()) s.object("scale_nT_per_V", "no axis may be zero");
  } else if (const auto nT_per_V = profile_scale(profile)) {
    out.sensor = profile;
    out.scale_nT_per_V.setConstant(*nT_per_V);
  } else {
    s.object("profile", fmt::format("no profile '{}'; there are mag-03-R and mag-13-R with R = {} (uT)",
                                    profile, fmt::join(kProfileRanges_uT, ", ")));
  }
}

/// Its own thermometer.
void read_thermometer(Settings& s, ObsdaqSettings& out, int slot) {
  const std::string input = s.text("temperature", "none");
  const double slope = s.number("degC_per_V", 0.0);
  const double at_zero = s.number("degC_at_0V", 0.0);
  if (input == "none") return;
  const auto found = std::find(kInputNames.begin(), kInputNames.end(), input);
  if (found == kInputNames.end()) {
    s.object("temperature", fmt::format("no input '{}'; there are \"p\", \"q\", \"r\" and \"none\"", input));
    return;
  }
  if (slope == 0)
    s.object("temperature", "needs degC_per_V (and degC_at_0V) of the thermometer on that input");
  if (s.has_table("inputs." + input))
    s.object("temperature",
             fmt::format("inputs.{0} names a column for the same input; leave one of the two out", input));
  out.inputs.push_back({static_cast<std::size_t>(found - kInputNames.begin()), input, "temperature",
                        fmt::format("s{}_T_degC", slot + 1), "degC", slope, at_zero});
}

void read_input(Settings& s, ObsdaqSettings& out, std::size_t index) {
  const std::string input(kInputNames.at(index));
  const std::string table = "inputs." + input, name = table + ".name", scale = table + ".scale";
  InputChannel channel{index,
                       input,
                       name,
                       s.text(name, ""),
                       s.text(table + ".unit", ""),
                       s.number(scale, 1.0),
                       s.number(table + ".offset", 0.0)};
  if (!s.has_table(table)) return;
  if (!s.has(name)) {
    s.object(table, R"(needs a name, of its column in the pose table: name = "motor_A")");
    return;
  }
  check_column(channel, s);
  if (channel.unit.empty()) s.object(name, R"(needs a unit beside it: unit = "A")");
  if (!s.has(scale) && !channel.unit.empty() && channel.unit != "V")
    s.object(name, fmt::format("needs a scale beside it, {0} per V: {1} = scale * volts + offset",
                               channel.unit, channel.column));
  if (channel.scale == 0 || !std::isfinite(channel.scale)) s.object(scale, "must be a number other than 0");
  if (!std::isfinite(channel.offset)) s.object(table + ".offset", "must be a number");
  out.inputs.push_back(std::move(channel));
}

void read_inputs(Settings& s, ObsdaqSettings& out, int slot) {
  read_thermometer(s, out, slot);
  s.refuse_other_tables("inputs", kInputNames, "an ObsDAQ has the inputs p, q and r");
  for (std::size_t i = 0; i < kInputNames.size(); ++i) read_input(s, out, i);
}

void check_rate(Settings& s, ObsdaqSettings& out) {
  const Result<Timing> timing = timing_for(out.rate_hz);
  if (!timing) {
    s.object("rate_hz", timing.error().message);
    return;
  }
  out.timing = *timing;
  const std::size_t line = kLineBytes + (out.palmacq ? kPrefixBytes : 0);
  double highest_hz = highest_rate_hz(out.baud, line);
  int narrowest = out.baud;
  if (const double inner_hz = highest_rate_hz(kDirectBaud, kLineBytes);
      out.palmacq && inner_hz < highest_hz) {
    highest_hz = inner_hz;
    narrowest = kDirectBaud;
  }
  if (out.timing.rate_hz() > highest_hz) {
    s.object(
        "rate_hz",
        fmt::format("{} Hz does not fit a line of {} Bd ({} bytes a sample{}); the highest rate that fits "
                    "is {:.1f} Hz",
                    out.rate_hz, narrowest, narrowest == out.baud ? line : kLineBytes,
                    narrowest == out.baud ? "" : " between ObsDAQ and PalmAcq",
                    std::floor(highest_hz * 10) / 10));
  }
}

}  // namespace

ObsdaqSettings read_obsdaq_settings(Settings& s, int slot) {
  ObsdaqSettings out;
  out.address = s.text("address", out.address);
  const bool is_hex = out.address.find_first_not_of("0123456789ABCDEF") == std::string::npos;
  if (out.address.size() != 2 || !is_hex) s.object("address", "must be two hex digits like \"01\"");
  out.serial = read_serial(s);
  out.palmacq = s.boolean("palmacq", false);
  out.baud = read_baud(s, out.palmacq ? kPalmAcqBaud : kDirectBaud);
  out.rate_hz = s.number("rate_hz", out.rate_hz);
  const double range_V = s.number("range_V", 10.0);
  const auto range =
      std::find_if(kRanges.begin(), kRanges.end(), [&](const Range& r) { return r.volts == range_V; });
  if (range == kRanges.end()) {
    s.object("range_V", "must be 10, 5 or 2.5");
  } else {
    out.range = *range;
  }
  read_scale(s, out);
  read_inputs(s, out, slot);
  check_rate(s, out);
  return out;
}

}  // namespace mgtd::drivers::obsdaq
