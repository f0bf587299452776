// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <string_view>

/// A StreamClass is one kind of object that the live stream carries and a client may choose. GAP belongs to
/// TENSOR: whoever watches samples is told which are missing.
namespace mgtd {

enum class StreamClass : std::uint8_t { tensor, gap, status, run, sensors };
inline constexpr std::array<std::string_view, 5> kStreamClassNames{"TENSOR", "GAP", "STATUS", "RUN",
                                                                   "SENSORS"};

/// A set of classes.
class StreamClasses {
 public:
  constexpr StreamClasses() = default;
  [[nodiscard]] static constexpr StreamClasses all() {
    StreamClasses set;
    set.add(StreamClass::tensor);
    set.add(StreamClass::status);
    set.add(StreamClass::run);
    set.add(StreamClass::sensors);
    return set;
  }
  /// Adding tensor adds gap.
  constexpr void add(StreamClass c) {
    bits_ =
        static_cast<std::uint8_t>(bits_ | bit(c) | (c == StreamClass::tensor ? bit(StreamClass::gap) : 0U));
  }
  [[nodiscard]] constexpr bool has(StreamClass c) const { return (bits_ & bit(c)) != 0; }
  [[nodiscard]] constexpr bool any() const { return bits_ != 0; }
  constexpr bool operator==(const StreamClasses&) const = default;

 private:
  [[nodiscard]] static constexpr unsigned bit(StreamClass c) { return 1U << static_cast<unsigned>(c); }
  std::uint8_t bits_{0};
};

}  // namespace mgtd
