// SPDX-License-Identifier: Apache-2.0
#include "calib/calibration/calibration_json.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "calib/effects/library/library.h"
#include "proto/json_text.h"
#include "proto/sha256.h"

namespace mgtd::calib::calibration {
namespace {

using nlohmann::json;
constexpr const char* kSchema = "mgt.cal/1";

json rows(const AxisNoise& noise) {
  json out = json::array();
  for (Eigen::Index i = 0; i < noise.rows(); ++i) out.push_back({noise(i, 0), noise(i, 1), noise(i, 2)});
  return out;
}

AxisNoise noise_from(const json& object) {
  AxisNoise noise(static_cast<Eigen::Index>(object.size()), 3);
  for (std::size_t i = 0; i < object.size(); ++i) {
    for (std::size_t a = 0; a < 3; ++a)
      noise(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(a)) = object.at(i).at(a);
  }
  return noise;
}

json sensor_json(const sensor::SensorModel& s) {
  const sensor::ParameterVector p = s.parameters();
  json out;
  for (int k = 0; k < sensor::kSensorParameters; ++k) {
    const std::string name(sensor::kParameterNames[static_cast<std::size_t>(k)]);
    const bool is_scale = k >= sensor::cx && k <= sensor::cz;
    const bool is_offset = k >= sensor::ix && k <= sensor::iz;
    out[name + (is_scale ? "" : is_offset ? "_nT" : "_rad")] = p[k];
  }
  json mounting = json::array();
  for (int i = 0; i < 3; ++i) mounting.push_back({s.mounting(i, 0), s.mounting(i, 1), s.mounting(i, 2)});
  out["mounting"] = std::move(mounting);
  return out;
}

sensor::SensorModel sensor_from_json(const json& object) {
  sensor::ParameterVector p;
  for (int k = 0; k < sensor::kSensorParameters; ++k) {
    const std::string name(sensor::kParameterNames[static_cast<std::size_t>(k)]);
    const bool is_scale = k >= sensor::cx && k <= sensor::cz;
    const bool is_offset = k >= sensor::ix && k <= sensor::iz;
    p[k] = object.at(name + (is_scale ? "" : is_offset ? "_nT" : "_rad"));
  }
  Eigen::Matrix3d mounting;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      mounting(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
          object.at("mounting").at(i).at(j);
    }
  }
  return sensor::SensorModel::from_parameters(p, mounting);
}

json triangle(const Eigen::MatrixXd& c) {
  json out = json::array();
  for (Eigen::Index i = 0; i < c.rows(); ++i) {
    for (Eigen::Index j = i; j < c.rows(); ++j) out.push_back(c(i, j));
  }
  return out;
}

Eigen::MatrixXd covariance_from(const json& list, Eigen::Index n) {
  Eigen::MatrixXd c(n, n);
  std::size_t k = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = i; j < n; ++j) c(i, j) = c(j, i) = list.at(k++).get<double>();
  }
  return c;
}

json effects_json(const std::vector<CalibratedEffect>& effects) {
  json out = json::array();
  for (const CalibratedEffect& e : effects) {
    json coefficients = json::array();
    for (const EffectCoefficient& c : e.coefficients) {
      coefficients.push_back({{"name", c.name}, {"value", c.value}, {"sd", c.sd}, {"unit", c.unit}});
    }
    out.push_back({{"effect", e.effect},
                   {"coefficients", std::move(coefficients)},
                   {"size_nT", std::vector<double>(e.size_nT.begin(), e.size_nT.end())}});
  }
  return out;
}

sensor::FieldVector vector_from(const json& list) {
  const auto values = list.get<std::vector<double>>();
  if (values.size() > static_cast<std::size_t>(sensor::kMostChannels))
    throw json::out_of_range::create(401, "size_nT: more values than channels", &list);
  return sensor::FieldVector::Map(values.data(), static_cast<Eigen::Index>(values.size()));
}

std::vector<CalibratedEffect> effects_from(const json& list) {
  std::vector<CalibratedEffect> out;
  for (const json& e : list) {
    CalibratedEffect effect{e.at("effect"), {}, vector_from(e.at("size_nT"))};
    for (const json& c : e.at("coefficients")) {
      effect.coefficients.push_back({c.at("name"), c.at("value"), c.at("sd"), c.at("unit")});
    }
    out.push_back(std::move(effect));
  }
  return out;
}

json matrix_json(const Eigen::MatrixXd& m) {
  json out = json::array();
  for (Eigen::Index i = 0; i < m.rows(); ++i) {
    json row = json::array();
    for (Eigen::Index j = 0; j < m.cols(); ++j) row.push_back(m(i, j));
    out.push_back(std::move(row));
  }
  return out;
}

Eigen::MatrixXd matrix_from(const json& rows, std::size_t columns) {
  Eigen::MatrixXd m(static_cast<Eigen::Index>(rows.size()),
                    rows.empty() ? 0 : static_cast<Eigen::Index>(columns));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t j = 0; j < columns; ++j) {
      m(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = rows.at(i).at(j).get<double>();
    }
  }
  return m;
}

json reference_json(const Reference& r) {
  json T = json::array();
  for (const auto& t : r.T_degC) T.push_back(or_null(t));
  return {{"T_degC", T}, {"t_utc", r.t_utc}, {"F_nT", or_null(r.f_nT)}, {"currents", r.currents_A}};
}

Reference reference_from(const json& object, std::size_t sensors) {
  Reference r;
  r.T_degC.resize(sensors);
  for (std::size_t i = 0; i < sensors; ++i) {
    if (const json& t = object.at("T_degC").at(i); !t.is_null()) r.T_degC.at(i) = t.get<double>();
  }
  r.t_utc = object.at("t_utc");
  r.currents_A = object.at("currents").get<std::map<std::string, double>>();
  if (const json& f = object.at("F_nT"); !f.is_null()) r.f_nT = f.get<double>();
  return r;
}

std::vector<Check> checks_from(const json& list) {
  std::vector<Check> out;
  for (const json& c : list) {
    out.push_back({c.at("name"), c.at("passed"), c.at("measured"), c.at("limit"), c.at("remedy")});
  }
  return out;
}

/// The cross by its baseline, any other array by the places of its sensors.
void put_geometry(const sensor::Geometry& geometry, json& object) {
  if (const auto baseline_m = geometry.cross_baseline_m()) {
    object["baseline_m"] = *baseline_m;
    return;
  }
  json places = json::array();
  for (const Eigen::Vector3d& r_P_m : geometry.positions_P_m())
    places.push_back({r_P_m[0], r_P_m[1], r_P_m[2]});
  object["positions_m"] = std::move(places);
}

sensor::Geometry geometry_from(const json& object, std::size_t sensors) {
  if (!object.contains("positions_m")) return sensor::Geometry(object.at("baseline_m").get<double>());
  PerSensor<Eigen::Vector3d> places_P_m(sensors);
  for (std::size_t i = 0; i < sensors; ++i) {
    const json& place = object.at("positions_m").at(i);
    places_P_m[i] = {place.at(0).get<double>(), place.at(1).get<double>(), place.at(2).get<double>()};
  }
  return sensor::Geometry(places_P_m);
}

/// Its values, whatever they are worth.
Calibration calibration_of(const json& object) {
  Calibration c;
  c.id = object.at("id");
  c.method = object.at("method");
  c.sensors.clear();
  if (object.at("sensors").size() > static_cast<std::size_t>(kMostSensors))
    throw json::out_of_range::create(401, "more sensors than an array can have", &object);
  for (const json& sensor : object.at("sensors")) c.sensors.push_back(sensor_from_json(sensor));
  const Eigen::Index parameters = static_cast<Eigen::Index>(c.sensors.size()) * sensor::kSensorParameters;
  c.covariance = covariance_from(object.at("covariance"), parameters);
  c.effects = effects_from(object.at("effects"));
  const json& rows = object.at("effect_covariance");
  c.effect_covariance = matrix_from(rows, static_cast<std::size_t>(parameters) + rows.size());
  c.geometry = geometry_from(object, c.sensors.size());
  c.sample_noise_nT = noise_from(object.at("sample_noise_nT"));
  c.pose_noise_nT = noise_from(object.at("pose_noise_nT"));
  c.gauge = object.at("gauge");
  c.reference = reference_from(object.at("reference"), c.sensors.size());
  c.data_hash = object.at("data_hash");
  c.poses = object.at("poses");
  c.accepted_by_checks = object.at("accepted");
  c.checks = checks_from(object.at("verdict"));
  c.software = object.at("software");
  return c;
}

/// A calibration with one of everything, as to_json writes it.
json example(const sensor::Geometry& geometry) {
  Calibration c;
  c.geometry = geometry;
  const auto sensors = static_cast<Eigen::Index>(geometry.sensors());
  const Eigen::Index parameters = sensors * sensor::kSensorParameters;
  c.sensors.resize(geometry.sensors());
  c.reference.T_degC.resize(geometry.sensors());
  c.covariance = Eigen::MatrixXd::Zero(parameters, parameters);
  c.sample_noise_nT = c.pose_noise_nT = AxisNoise::Zero(sensors, 3);
  c.effects = {{.effect = "", .coefficients = {{}}, .size_nT = sensor::FieldVector::Zero(3 * sensors)}};
  c.effect_covariance = Eigen::MatrixXd::Zero(1, 1);
  c.checks = {{}};
  return to_json(c);
}

/// So many places, none of them at the origin, as the object has sensors.
sensor::Geometry places_like(const json& object) {
  const json sensors = object.value("sensors", json::array());
  const auto count = std::clamp<std::size_t>(sensors.size(), 1, static_cast<std::size_t>(kMostSensors));
  return sensor::Geometry(PerSensor<Eigen::Vector3d>(count, Eigen::Vector3d::Ones()));
}

/// `text`: what the object was parsed from, where there is one.
Result<Calibration> read(const json& object, std::optional<std::string_view> text) {
  constexpr const char* kRemedy = "give a CAL.json written by mgt fit -o";
  if (object.is_object() && object.value("schema", json()) != kSchema && object.contains("schema"))
    return fail(ErrorCode::bad_input,
                fmt::format("schema {} is not \"{}\"", object["schema"].dump(), kSchema),
                "use the version of mgt that wrote it");
  static const json kCross = example(sensor::Geometry());
  const bool other = object.is_object() && object.contains("positions_m");
  if (const auto wrong = misfit(other ? example(places_like(object)) : kCross, object))
    return fail(ErrorCode::bad_input, "not a calibration: " + (text ? wrong->text(*text) : wrong->what),
                kRemedy);
  // What the example cannot tell (a list that is too short, a temperature that is a text) is left to the
  // library's way of refusing.
  try {
    return calibration_of(object);
  } catch (const json::exception&) {
    return fail(ErrorCode::bad_input,
                "not a calibration: a list is too short, or holds a value of another kind", kRemedy);
  }
}

/// An effect that cannot be made, a content that was changed, a key that means nothing here.
Result<Calibration> checked(const json& object, std::optional<std::string_view> text) {
  auto c = read(object, text);
  if (!c) return c;
  for (const CalibratedEffect& e : c->effects) {
    if (effects::library::make_effect(e.effect, static_cast<int>(c->sensors.size()))) continue;
    return fail(ErrorCode::bad_input,
                fmt::format("it holds an effect that this version cannot remove: {}", e.effect),
                "use the version of mgt that wrote it");
  }
  const std::string found = content_id(object);
  if (c->id != found) {
    return fail(ErrorCode::bad_input,
                fmt::format("the content was changed: it hashes to {}, the file says {}", found, c->id),
                "a calibration is never edited; fit again instead");
  }
  if (const json more = json::diff(to_json(*c), object); !more.empty()) {
    return fail(ErrorCode::bad_input,
                fmt::format("it holds what this version does not know: {}",
                            more.front().at("path").get_ref<const std::string&>()),
                "use the version of mgt that wrote it");
  }
  // A 9 in the place of a 9.0 is the same number and another text: written again it would have another id.
  if (content_id(to_json(*c)) != found) {
    return fail(ErrorCode::bad_input, "its numbers are not written as mgt writes them",
                "a calibration is never edited; fit again instead");
  }
  return c;
}

}  // namespace

json to_json(const std::vector<Check>& checks) {
  json out = json::array();
  for (const Check& c : checks) {
    out.push_back({{"name", c.name},
                   {"passed", c.passed},
                   {"measured", c.measured},
                   {"limit", c.limit},
                   {"remedy", c.remedy}});
  }
  return out;
}

json to_json(const Calibration& c) {
  json sensors = json::array();
  for (const sensor::SensorModel& s : c.sensors) sensors.push_back(sensor_json(s));
  json out{{"schema", kSchema},
           {"id", c.id},
           {"method", c.method},
           {"model", "y = C A R' b + I (12 parameters a sensor)"},
           {"sensors", std::move(sensors)},
           {"covariance", triangle(c.covariance)},
           {"effects", effects_json(c.effects)},
           {"effect_covariance", matrix_json(c.effect_covariance)},
           {"sample_noise_nT", rows(c.sample_noise_nT)},
           {"pose_noise_nT", rows(c.pose_noise_nT)},
           {"gauge", c.gauge},
           {"reference", reference_json(c.reference)},
           {"data_hash", c.data_hash},
           {"poses", c.poses},
           {"accepted", c.accepted_by_checks},
           {"verdict", to_json(c.checks)},
           {"software", c.software}};
  put_geometry(c.geometry, out);
  return out;
}

Result<Calibration> calibration_from_json(const json& object) { return checked(object, std::nullopt); }

std::string content_id(json object) {
  object.erase("id");
  return "c" + sha256_hex(object.dump(-1, ' ', false, json::error_handler_t::replace)).substr(0, 12);
}

std::string to_json_text(const Calibration& calibration) {
  return to_json(calibration).dump(1, ' ', false, json::error_handler_t::replace) + "\n";
}

Result<Calibration> calibration_from_json_text(std::string_view text) {
  const auto object = parse_json_text(text, "give a CAL.json written by mgt fit -o");
  return object ? checked(*object, text) : tl::unexpected(object.error());
}

}  // namespace mgtd::calib::calibration
