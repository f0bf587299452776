// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "proto/instrument_identity.h"

/// An InstrumentWatch tells whether the sensors that answer are those that a calibration, or a run, was made
/// with. Pure: who answers where comes in, the places with another sensor come out.
///
/// Two devices are the same where both tell the same serial number; one that tells none is another one where
/// its model differs, and is not judged where it does not. Only sensors are judged: a table or a
/// scalar reference that was replaced measures the same field.
namespace mgtd::daemon::acquire {

/// How the sentences speak of what is wanted.
struct WantedBy {
  std::string_view as;       ///< "calibrated as"
  std::string_view with;     ///< "the calibration was made with"
  std::string_view new_one;  ///< what to do where a device was replaced
};
inline constexpr WantedBy kByCalibration{"calibrated as", "the calibration was made with",
                                         "put that one back, or calibrate anew and accept it"};
inline constexpr WantedBy kByRun{"measured as", "this run was begun with",
                                 "put that one back, or abort this run and begin another"};

class InstrumentWatch {
 public:
  explicit InstrumentWatch(WantedBy by = kByCalibration) : by_(by) {}

  /// Of a calibration or run; an empty list judges nothing.
  void want(const std::vector<InstrumentIdentity>& instruments);
  /// `who` answers in its place now.
  void answers(const InstrumentIdentity& who);

  [[nodiscard]] bool wants() const { return !wanted_.empty(); }
  /// Places, in their order, where another one answers; empty: none does, as far as it is known.
  [[nodiscard]] std::vector<std::string> others() const;
  [[nodiscard]] bool another() const { return another_; }
  /// "s2 and s4 are exchanged: the device with serial number 1002, calibrated as s2, now answers on the port
  /// of s4, ..."; empty while another() is false.
  [[nodiscard]] std::string measured() const;
  [[nodiscard]] std::string remedy() const;

 private:
  /// s2 before s10.
  struct InOrder {
    bool operator()(const std::string& a, const std::string& b) const {
      return std::pair(a.size(), std::string_view(a)) < std::pair(b.size(), std::string_view(b));
    }
  };
  using ByPlace = std::map<std::string, InstrumentIdentity, InOrder>;
  [[nodiscard]] bool is_another(const InstrumentIdentity& wanted) const;
  /// The place in which a device is wanted; empty: in none.
  [[nodiscard]] std::string home_of(const InstrumentIdentity& who) const;
  [[nodiscard]] std::string sentence(const std::string& place) const;

  WantedBy by_;
  ByPlace wanted_, answering_;
  bool another_{false};
};

}  // namespace mgtd::daemon::acquire
