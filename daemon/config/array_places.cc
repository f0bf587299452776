// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/array_places.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "daemon/config/toml_settings.h"

namespace mgtd::daemon::config {
namespace {

constexpr const char* kRemedy =
    "write the places of the sensors in metres: [array] positions_m = [[0.2, 0, 0], [0, 0.2, 0], ...]";

class PlacesReader {
 public:
  explicit PlacesReader(std::vector<drivers::SettingError>& mistakes) : mistakes_(mistakes) {}

  std::optional<calib::sensor::Geometry> read(const toml::node& section) {
    const toml::table* const table = section.as_table();
    if (table == nullptr) {
      complain(section, "'array' must be a section [array]");
      return std::nullopt;
    }
    const std::size_t before = mistakes_.size();
    for (const auto& [key, node] : *table) {
      if (key != "positions_m")
        mistakes_.push_back({place_of(key.source()),
                             fmt::format("[array]: unknown key '{}'; there is positions_m", key.str())});
    }
    const toml::node* const list = table->get("positions_m");
    if (list == nullptr)
      complain(section, "[array]: positions_m is missing");
    else
      read_places(*list);
    if (mistakes_.size() > before) return std::nullopt;
    return calib::sensor::Geometry(places_P_m_);
  }

 private:
  void complain(const toml::node& where, std::string message) {
    mistakes_.push_back({place_of(where.source()), std::move(message)});
  }

  void read_places(const toml::node& list) {
    const toml::array* const places = list.as_array();
    const std::size_t count = places == nullptr ? 0 : places->size();
    if (count < 1 || count > static_cast<std::size_t>(kMostSensors)) {
      complain(list, places == nullptr
                         ? std::string("[array]: positions_m must be a list of places [x, y, z]")
                         : fmt::format("[array]: positions_m holds {} places; an array has 1 to {} sensors",
                                       count, kMostSensors));
      return;
    }
    places_P_m_ = PerSensor<Eigen::Vector3d>(count);
    for (std::size_t i = 0; i < count; ++i) {
      const auto place = read_place((*places)[i]);
      if (!place) {
        complain(
            (*places)[i],
            fmt::format("[array]: the place of s{} must be [x, y, z], in m and within {} m of the origin",
                        i + 1, kFarthest_m));
        return;
      }
      places_P_m_[i] = *place;
      for (std::size_t j = 0; j < i; ++j) {
        if (places_P_m_[j] == *place)
          complain((*places)[i], fmt::format("[array]: s{} stands where s{} is", i + 1, j + 1));
      }
    }
  }

  static std::optional<Eigen::Vector3d> read_place(const toml::node& node) {
    const toml::array* const xyz = node.as_array();
    if (xyz == nullptr || xyz->size() != 3) return std::nullopt;
    Eigen::Vector3d out;
    for (std::size_t a = 0; a < 3; ++a) {
      const toml::node& number = (*xyz)[a];
      const auto value = number.is_number() ? number.value<double>() : std::nullopt;
      if (!value || !(std::abs(*value) <= kFarthest_m)) return std::nullopt;
      out[static_cast<Eigen::Index>(a)] = *value;
    }
    return out;
  }

  std::vector<drivers::SettingError>& mistakes_;
  PerSensor<Eigen::Vector3d> places_P_m_{};
};

}  // namespace

std::optional<calib::sensor::Geometry> read_array(const toml::table& root,
                                                  std::vector<drivers::SettingError>& mistakes) {
  const toml::node* const section = root.get("array");
  if (section == nullptr) return std::nullopt;
  if (root["rig"]["baseline_m"]) {
    mistakes.push_back({place_of(section->source()),
                        "[array]: baseline_m in [rig] says the places of a cross; leave one of the two out"});
    return std::nullopt;
  }
  return PlacesReader(mistakes).read(*section);
}

Result<calib::sensor::Geometry> array_from_text(std::string_view text, const std::string& file) {
  const auto root = parse_toml(text, file);
  if (!root) return fail(ErrorCode::bad_input, root.error(), kRemedy);
  std::vector<drivers::SettingError> mistakes;
  const auto geometry = read_array(*root, mistakes);
  if (geometry) return *geometry;
  if (mistakes.empty()) mistakes.push_back({drivers::Place(1), "there is no section [array]"});
  std::vector<std::string> lines;
  for (const drivers::SettingError& m : mistakes)
    lines.push_back(fmt::format("{}:{}:{}: {}", file, m.line, m.column, m.message));
  return fail(ErrorCode::bad_input, fmt::format("{}", fmt::join(lines, "\n")), kRemedy);
}

}  // namespace mgtd::daemon::config
