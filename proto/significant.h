// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace mgtd {

/// significant() rounds a number to so many significant digits, so that its text is short. What is not finite
/// stays as it is.
[[nodiscard]] double significant(double value, int digits = 4);

}  // namespace mgtd
