// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

/// Flags tell a reader what to know about a sample beside its numbers: bits, named as in the stream.
namespace mgtd {

enum class Flag : std::uint16_t {
  saturated = 1U << 0U,        ///< a channel at the end of its range
  interpolated = 1U << 1U,     ///< a sensor was interpolated to the epoch between two real samples
  calibrating = 1U << 2U,      ///< a calibration run has the table
  uncalibrated = 1U << 3U,     ///< no active calibration: the numbers are raw readings
  suspect = 1U << 4U,          ///< the closure says that the calibration does not hold here: STATUS says why
  clock_unsettled = 1U << 5U,  ///< the clock model of a device is still being learnt
  incomplete = 1U << 6U,       ///< an effect of the calibration is not removed: its inputs are not measured
  forced = 1U << 7U,           ///< the active calibration failed its checks and was forced
  near_source = 1U << 8U,      ///< the closure is large and follows nothing of the instrument's
  frozen = 1U << 9U,           ///< a sensor repeats its last reading to the bit
  identity = 1U << 10U,        ///< a sensor is not the one that was calibrated in its place: readings are raw
};

class Flags {
 public:
  constexpr Flags() = default;
  constexpr Flags(Flag f) : bits_(static_cast<std::uint16_t>(f)) {}  // NOLINT: a flag is a set of one
  constexpr Flags& operator|=(Flags o) {
    bits_ = static_cast<std::uint16_t>(bits_ | o.bits_);
    return *this;
  }
  friend constexpr Flags operator|(Flags a, Flags b) { return a |= b; }
  [[nodiscard]] constexpr bool has(Flag f) const { return (bits_ & static_cast<std::uint16_t>(f)) != 0; }
  [[nodiscard]] constexpr bool any() const { return bits_ != 0; }
  [[nodiscard]] constexpr std::uint16_t bits() const { return bits_; }
  constexpr bool operator==(const Flags&) const = default;

 private:
  std::uint16_t bits_{0};
};

inline constexpr std::array<std::pair<Flag, std::string_view>, 11> kFlagNames{{
    {Flag::saturated, "saturated"},
    {Flag::interpolated, "interpolated"},
    {Flag::calibrating, "calibrating"},
    {Flag::uncalibrated, "uncalibrated"},
    {Flag::suspect, "suspect"},
    {Flag::clock_unsettled, "clock_unsettled"},
    {Flag::incomplete, "incomplete"},
    {Flag::forced, "forced"},
    {Flag::near_source, "near_source"},
    {Flag::frozen, "frozen"},
    {Flag::identity, "identity"},
}};

/// Calls use(std::string_view) with the name of every flag that is set, in the order of their bits.
template <class Use>
void for_each_name(Flags flags, Use&& use) {
  for (const auto& [flag, name] : kFlagNames) {
    if (flags.has(flag)) use(name);
  }
}

/// The flags that are set, by name, in the order of their bits.
[[nodiscard]] std::vector<std::string_view> names(Flags flags);

}  // namespace mgtd
