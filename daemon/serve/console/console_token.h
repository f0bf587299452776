// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

/// The token is what a page needs to control: 128 random bits, new at every start of the daemon. Who may use
/// the control socket gets it there (mgt console), so the socket's file permission says who may control.
namespace mgtd::daemon::serve::console {

class ConsoleToken {
 public:
  /// From the kernel's random numbers.
  [[nodiscard]] static ConsoleToken random();
  explicit ConsoleToken(std::string text) : text_(std::move(text)) {}

  [[nodiscard]] const std::string& text() const { return text_; }
  /// Takes as long for a wrong token as for the right one.
  [[nodiscard]] bool is(std::string_view offered) const;

 private:
  std::string text_;
};

}  // namespace mgtd::daemon::serve::console
