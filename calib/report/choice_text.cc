// SPDX-License-Identifier: Apache-2.0
#include "calib/report/choice_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace mgtd::calib::report {

std::string to_text(const criticism::search::Choice& choice) {
  std::string out;
  if (!choice.alternatives.empty())
    out += fmt::format("{} was chosen where {} could stand in its place, and no poses since tell them apart",
                       choice.spec, fmt::join(choice.alternatives, ", "));
  if (choice.describes)
    out += fmt::format(
        "{}{} describes the readings, it does not explain them: when it was added (verdict {}) it was "
        "not the whole of what stood out, and another law may be the cause",
        out.empty() ? "" : "; ", choice.spec, choice.finding);
  return out;
}

}  // namespace mgtd::calib::report
