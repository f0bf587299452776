// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/help_format.h"

#include <utility>

namespace mgtd::daemon::cli {

std::string HelpFormat::make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const {
  std::string out = Formatter::make_help(app, std::move(name), mode);
  for (auto at = out.find("\n\n\n"); at != std::string::npos; at = out.find("\n\n\n", at)) out.erase(at, 1);
  return out;
}

std::string HelpFormat::make_option_usage(const CLI::Option* option) const {
  const int most = option->get_expected_max();
  const bool some = most > 1 && most < CLI::detail::expected_max_vector_size;
  if (!some || option->get_expected_min() == most) return Formatter::make_option_usage(option);
  const std::string name = make_option_name(option, true);
  std::string out = name;
  for (int i = 1; i < most; ++i) out = name + " [" + out + "]";
  return option->get_required() ? out : "[" + out + "]";
}

}  // namespace mgtd::daemon::cli
