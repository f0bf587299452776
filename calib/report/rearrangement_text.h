// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "calib/criticism/tests/exchange_in_run.h"
#include "calib/criticism/tests/rearrangement.h"

/// These functions say in words which sensors changed places or turned.
namespace mgtd::calib::report {

/// "s2 and s4 are exchanged", "s3 is turned by 90 deg about Z".
[[nodiscard]] std::string rearrangement_text(const criticism::tests::Rearrangement& what);
/// The same, with ", or " between those that are possible.
[[nodiscard]] std::string rearrangement_text(const std::vector<criticism::tests::Rearrangement>& possible);
/// From which pose on, how well the total field fits with the exchange and without, and what to do.
[[nodiscard]] std::string exchange_text(const criticism::tests::ExchangeInRun& found);

}  // namespace mgtd::calib::report
