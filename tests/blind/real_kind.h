// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "proto/pose.h"
#include "tests/rig/truth.h"

/// These are the kinds of run that happen outside the laboratory: noise that is not white, designs that are
/// not good, readings that are wrong, disturbances, laws larger than usual, mistakes of the set-up. Made by
/// the simulated rig.
namespace mgtd::calib::testing {

/// What must be said of a run.
enum class Must {
  pass,       ///< PASS without a name
  name,       ///< EXPLAINED or AMBIGUOUS, the right names among them and no other named alone
  no_name,    ///< accepted, and no name: PASS, or UNKNOWN where too much comes together
  open,       ///< something is there, and no name is given that is not right
  set_aside,  ///< the disturbed poses cost nothing, and no name is given that is not right
  refuse,     ///< not accepted by the fit, BAD-DATA or refused by explain
  agree       ///< accepted and PASS, or neither
};

struct RealRun {
  PoseTable table{};
  /// The same run, seed for seed, of a plain rig: white noise, nothing hidden, the table exact to 0.1
  /// degrees.
  PoseTable plain{};
  rig::RigTruth truth{}, plain_truth{};
};

struct RealKind {
  std::string name;  ///< as --kind takes it
  std::string what;  ///< for the page
  Must must{Must::pass};
  std::vector<std::string> right{};  ///< names that are right
  bool parameters{true};  ///< the twelve of each sensor are what they were: the covariance can be judged
  std::function<RealRun(std::uint64_t seed)> make{};
  /// A uniform field shows what the calibration is worth: no part of what is hidden goes into matrix or
  /// offset, as a neighbour's field and the mean of a current do.
  bool tensor{true};
  double d{0};  ///< size in units of its own uncertainty, where that was given
};

/// Noise, designs, wrong readings, disturbances, laws, mistakes: every line of the page.
[[nodiscard]] const std::vector<RealKind>& real_kinds();
/// Effects of the site, of sizes in units of their own uncertainty.
[[nodiscard]] const std::vector<RealKind>& site_kinds();

/// "walk" stands for walk-0.3, walk-1 ...
[[nodiscard]] inline bool is_called(const RealKind& kind, const std::string& name) {
  return kind.name == name || kind.name.starts_with(name + "-");
}

}  // namespace mgtd::calib::testing
