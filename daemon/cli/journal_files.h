// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "proto/error.h"

/// journals_of() puts the files of raw journals in the order they were written and says which of them a
/// replay can play: those of a start of the daemon from its first file on, as far as none between is missing.
/// What the limits on the journal's space and age have removed from the front of a long life takes the rest
/// of that life with it: what drivers and clocks had learnt by then is in no later file.
namespace mgtd::daemon::cli {

struct Journals {
  std::vector<std::string> play;
  std::vector<Error> left_out;  ///< files that cannot be played, for each life that has some: why, what to do
};

/// Refuses what is no journal, and files of which none can be played.
[[nodiscard]] Result<Journals> journals_of(const std::vector<std::string>& paths);

}  // namespace mgtd::daemon::cli
