// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/fit_options.h"

namespace mgtd::calib::fit {

std::string_view name(Method method) {
  switch (method) {
    case Method::simplified:
      return "simplified";
    case Method::two_step:
      return "two-step";
    case Method::joint:
      return "joint";
  }
  return "";
}

std::optional<Method> method_from(std::string_view text) {
  for (const Method method : {Method::simplified, Method::two_step, Method::joint}) {
    if (name(method) == text) return method;
  }
  return std::nullopt;
}

}  // namespace mgtd::calib::fit
