// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>

#include "tests/accuracy/markdown.h"
#include "tests/blind/blind.h"
#include "tests/blind/page.h"
#include "tests/blind/planted.h"

namespace mgtd::calib::testing {
namespace {

using mgtd::testing::MarkdownTable;

struct OneSensorReference {
  const char* name;
  Stage (*stage)(std::uint64_t seed);
};
constexpr std::array kReferences{OneSensorReference{"scalar", &one_turned_stage},
                                 OneSensorReference{"vector, coil cage", &one_caged_stage}};

/// One unit of each law; its size is found afterwards.
std::vector<Planted> laws_of_an_axis() {
  return {{.kind = "axis.offset.temperature", .numbers = {1}},
          {.kind = "axis.offset.drift", .numbers = {1}},
          {.kind = "axis.gain.temperature", .numbers = {1}},
          {.kind = "axis.gain.drift", .numbers = {1}},
          {.kind = "axis.cubic", .numbers = {1}},
          {.kind = "axis.quadratic", .numbers = {1}},
          {.kind = "axis.transverse", .numbers = {1, 0}},
          {.kind = "axis.zero-crossing", .numbers = {1}}};
}

void ask_about(const Stage& stage, const std::vector<Planted>& planted, std::uint64_t seed, Answers& out) {
  criticism::search::ExplainOptions options;
  options.fit.geometry = geometry_of(stage);
  ask(planted_run(stage, planted, seed), planted.empty() ? "" : planted.front().kind, options, out);
}

/// On x, y and z in turn, of either sign.
Answers hidden_in_one_sensor(const OneSensorReference& reference, Planted law, double d, int runs,
                             std::uint64_t seed) {
  constexpr std::array kAxes{"s1.x", "s1.y", "s1.z"};
  Answers out;
  for (int i = 0; i < runs; ++i) {
    const std::uint64_t s = seed + static_cast<std::uint64_t>(i);
    const Stage stage = reference.stage(s);
    law.where = kAxes.at(static_cast<std::size_t>(i) % 3);
    ask_about(stage, {sized(stage, law, i % 2 == 0 ? d : -d, s).effect}, s, out);
  }
  return out;
}

std::string first_names(const Answers& a) {
  std::string out;
  for (const auto& [name, count] : a.first)
    out += fmt::format("{}{} {}", out.empty() ? "" : ", ", name, count);
  return out.empty() ? "-" : out;
}

}  // namespace

std::string one_sensor_page(const Sizes& n) {
  MarkdownTable quiet({"reference", "runs", "not PASS, %", "EXPLAINED", "refused"});
  MarkdownTable table({"reference", "hidden on one axis", "d", "detected, %", "right name first, %",
                       "right name in the set, %", "wrong single name, %", "named first"});
  std::uint64_t seed = 130'000'000;
  for (const OneSensorReference& reference : kReferences) {
    Answers clean;
    for (int i = 0; i < n.clean; ++i, ++seed) ask_about(reference.stage(seed), {}, seed, clean);
    quiet.line({reference.name, std::to_string(clean.runs), percent(clean.detected, clean.runs),
                std::to_string(clean.of(criticism::search::Finding::explained)),
                std::to_string(clean.refused)});
    for (const double d : {8.0, 15.0, 40.0}) {
      for (const Planted& law : laws_of_an_axis()) {
        const Answers a = hidden_in_one_sensor(reference, law, d, n.runs, seed += 10'000);
        table.line({reference.name, law.kind, fmt::format("{:.0f}", d), percent(a.detected, a.runs),
                    percent(a.named_first, a.detected), percent(a.in_set, a.detected),
                    percent(a.wrong_single, a.runs), first_names(a)});
        fmt::print(stderr, "one sensor: {} d = {} {}: {}\n", reference.name, d, law.kind, first_names(a));
      }
    }
  }
  return "## One sensor\n\nThe simulated rig with one sensor, its temperature up and down. Scalar: turned by "
         "a "
         "table through 157 poses in one field. Vector: at rest in a coil cage, 120 fields up to 60 000 nT, "
         "each component known to 0.2 nT. `axis.transverse`: the squares of the other two axes, which one "
         "field strength does not tell from the square of the own axis.\n\n" +
         quiet.text() + table.text();
}

}  // namespace mgtd::calib::testing
