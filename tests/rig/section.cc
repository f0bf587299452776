// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/section.h"

#include <fmt/format.h>

#include <cmath>

namespace mgtd::rig {

Section::Section(const toml::node* node, std::string name, std::vector<Mistake>& mistakes,
                 std::size_t sensors)
    : node_(node), name_(std::move(name)), mistakes_(mistakes), sensors_(sensors) {
  if (node_ == nullptr) return;
  table_ = node_->as_table();
  if (table_ == nullptr) complain("", "must be a table of keys");
}

void Section::complain(std::string_view key, const std::string& what) {
  const toml::node* at = table_ == nullptr ? nullptr : table_->get(key);
  if (at == nullptr) at = node_;
  mistakes_.push_back({at == nullptr ? 1U : at->source().begin.line, fmt::format("[{}] {}", name_, what)});
}

const toml::node* Section::find(std::string_view key) {
  asked_.insert(std::string(key));
  return table_ == nullptr ? nullptr : table_->get(key);
}

void Section::need(std::string_view key) {
  if (find(key) == nullptr) complain("", fmt::format("{} is missing", key));
}

void Section::read(std::string_view key, std::string& value) {
  const toml::node* const node = find(key);
  if (node == nullptr) return;
  if (!node->is_string()) return complain(key, fmt::format("{} must be a text in quotes", key));
  value = *node->value<std::string>();
}

void Section::read(std::string_view key, bool& value) {
  const toml::node* const node = find(key);
  if (node == nullptr) return;
  if (!node->is_boolean()) return complain(key, fmt::format("{} must be true or false", key));
  value = *node->value<bool>();
}

void Section::read(std::string_view key, std::uint64_t& value) {
  const toml::node* const node = find(key);
  if (node == nullptr) return;
  if (!node->is_integer() || *node->value<std::int64_t>() < 0)
    return complain(key, fmt::format("{} must be a whole number, 0 or more", key));
  value = static_cast<std::uint64_t>(*node->value<std::int64_t>());
}

void Section::read(std::string_view key, double& value, const Limits& limits) {
  const toml::node* const node = find(key);
  if (node == nullptr) return;
  if (!node->is_number() || !std::isfinite(*node->value<double>()))
    return complain(key, fmt::format("{} must be a number", key));
  const double got = *node->value<double>();
  if (got < limits.least || got > limits.most)
    return complain(key, fmt::format("{} = {} must be from {} to {}", key, got, limits.least, limits.most));
  value = got;
}

void Section::read_list(std::string_view key, double* value, std::size_t n) {
  const toml::node* const node = find(key);
  if (node == nullptr) return;
  const toml::array* const list = node->as_array();
  bool good = list != nullptr && list->size() == n;
  for (std::size_t i = 0; good && i < n; ++i) {
    const toml::node& item = *list->get(i);
    good = item.is_number() && std::isfinite(*item.value<double>());
    if (good) value[i] = *item.value<double>();
  }
  if (!good) complain(key, fmt::format("{} must be a list of {} numbers", key, n));
}

void Section::read(std::string_view key, std::vector<double>& value) {
  if (find(key) == nullptr) return;
  value.resize(sensors_);
  read_list(key, value.data(), sensors_);
}

bool Section::read_places(std::string_view key, std::vector<Eigen::Vector3d>& value) {
  const toml::node* const node = find(key);
  if (node == nullptr) return false;
  const toml::array* const list = node->as_array();
  bool good = list != nullptr;
  std::vector<Eigen::Vector3d> read;
  for (std::size_t i = 0; good && i < list->size(); ++i) {
    const toml::array* const place = list->get(i)->as_array();
    good = place != nullptr && place->size() == 3;
    Eigen::Vector3d x(0, 0, 0);
    for (std::size_t a = 0; good && a < 3; ++a) {
      const toml::node& item = *place->get(a);
      good = item.is_number() && std::isfinite(*item.value<double>());
      if (good) x[static_cast<Eigen::Index>(a)] = *item.value<double>();
    }
    if (good) read.push_back(x);
  }
  if (!good) complain(key, fmt::format("{} must be a list of places, each [x, y, z]", key));
  if (good) value = std::move(read);
  return good;
}

std::vector<double> Section::numbers(std::string_view key, std::size_t count, double fallback) {
  std::vector<double> out(count, std::isnan(fallback) ? 0 : fallback);
  if (std::isnan(fallback)) need(key);
  if (count == 1) {
    read(key, out[0]);
  } else {
    read_list(key, out.data(), count);
  }
  return out;
}

Where Section::where(std::string_view key) {
  std::string text = "all";
  read(key, text);
  const auto where = Where::parse(text, sensors_);
  if (!where) {
    complain(key, fmt::format("{0} = '{1}' must be all, s1 .. s{2} or s1.x .. s{2}.z", key, text, sensors_));
  }
  return where.value_or(Where{});
}

void Section::refuse_rest() {
  if (table_ == nullptr || accept_rest_) return;
  for (const auto& [key, node] : *table_) {
    if (!asked_.contains(std::string(key.str()))) {
      complain(key.str(), fmt::format("unknown key '{}'; there are: {}", key.str(), fmt::join(asked_, ", ")));
    }
  }
}

}  // namespace mgtd::rig
