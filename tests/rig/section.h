// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <toml++/toml.h>

#include <array>
#include <limits>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tests/rig/effect.h"

/// A Section is one table of a scenario file while it is read: every mistake is noted with its line, every
/// key that was asked for is remembered, so that the others can be named.
namespace mgtd::rig {

/// What is wrong with a scenario file, and where.
struct Mistake {
  unsigned line;
  std::string text;
};

struct Limits {
  double least{-std::numeric_limits<double>::max()};
  double most{std::numeric_limits<double>::max()};
};

class Section {
 public:
  /// `node` null: the section is not there and every key keeps its value. `sensors`: of the array.
  Section(const toml::node* node, std::string name, std::vector<Mistake>& mistakes,
          std::size_t sensors = kCross);

  [[nodiscard]] std::size_t sensors() const { return sensors_; }
  [[nodiscard]] bool is_there() const { return node_ != nullptr; }
  [[nodiscard]] bool has(std::string_view key) const {
    return table_ != nullptr && table_->get(key) != nullptr;
  }

  /// An absent key leaves the value as it is.
  void read(std::string_view key, std::string& value);
  void read(std::string_view key, bool& value);
  void read(std::string_view key, std::uint64_t& value);
  void read(std::string_view key, double& value, const Limits& limits = {});
  template <std::size_t N>
  void read(std::string_view key, std::array<double, N>& value) {
    read_list(key, value.data(), N);
  }

  /// A list with one number for each sensor.
  void read(std::string_view key, std::vector<double>& value);
  /// A list of places: lists of three numbers each. False: absent, or a mistake was noted.
  [[nodiscard]] bool read_places(std::string_view key, std::vector<Eigen::Vector3d>& value);

  /// A number or a list of `count`; absent: as many fallbacks, or a mistake when the fallback is NaN.
  [[nodiscard]] std::vector<double> numbers(std::string_view key, std::size_t count, double fallback);
  /// All axes when the key is absent.
  [[nodiscard]] Where where(std::string_view key = "where");

  /// Notes a mistake at the line of the key, or of the section when it is not there.
  void complain(std::string_view key, const std::string& what);
  /// Complains about every key nobody asked for.
  void refuse_rest();
  void accept_rest() { accept_rest_ = true; }

 private:
  const toml::node* find(std::string_view key);
  void need(std::string_view key);
  void read_list(std::string_view key, double* value, std::size_t n);

  const toml::node* node_;
  const toml::table* table_{nullptr};
  std::string name_;
  std::vector<Mistake>& mistakes_;
  std::size_t sensors_;
  std::set<std::string> asked_;
  bool accept_rest_{false};
};

}  // namespace mgtd::rig
