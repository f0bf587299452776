// SPDX-License-Identifier: Apache-2.0
#include "drivers/dcon_protocol.h"

#include <fmt/format.h>

#include <numeric>

#include "proto/number.h"

namespace mgtd::drivers::dcon {
namespace {

std::string sum_of(std::string_view text) {
  const unsigned sum = std::accumulate(text.begin(), text.end(), 0U, [](unsigned total, char c) {
    return total + static_cast<unsigned char>(c);
  });
  return fmt::format("{:02X}", sum & 0xFFU);
}

/// Digits with one decimal point; without one it is the module's sign for "out of range".
Reply values(std::string_view text) {
  Values out;
  while (!text.empty()) {
    if (text.front() != '+' && text.front() != '-') return Reject::number;
    const std::size_t end = std::min(text.find_first_of("+-", 1), text.size());
    const std::string_view word = text.substr(0, end);
    if (word.find_first_not_of("0123456789.", 1) != std::string_view::npos) return Reject::number;
    const auto number = parse_number(word);
    if (!number) return Reject::number;
    const bool in_range = word.find('.') != std::string_view::npos;
    out.channels.push_back(in_range ? std::optional(*number) : std::nullopt);
    text.remove_prefix(end);
  }
  if (out.channels.empty() || out.channels.size() > kMaxChannels) return Reject::length;
  return out;
}

}  // namespace

std::string command(std::string text, bool checksum) {
  if (checksum) text += sum_of(text);
  return text + '\r';
}

Reply parse_reply(std::string_view line, std::string_view address, bool checksum) {
  if (checksum) {
    if (line.size() < 3) return Reject::length;
    const std::string_view sum = line.substr(line.size() - 2);
    line.remove_suffix(2);
    if (sum != sum_of(line)) return Reject::checksum;
  }
  if (line.empty()) return Reject::length;
  const char kind = line.front();
  line.remove_prefix(1);
  if (kind == '>') return values(line);
  if (kind != '!' && kind != '?') return Reject::framing;
  if (!line.starts_with(address)) return Reject::framing;
  if (kind == '?') return Refusal{};
  return Name{std::string(line.substr(address.size()))};
}

}  // namespace mgtd::drivers::dcon
