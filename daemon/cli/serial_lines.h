// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>
#include <string_view>
#include <vector>

/// with_serials() writes the key `serial` of each instrument into the text of a configuration. Everything
/// else, comments included, stays as it was written.
namespace mgtd::daemon::cli {

struct SerialLines {
  std::string text;
  std::vector<std::string> written;  ///< places whose serial number was filled in
  std::vector<std::string> stated;   ///< that had one already, which is left as it is
};

/// `serials` by place ("s1" .. "s4", "table", "scalar"). In the section of each place an empty `serial = ""`
/// is filled in; where there is none, a line is put below `port`. A place whose section or port is not found
/// is left out.
[[nodiscard]] SerialLines with_serials(std::string_view text,
                                       const std::map<std::string, std::string>& serials);

/// "1002" out of what a device of that driver says of itself; empty: it does not tell.
[[nodiscard]] std::string stated_serial(std::string_view driver, const std::string& identity);

}  // namespace mgtd::daemon::cli
