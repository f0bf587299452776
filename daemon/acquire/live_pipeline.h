// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "calib/calibration/live_tensor.h"
#include "calib/criticism/live/live_criticism.h"
#include "calib/criticism/tests/rearrangement.h"
#include "calib/report/live_report.h"
#include "daemon/acquire/instrument_watch.h"
#include "daemon/acquire/latest_inputs.h"
#include "daemon/acquire/sampler.h"
#include "daemon/config/config.h"

/// A LivePipeline turns readings into what is streamed: epochs, the tensor with the active calibration, and
/// what the stream says of that calibration. Where a sensor is not the one that was calibrated in its place,
/// by what the devices tell or by what the readings show, the samples are raw and say `identity`. Pure: the
/// daemon and the replay of a journal run the very same, and from the same readings, ticks and orders it
/// makes the same samples to the last bit.
namespace mgtd::daemon::acquire {

/// As the configuration wants it.
[[nodiscard]] SamplerConfig sampler_config(const config::Config& config);
/// The auxiliary inputs and thermometers of all devices, in the order of the configuration.
[[nodiscard]] LatestInputs inputs_of(const config::Config& config);

class LivePipeline {
 public:
  LivePipeline(const SamplerConfig& sampler, const calib::sensor::Geometry& array,
               LatestInputs inputs = LatestInputs());

  /// From the next epoch on; null: the samples are raw and say so.
  void use(std::shared_ptr<const calib::calibration::Calibration> calibration);
  /// A run has the table, or no longer.
  void set_calibrating(bool on) { calibrating_ = on; }

  /// Who answers in the place of a sensor: to be told before its readings, as often as one likes.
  void answers(int slot, const std::string& identity);
  void push(const FieldReading& reading) { sampler_.push(reading, ready_); }
  void push(const TemperatureReading& reading) {
    sampler_.push(reading);
    inputs_.push(reading);
  }
  void push(const AuxiliaryReading& reading) { inputs_.push(reading); }
  void push(const TableReading& reading) { table_ = reading; }
  void reopened(int slot) { sampler_.reopened(slot); }
  void advance(Instant now) { sampler_.advance(now, ready_); }

  /// Shows what became complete: on_epoch(epoch, sample, finding_changed), on_gap(gap).
  template <class OnEpoch, class OnGap>
  void deliver(OnEpoch on_epoch, OnGap on_gap) {
    for (const EpochOrGap& item : ready_) {
      if (const auto* epoch = std::get_if<Epoch>(&item)) {
        bool changed = false;
        const TensorSample sample = tensor(*epoch, changed);
        on_epoch(*epoch, sample, changed);
      } else {
        on_gap(std::get<Gap>(item));
      }
    }
    ready_.clear();
  }

  [[nodiscard]] const Sampler& sampler() const { return sampler_; }
  [[nodiscard]] const LatestInputs& inputs() const { return inputs_; }
  [[nodiscard]] const calib::calibration::LiveTensor& live() const { return live_; }
  /// What the samples show of the calibration; a sensor in another place before all that follows from it.
  [[nodiscard]] calib::report::LiveReport finding() const {
    return calib::report::live_report(criticism_.finding(), rearranged_.finding());
  }
  /// Where a referenced table stands still; empty while it moves, or has said nothing for ten seconds.
  [[nodiscard]] std::optional<TableAngles> standing_angles(Instant at) const;
  [[nodiscard]] const InstrumentWatch& instruments() const { return instruments_; }

 private:
  [[nodiscard]] TensorSample tensor(const Epoch& epoch, bool& finding_changed);
  [[nodiscard]] TensorSample judged(const Epoch& epoch, bool& finding_changed);
  [[nodiscard]] calib::calibration::LiveConditions conditions(Instant at) const;

  calib::sensor::Geometry array_;
  Sampler sampler_;
  calib::calibration::LiveTensor live_;
  calib::calibration::TensorPipeline raw_;
  calib::criticism::live::LiveCriticism criticism_;
  calib::criticism::tests::RearrangementWatch rearranged_;
  InstrumentWatch instruments_;
  PerSensor<std::string> answering_;   ///< who answers
  std::optional<TableReading> table_;  ///< the last
  LatestInputs inputs_;
  bool calibrating_{false};
  std::vector<EpochOrGap> ready_;  ///< reused, so that a sample allocates nothing
};

}  // namespace mgtd::daemon::acquire
