// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/pose_numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "proto/number.h"
#include "proto/pose_numbers_text.h"

namespace mgtd::daemon::store {
namespace {

constexpr std::int64_t kMostNumbers = 100'000;

std::optional<std::int64_t> pose_number(std::string_view text) {
  const auto number = parse_integer(text);
  if (!number || *number < 0 || *number > std::numeric_limits<int>::max()) return std::nullopt;
  return number;
}

}  // namespace

Result<std::set<int>> parse_pose_numbers(std::string_view text) {
  std::string bare;
  std::copy_if(text.begin(), text.end(), std::back_inserter(bare), [](char c) { return c != ' '; });
  const auto refused = [&] {
    return fail(ErrorCode::usage, fmt::format("'{}' is no list of poses", text),
                "write numbers of poses, and ranges of them: 3,7-9");
  };
  std::set<int> out;
  std::size_t at = 0;
  while (at <= bare.size()) {
    const std::size_t end = std::min(bare.find(',', at), bare.size());
    const std::string_view part = std::string_view(bare).substr(at, end - at);
    const std::size_t dash = part.find('-', 1);
    const auto first = pose_number(part.substr(0, dash));
    const auto last = dash == std::string_view::npos ? first : pose_number(part.substr(dash + 1));
    if (!first || !last || *last < *first || *last - *first >= kMostNumbers) return refused();
    for (std::int64_t number = *first; number <= *last; ++number) out.insert(static_cast<int>(number));
    at = end + 1;
  }
  return out;
}

Result<PoseTable> without_poses(PoseTable table, const std::set<int>& numbers) {
  std::set<int> left = numbers;
  std::erase_if(table.poses, [&](const Pose& pose) {
    left.erase(pose.number);
    return numbers.contains(pose.number);
  });
  if (!left.empty()) {
    return fail(ErrorCode::usage,
                fmt::format("{} has no pose {}", table.source.empty() ? "the table" : table.source,
                            pose_numbers_text(left)),
                "poses go by the numbers in the column pose; those masked already are not there");
  }
  return table;
}

}  // namespace mgtd::daemon::store
