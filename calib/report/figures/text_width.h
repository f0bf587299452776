// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>

namespace mgtd::calib::report::figures {

/// text_width() gives the width of a line of text in DejaVu Sans, in the units of `size` (the height of the
/// font). Figures are laid out without asking a browser, so that they are the same everywhere; where that
/// font is missing, its replacements (Verdana's family aside) are narrower. Characters outside ASCII count as
/// wide as a capital.
[[nodiscard]] double text_width(std::string_view text, double size);

/// The longest beginning of the text that fits into `width`; no character is cut in two.
[[nodiscard]] std::string_view fitting_part(std::string_view text, double size, double width);

}  // namespace mgtd::calib::report::figures
