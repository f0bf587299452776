// SPDX-License-Identifier: Apache-2.0
#include "drivers/obsdaq_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "drivers/baud.h"
#include "drivers/identity.h"
#include "proto/number.h"

namespace mgtd::drivers::obsdaq {
namespace {

constexpr double kProfileVolts = 10.0;
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

void read_thermometer(Settings& s, ObsdaqSettings& out) {
  const std::string input = s.text("temperature", "none");
  const double slope = s.number("degC_per_V", 0.0);
  const double at_zero = s.number("degC_at_0V", 0.0);
  if (input == "none") return;
  if (input != "p" && input != "q" && input != "r") {
    s.object("temperature", fmt::format("no input '{}'; there are \"p\", \"q\", \"r\" and \"none\"", input));
    return;
  }
  if (slope == 0)
    s.object("temperature", "needs degC_per_V (and degC_at_0V) of the thermometer on that input");
  out.thermometer = Thermometer{static_cast<std::size_t>(input[0] - 'p'), slope, at_zero};
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

ObsdaqSettings read_obsdaq_settings(Settings& s) {
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
  read_thermometer(s, out);
  check_rate(s, out);
  return out;
}

}  // namespace mgtd::drivers::obsdaq
