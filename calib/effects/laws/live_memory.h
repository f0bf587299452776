// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/effects/laws/run_memory.h"

/// A LiveMemory follows what the sensors saw so far, for effects with a memory that are removed from a
/// stream: sample after sample, where run_memory.h has pose after pose. Until it has seen enough its state is
/// unknown, and the effect says so (Effect::missing).
namespace mgtd::calib::effects::laws {

class LiveMemory {
 public:
  virtual ~LiveMemory() = default;
  /// v = readings less offsets, of all sensors at one time; times do not go back. Where too long is missing
  /// between two samples the array may have been anywhere, and the memory starts over.
  void follow(double t_s, const SensorReadings& v_nT) {
    if (!begun_ || t_s - last_s_ > kLost_s) {
      begin(t_s, v_nT);
    } else {
      step(t_s - last_s_, v_nT);
    }
    begun_ = true;
    last_s_ = t_s;
  }
  [[nodiscard]] bool begun() const { return begun_; }

 protected:
  virtual void begin(double t_s, const SensorReadings& v_nT) = 0;
  virtual void step(double dt_s, const SensorReadings& v_nT) = 0;
  [[nodiscard]] double last_s() const { return last_s_; }

 private:
  static constexpr double kLost_s = 2;  ///< a turn and back by hand takes longer
  bool begun_{false};
  double last_s_{0};
};

}  // namespace mgtd::calib::effects::laws
