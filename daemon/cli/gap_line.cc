// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/gap_line.h"

#include <fmt/format.h>

#include <algorithm>

namespace mgtd::daemon::cli {

void GapLine::add(std::uint64_t from_seq, std::uint64_t to_seq, const std::string& why) {
  from_ = empty() ? from_seq : std::min(from_, from_seq);
  to_ = empty() ? to_seq : std::max(to_, to_seq);
  count_ += to_seq - from_seq + 1;
  if (std::find(why_.begin(), why_.end(), why) == why_.end()) why_.push_back(why);
}

std::string GapLine::text() const {
  const std::string why = fmt::format("{}", fmt::join(why_, ", "));
  if (count_ == 1) return fmt::format("gap: sample {} is missing: {}", from_, why);
  const bool all = count_ == to_ - from_ + 1;
  return fmt::format("gap: {} samples{} {} to {}{} are missing: {}", count_, all ? "," : " of", from_, to_,
                     all ? "," : "", why);
}

}  // namespace mgtd::daemon::cli
