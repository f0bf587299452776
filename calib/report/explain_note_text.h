// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "calib/criticism/search/explain_note.h"

namespace mgtd::calib::report {

/// to_text() puts what explain() noticed into words, as a clause without capital letter and full stop.
[[nodiscard]] std::string to_text(const criticism::search::ExplainNote& note);

/// Of each note, none twice: a search that begins anew after it took effects back may notice the same again.
[[nodiscard]] std::vector<std::string> note_texts(const std::vector<criticism::search::ExplainNote>& notes);

}  // namespace mgtd::calib::report
