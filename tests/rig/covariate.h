// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// A Covariate is something that changes during a run and can be written down beside the poses, or forgotten:
/// a motor's current, the battery.
namespace mgtd::rig {

enum class Wave {
  toggle,  ///< mean + or - amplitude, at random every `every_s`
  sine,    ///< mean + amplitude sin(2 pi t/every_s)
  ramp     ///< mean + amplitude t/every_s
};

/// The auxiliary input of a digitiser that measures it: value = per_V * volts + at_0V.
struct CovariateInput {
  int slot{0};       ///< of the sensor behind the digitiser
  char letter{'q'};  ///< q or r; the head's thermometer is on p
  double per_V{1}, at_0V{0};
  std::string unit{"V"};
};

struct Covariate {
  std::string name{"motor_A"};  ///< its column
  double mean{0}, amplitude{1};
  Wave wave{Wave::toggle};
  double every_s{30};
  bool recorded{true};
  std::optional<CovariateInput> input{};  ///< empty: it is on the input module
  std::uint64_t pattern{1};               ///< of the toggling
  [[nodiscard]] double at(double t_s) const;
};

/// Those that an input module measures.
[[nodiscard]] std::vector<Covariate> on_module(std::vector<Covariate> all);
/// Those that the digitiser of a sensor measures.
[[nodiscard]] std::vector<Covariate> on_digitiser(std::vector<Covariate> all, int slot);

/// +1 or -1, at random for every `every_s`; the same pattern always toggles the same way.
[[nodiscard]] double toggled(double t_s, double every_s, std::uint64_t pattern);

}  // namespace mgtd::rig
