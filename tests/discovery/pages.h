// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>

/// Sections of docs/discovery-benchmark.md. What is worth a second look goes to standard error.
namespace mgtd::calib::testing {

struct Extent {
  int clean{1000};  ///< runs with nothing hidden; a quarter of each other kind of noise
  int runs{60};     ///< of each cell
  int draws{2000};
  std::uint64_t first_seed{0};
  std::string law{".*"};  ///< regular expression of the laws that are hidden
  std::string answers{};  ///< path of an answer file; empty: none
};

[[nodiscard]] std::string clean_page(const Extent& extent);
[[nodiscard]] std::string laws_page(const Extent& extent);
[[nodiscard]] std::string rising_page(const Extent& extent);
[[nodiscard]] std::string lawless_page(const Extent& extent);

}  // namespace mgtd::calib::testing
