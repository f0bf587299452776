// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/formula_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <regex>
#include <span>

#include "calib/discovery/channel_sums.h"
#include "calib/discovery/grammar.h"
#include "calib/effects/formula/formula_effect.h"
#include "calib/effects/laws/site_gradient.h"
#include "calib/effects/where.h"

namespace mgtd::calib::discovery {
namespace {

/// The letter of u, ux, uy, uz and the same before.
std::string letter(const std::string& name, const Place& place) {
  if (name.size() == 2) return name.substr(1);
  if (place.kind == Place::Kind::axis) return std::string(1, "xyz"[place.at % 3]);
  return "u";
}

std::string replaced(const std::string& text, const std::string& pattern,
                     const std::function<std::string(const std::smatch&)>& by) {
  const std::regex what(pattern);
  std::string out;
  auto from = text.cbegin();
  for (std::sregex_iterator at(text.begin(), text.end(), what), end; at != end; ++at) {
    out.append(from, (*at)[0].first);
    out += by(*at);
    from = (*at)[0].second;
  }
  out.append(from, text.cend());
  return out;
}

std::string shown_column(const std::string& text, const Place& place) {
  for (std::size_t i = 0; i < kGravity.size(); ++i)
    if (text == kGravity[i]) return fmt::format("g{}", "xyz"[i]);
  std::string out = text;
  out = replaced(out, R"(\(\((s\d+_[xyz])_nT(?:[+-][0-9.e+-]+)?\)/50000\))",
                 [](const auto& m) { return m[1].str(); });
  out = replaced(out, R"(\((prev_)?(u[xyz]?)/50000\))",
                 [&](const auto& m) { return m[1].str() + letter(m[2].str(), place); });
  out =
      replaced(out, R"(\(azimuth_deg-360\*\(azimuth_deg>180\)\))", [](const auto&) { return "azimuth_deg"; });
  out = replaced(out, R"(\blag(\d+)_(s\d+_)?T_degC\b)",
                 [](const auto& m) { return fmt::format("lag({}T, {} s)", m[2].str(), m[1].str()); });
  out = replaced(out, R"(\brate_(s\d+_)?T_degC\b)",
                 [](const auto& m) { return fmt::format("d{}T/dt", m[1].str()); });
  out = replaced(out, R"(sind\(1\*)", [](const auto&) { return "sind("; });
  out = replaced(out, R"(cosd\(1\*)", [](const auto&) { return "cosd("; });
  out = replaced(out, R"(\bT_degC\b)", [](const auto&) { return "T"; });
  out = replaced(out, R"(max\(t_h, 0\))", [](const auto&) { return "t_h"; });
  return out;
}

}  // namespace

std::string shown(const Columns& columns, const Place& place) {
  if (columns.size() == 1) return shown_column(columns.front(), place);
  std::string out;
  for (std::size_t j = 0; j < columns.size(); ++j)
    out += fmt::format("{}{}*{}", j == 0 ? "" : " + ", "abc"[j], shown_column(columns[j], place));
  return out;
}

std::string shown_covariate(const std::string& name, const Place& place) {
  const bool on_sensor = place.kind == Place::Kind::axis || place.kind == Place::Kind::sensor;
  const int sensor = place.kind == Place::Kind::axis ? place.at / 3 : place.at;
  if (name == "T_degC" && on_sensor) return effects::sensor_name(sensor) + "_T_degC";
  const bool before = name.starts_with("prev_");
  const std::string own = before ? name.substr(5) : name;
  if (own != "u" && own != "ux" && own != "uy" && own != "uz") return name;
  const std::string at = on_sensor ? fmt::format("{}.{}", effects::sensor_name(sensor), letter(own, place))
                                   : "own " + letter(own, place);
  return before ? at + " before" : at;
}

namespace {

/// "k1*a + k2*b"
std::string expression_of(std::span<const std::string> columns) {
  if (columns.size() == 1) return columns.front();
  std::string out;
  for (std::size_t j = 0; j < columns.size(); ++j)
    out += fmt::format("{}k{}*{}", j == 0 ? "" : " + ", j + 1, columns[j]);
  return out;
}

/// One effect, or several where it has more coefficients than a gradient takes.
std::vector<std::string> gradient_specs(const Columns& columns, const std::string& name) {
  using effects::formula::kGradientCoefficients;
  std::vector<std::string> out;
  for (std::size_t from = 0; from < columns.size(); from += kGradientCoefficients) {
    const auto some =
        std::span(columns).subspan(from, std::min(kGradientCoefficients, columns.size() - from));
    out.push_back(
        fmt::format("{}{},level=gradient,unit=nT/m,expr={}", name,
                    columns.size() > kGradientCoefficients ? fmt::format("-{}", out.size() + 1) : "",
                    expression_of(some)));
  }
  return out;
}

}  // namespace

std::vector<std::string> specs_of(const Columns& columns, const Place& place, const std::string& name) {
  const std::string expression = expression_of(columns);
  const auto spec = [&](const std::string& of, const std::string& where) {
    return fmt::format("{}@{},level=axis,unit=nT,expr={}", of, where, expression);
  };
  switch (place.kind) {
    case Place::Kind::axis:
    case Place::Kind::array:
      return {spec(name, place.name())};
    case Place::Kind::sensor: {
      std::vector<std::string> out;
      for (int axis = 0; axis < 3; ++axis)
        out.push_back(spec(fmt::format("{}-{}", name, "xyz"[axis]), effects::axis_name(place.at, axis)));
      return out;
    }
    case Place::Kind::gradient:
      return gradient_specs(columns, name);
  }
  return {};
}

std::vector<std::string> coefficient_places(const Columns& columns, const Place& place, int channels) {
  std::vector<std::string> out;
  for (const int c : place.channels(channels)) {
    const std::string at = c < channels
                               ? effects::axis_name(c / 3, c % 3)
                               : effects::laws::kGradientComponents[static_cast<std::size_t>(c - channels)];
    for (std::size_t j = 0; j < columns.size(); ++j)
      out.push_back(columns.size() == 1 ? at : fmt::format("{}.{}", at, "abc"[j]));
  }
  return out;
}

}  // namespace mgtd::calib::discovery
