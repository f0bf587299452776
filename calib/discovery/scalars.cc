// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/scalars.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "calib/effects/effect_context.h"

namespace mgtd::calib::discovery {
namespace {

class Finder {
 public:
  explicit Finder(const LawInputs& inputs) : inputs_(inputs) {}

  Scalars find() {
    add("t_h", "t_h", true, 0, -1);
    add("T_degC", "T_degC", false, effects::kReferenceT_degC, -1);
    for (int s = 0; s < inputs_.channels() / 3 && inputs_.channels() > 3; ++s) {
      const std::string name = fmt::format("s{}_T_degC", s + 1);
      add(name, name, true, effects::kReferenceT_degC, s);
    }
    std::set<std::string> columns;
    for (const Pose& pose : inputs_.run().poses)
      for (const auto& [name, value] : pose.covariates) columns.insert(name);
    for (const std::string& name : columns) add(name, name, true, 0, -1);
    for (const char* name : {"azimuth_deg", "pitch_deg", "roll_deg"}) {
      const bool azimuth = std::string_view(name) == "azimuth_deg";
      const std::size_t before = out_.all.size();
      add(name, azimuth ? "(azimuth_deg-360*(azimuth_deg>180))" : name, true, 0, -1);
      if (out_.all.size() > before) out_.angles.emplace_back(name);
      if (azimuth) add(name, name, true, 0, -1);  // as a cable winds, and as a circle is cut behind
    }
    add("sense", "sense", true, 0, -1);
    return std::move(out_);
  }

 private:
  /// Values of a name over the channels that read it.
  std::vector<double> pooled(const std::string& name, bool common) const {
    std::vector<double> out;
    for (int c = 0; c < (common ? 1 : inputs_.channels()); c += 3)
      for (const double x : inputs_.name(name, c))
        if (std::isfinite(x)) out.push_back(x);
    return out;
  }
  bool varies(const std::vector<double>& values) const {
    if (values.empty()) return false;
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    return *high - *low > 1e-9 * (std::abs(*high) + std::abs(*low));
  }
  void add(const std::string& name, std::string text, bool common, double zero, int foreign_sensor) {
    std::vector<double> values = pooled(name, common);
    if (!varies(values)) return;
    if (text.find("360") != std::string::npos)
      for (double& x : values) x -= x > 180 ? 360 : 0;
    std::sort(values.begin(), values.end());
    Scalar s{.text = std::move(text),
             .covariate = name,
             .symbols = foreign_sensor < 0 ? 1 : 2,
             .foreign_sensor = foreign_sensor,
             .common = common,
             .zero = zero};
    for (const double x : values) s.mean += x / static_cast<double>(values.size());
    for (int i = 1; i < 10; ++i) {
      const double x = values[values.size() * static_cast<std::size_t>(i) / 10];
      if (x > values.front() && x < values.back() && (s.deciles.empty() || x > s.deciles.back()))
        s.deciles.push_back(x);
    }
    std::set<double> levels;
    for (const double x : values)
      if (levels.size() < 3) levels.insert(x);
    s.curve = levels.size() > 2;
    out_.all.push_back(std::move(s));
  }

  const LawInputs& inputs_;
  Scalars out_;
};

}  // namespace

std::string number_text(double x) { return fmt::format("{:.6g}", x); }

std::string less_text(const std::string& of, double c) {
  if (std::abs(c) < 1e-9) return of;
  return c < 0 ? fmt::format("{}+{}", of, number_text(-c)) : fmt::format("{}-{}", of, number_text(c));
}

std::string Scalar::about(double centre) const {
  return centre == 0 ? text : fmt::format("({})", less_text(text, centre));
}

const Scalar* Scalars::find(std::string_view covariate) const {
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Scalar& s) { return s.covariate == covariate; });
  return found == all.end() ? nullptr : &*found;
}

Scalars scalars_of(const LawInputs& inputs) { return Finder(inputs).find(); }

}  // namespace mgtd::calib::discovery
