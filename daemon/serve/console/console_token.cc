// SPDX-License-Identifier: Apache-2.0
#include "daemon/serve/console/console_token.h"

#include <fmt/format.h>
#include <openssl/crypto.h>
#include <sys/random.h>

#include <array>
#include <cstdint>
#include <system_error>

namespace mgtd::daemon::serve::console {

ConsoleToken ConsoleToken::random() {
  std::array<std::uint8_t, 16> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw std::system_error(errno, std::generic_category(), "getrandom");
  std::string text;
  for (const std::uint8_t byte : bytes) text += fmt::format("{:02x}", byte);
  return ConsoleToken(std::move(text));
}

bool ConsoleToken::is(std::string_view offered) const {
  return offered.size() == text_.size() && CRYPTO_memcmp(offered.data(), text_.data(), text_.size()) == 0;
}

}  // namespace mgtd::daemon::serve::console
