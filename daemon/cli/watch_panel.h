// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

/// WatchPanel writes the panel that `mgt watch` shows on a terminal: the last sample of the stream with its
/// standard deviations, the devices, the judgement of the calibration, what was missed, and a run that is
/// going on. It makes text from the objects of the stream and draws nothing.
namespace mgtd::daemon::cli {

class WatchPanel {
 public:
  /// An object of the stream; classes without a place in the panel change nothing.
  void take(const nlohmann::json& object);
  /// The panel as lines. `width` is the room for the bar of a run.
  [[nodiscard]] std::string text(int width) const;

 private:
  [[nodiscard]] std::string sample_text() const;
  [[nodiscard]] std::string status_text(int width) const;

  nlohmann::json sample_, status_;  ///< the last of each; null: none yet
  std::uint64_t missed_{0};         ///< epochs of gaps since the beginning
  std::string last_gap_;            ///< why the last epochs are missing
};

/// "x 12.50, y -3.10, z 0.40 nT/m along the line" of a sample of sensors on one line, the derivative of the
/// field along that line, with its largest standard deviation where one is known; empty of any other array.
[[nodiscard]] std::string along_line_text(const nlohmann::json& sample);

/// The first lines of the text, as many as a terminal of so many rows holds above its cursor: over what has
/// scrolled away the cursor does not come back. Where lines are left out, the last one says so.
[[nodiscard]] std::string top_of(const std::string& text, std::size_t rows);

/// What moves the cursor of a terminal back to the first of `lines` lines and removes them. The lines that
/// are printed then stand in their place.
[[nodiscard]] std::string back_over(std::size_t lines);

}  // namespace mgtd::daemon::cli
