// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/run_file_content.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "daemon/cli/kept_run.h"
#include "proto/time.h"

namespace mgtd::daemon::cli {

using calib::report::figures::DataTable;

namespace {

std::string second_of(WallTime at) { return fmt::format("{:.19}Z", format_utc(at)); }

std::string run_text(const store::RunHeader& h) {
  return fmt::format("{} on rig {}, {}", h.run_id, h.rig,
                     h.started_utc.ns == 0 ? "start not recorded" : "started " + second_of(h.started_utc));
}

DataTable masked_table(const std::vector<store::MaskedPose>& masked) {
  DataTable out{.head = {"pose", "because", "when", "who"}};
  for (const store::MaskedPose& m : masked)
    out.rows.push_back({fmt::format("{}", m.number), m.because, second_of(m.at), m.who});
  return out;
}

DataTable judgements_table(const std::vector<run::RunJudgement>& judgements) {
  DataTable out{.head = {"poses", "what they said", "what was done", "minutes"}};
  for (const run::RunJudgement& j : judgements)
    out.rows.push_back({fmt::format("{}", j.poses), j.found, j.next,
                        j.minutes > 0 ? fmt::format("{:.0f}", j.minutes) : std::string()});
  return out;
}

DataTable history_table(const std::vector<store::ModelStep>& history) {
  DataTable out{.head = {"when", "step", "effect", "residual before → after", "reason", "who"}};
  for (const store::ModelStep& s : history) {
    const auto result = nlohmann::json::parse(s.result, nullptr, false);
    const std::string because = result.is_object() ? result.value("because", "") : "";
    out.rows.push_back({second_of(s.at), s.action, s.spec, residual_change(result, "→"), because, s.who});
  }
  return out;
}

}  // namespace

calib::report::RunFileContent run_file_content(const store::PoseSource& source,
                                               const std::vector<run::RunJudgement>& judgements,
                                               const std::vector<store::ModelStep>& history) {
  return {.run = source.header ? run_text(*source.header) : "",
          .masked = masked_table(source.masked),
          .judgements = judgements_table(judgements),
          .history = history_table(history)};
}

}  // namespace mgtd::daemon::cli
