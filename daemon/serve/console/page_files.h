// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string_view>

namespace mgtd::daemon::serve::console {

struct PageFile {
  std::string_view type;  ///< of its contents: "text/css"
  std::string_view bytes;
};

/// page_file() returns a file of page/ as it was when the daemon was built; nothing where there is none of
/// that name.
[[nodiscard]] std::optional<PageFile> page_file(std::string_view name);

}  // namespace mgtd::daemon::serve::console
