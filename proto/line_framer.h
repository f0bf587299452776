// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

/// A LineFramer cuts a byte stream into lines, with a limit that a peer cannot exceed: at most `limit` bytes
/// are ever kept. A line ends with \n; a \r before it is dropped; empty lines are skipped. A longer line is
/// dropped up to the next \n, so that the lines after it are read as usual, and reported once for every
/// `limit` bytes of it.
namespace mgtd {

class LineFramer {
 public:
  explicit LineFramer(std::size_t limit) : limit_(limit) {}

  /// Calls on_line(std::string_view) for every complete line and on_overlong() for each that broke the
  /// limit, in the order of arrival. A view is valid during the call only.
  template <class OnLine, class OnOverlong>
  void feed(std::string_view bytes, OnLine&& on_line, OnOverlong&& on_overlong) {
    while (!bytes.empty()) {
      const std::size_t end = bytes.find('\n');
      const bool complete = end != std::string_view::npos;
      for (std::size_t times = take(bytes.substr(0, end)); times > 0; --times) on_overlong();
      if (!complete) return;
      bytes.remove_prefix(end + 1);
      if (!dropping_) {
        std::string_view line = pending_;
        if (line.ends_with('\r')) line.remove_suffix(1);
        if (!line.empty()) on_line(line);
      }
      pending_.clear();
      dropping_ = false;
      dropped_ = 0;
    }
  }

  [[nodiscard]] std::size_t limit() const { return limit_; }
  /// Bytes kept of a line whose end has not come yet.
  [[nodiscard]] std::size_t pending() const { return pending_.size(); }

 private:
  /// How often this part of a line breaks the limit anew.
  std::size_t take(std::string_view part) {
    if (!dropping_ && pending_.size() + part.size() <= limit_) {
      pending_ += part;
      return 0;
    }
    dropped_ += pending_.size() + part.size();
    pending_.clear();
    dropping_ = true;
    const std::size_t times = dropped_ / limit_;
    dropped_ %= limit_;
    return times;
  }

  std::size_t limit_;
  std::string pending_;
  bool dropping_{false};
  std::size_t dropped_{0};  ///< bytes not yet reported
};

}  // namespace mgtd
