// SPDX-License-Identifier: Apache-2.0
#include "calib/report/figures/text_width.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "calib/report/figures/escaped.h"

namespace mgtd::calib::report::figures {
namespace {

/// Advance of the printable ASCII characters from space on, in thousandths of the font's height (table hmtx).
constexpr std::array kAdvance{
    318,  401, 460, 838, 636, 950, 780, 275, 390, 390, 500, 838, 318, 361, 318, 337,  // space to /
    636,  636, 636, 636, 636, 636, 636, 636, 636, 636, 337, 337, 838, 838, 838, 531,  // 0 to ?
    1000, 684, 686, 698, 770, 632, 575, 775, 752, 295, 295, 656, 557, 863, 748, 787,  // @ to O
    603,  787, 695, 635, 611, 732, 684, 989, 685, 611, 685, 390, 337, 390, 838, 500,  // P to _
    500,  613, 635, 550, 635, 615, 352, 635, 634, 278, 278, 579, 278, 974, 634, 612,  // ` to o
    635,  635, 411, 521, 392, 634, 592, 818, 592, 592, 525, 636, 337, 636, 838};      // p to ~
constexpr double kOther = 700;

double advance(char c) {
  const auto at = static_cast<std::size_t>(static_cast<unsigned char>(c)) - 32U;
  return at < kAdvance.size() ? kAdvance[at] : kOther;
}

}  // namespace

double text_width(std::string_view text, double size) {
  double thousandths = 0;
  while (!text.empty()) {
    thousandths += advance(text.front());
    text.remove_prefix(std::max<std::size_t>(1, utf8_length(text)));
  }
  return thousandths * size / 1000;
}

std::string_view fitting_part(std::string_view text, double size, double width) {
  double used = 0;
  std::size_t at = 0;
  while (at < text.size()) {
    used += advance(text[at]) * size / 1000;
    if (used > width) return text.substr(0, at);
    at += std::max<std::size_t>(1, utf8_length(text.substr(at)));
  }
  return text;
}

}  // namespace mgtd::calib::report::figures
