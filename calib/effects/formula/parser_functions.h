// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace mu {
class Parser;
}

namespace mgtd::calib::effects::formula {

/// define_functions() gives a parser what every expression knows beside the functions of muParser: pi, and
/// sind, cosd, tand of degrees.
void define_functions(mu::Parser& parser);

}  // namespace mgtd::calib::effects::formula
