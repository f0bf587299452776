// SPDX-License-Identifier: Apache-2.0
// Whatever a file holds that is given as a pose table: what is accepted survives being written and read
// again, its numbers are finite, and what is refused is refused with a place and a remedy.
#include <cstdint>
#include <string_view>

#include "calib/poses/pose_table.h"
#include "tests/fuzz/require.h"

namespace {

using mgtd::testing::require;

void as_measured(std::string_view text) {
  const auto table = mgtd::calib::poses::parse_pose_table(text, "poses.csv");
  if (!table) {
    require(table.error().message.find("poses.csv") != std::string::npos && !table.error().remedy.empty());
    return;
  }
  for (const mgtd::Pose& pose : table->poses) {
    for (const auto& y : pose.y_nT) require(y.allFinite());
  }
  const std::string written = mgtd::calib::poses::format_pose_table(*table);
  const auto again = mgtd::calib::poses::parse_pose_table(written, "again.csv");
  require(again.has_value() && mgtd::calib::poses::format_pose_table(*again) == written);
  require(mgtd::calib::poses::data_hash(*again) == mgtd::calib::poses::data_hash(*table));
}

void as_planned(std::string_view text) {
  const auto list = mgtd::calib::poses::parse_pose_list(text, "poses.csv");
  if (!list) return;
  for (const mgtd::Pose& pose : list->poses) require(pose.angles().has_value());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  as_measured(text);
  as_planned(text);
  return 0;
}
