// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

/// This writes docs/blind-benchmark.md, section by section. Each runs its own campaign.
namespace mgtd::calib::testing {

struct Sizes {
  int clean{1000};  ///< runs of each kind of noise
  int runs{60};     ///< of each cell
  // Of the runs from the simulated rig:
  int real{200};                     ///< of each kind
  std::vector<std::string> kinds{};  ///< empty: all of them
  std::uint64_t first_seed{1};       ///< of each kind
  std::string keep{};                ///< folder for the pose tables of runs that went wrong; empty: none
  std::string answers{};             ///< file of answers that goes on growing; empty: none
};

[[nodiscard]] std::string clean_page(const Sizes& n);
[[nodiscard]] std::string naming_page(const Sizes& n);
[[nodiscard]] std::string one_sensor_page(const Sizes& n);
[[nodiscard]] std::string two_page(const Sizes& n);
[[nodiscard]] std::string open_page(const Sizes& n);
[[nodiscard]] std::string oracle_page(const Sizes& n);
[[nodiscard]] std::string one_field_page(const Sizes& n);
[[nodiscard]] std::string paper_page(const Sizes& n);
[[nodiscard]] std::string real_noise_page(const Sizes& n);
[[nodiscard]] std::string site_page(const Sizes& n);

/// "97.3 (95.1-98.5)": percent with its 95 % interval; "-" of nothing.
[[nodiscard]] std::string percent(int hits, int of);

}  // namespace mgtd::calib::testing
