// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proto/error.h"

/// A run file keeps what `mgt discover --keep` found on the run (document "discovery"): the object of the
/// search (mgt.discover/1), and of which poses and which model that was asked. A later search takes its
/// place.
namespace mgtd::daemon::store {

inline constexpr std::string_view kDiscoveryDocument = "discovery";

struct KeptDiscovery {
  std::string data_hash;           ///< of the poses that were searched
  std::vector<std::string> model;  ///< effects that were in the model, as specs
  std::string at;                  ///< UTC, "2026-05-01T10:00:00Z"
  nlohmann::json found;            ///< mgt.discover/1
};

[[nodiscard]] std::string to_text(const KeptDiscovery& kept);
[[nodiscard]] Result<KeptDiscovery> discovery_from_text(const std::string& text);

}  // namespace mgtd::daemon::store
