// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>

/// The operator of a simulated rig waits for what a daemon asks, does it on the rig, and enters what the
/// scales then say. It warms the heads and switches a coil on where a run asks for that.
namespace mgtd::rig {

struct OperatorOptions {
  std::string dir;      ///< of the rig
  std::string control;  ///< the daemon's control socket
  double error_deg{1};  ///< things are set to this; the scales are read to a tenth of a degree
  int blunder{0};       ///< at this prompt the roll is misread by 30 degrees, once
  std::uint64_t seed{1};
  bool magnet{false};  ///< holds a magnet where a magnet test asks for it, instead
};

/// Until the run, or the magnet test, ends. Exit code: 0 it is done, 1 it ended otherwise or paused, 3 nobody
/// is there.
[[nodiscard]] int operate(const OperatorOptions& options);

}  // namespace mgtd::rig
