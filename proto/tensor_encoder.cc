// SPDX-License-Identifier: Apache-2.0
#include "proto/tensor_encoder.h"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <cmath>

namespace mgtd {
namespace {

constexpr std::int64_t kMicro = 1'000'000;
constexpr double kFixedLimit = 1e12;  // beyond it, micro-units no longer fit an int64 exactly

constexpr auto kPairs = [] {
  std::array<char, 200> pairs{};
  for (std::size_t i = 0; i < 100; ++i) {
    pairs[2 * i] = static_cast<char>('0' + i / 10);
    pairs[2 * i + 1] = static_cast<char>('0' + i % 10);
  }
  return pairs;
}();

/// Six digits, leading zeros kept.
void append_six(std::string& out, std::uint64_t value) {
  for (const std::uint64_t pair : {value / 10'000, value / 100 % 100, value % 100}) {
    out.append(&kPairs[2 * pair], 2);
  }
}

void append_integer(std::string& out, std::uint64_t value) {
  const fmt::format_int text(value);
  out.append(text.data(), text.size());
}

void append_micro(std::string& out, std::int64_t micro) {
  std::uint64_t magnitude = static_cast<std::uint64_t>(micro);
  if (micro < 0) {
    out += '-';
    magnitude = 0 - magnitude;
  }
  append_integer(out, magnitude / kMicro);
  out += '.';
  append_six(out, magnitude % kMicro);
}

void append_number(std::string& out, double value) {
  if (std::abs(value) < kFixedLimit) {
    append_micro(out, std::llround(value * static_cast<double>(kMicro)));
  } else if (std::isfinite(value)) {
    fmt::format_to(std::back_inserter(out), "{}", value);
  } else {
    out += "null";
  }
}

void append_vector(std::string& out, const Eigen::Vector3d& v) {
  out += '[';
  append_number(out, v.x());
  out += ',';
  append_number(out, v.y());
  out += ',';
  append_number(out, v.z());
  out += ']';
}

/// The printed zz of a traceless tensor; any other zz as it is.
void append_zz(std::string& out, const Gradient& g) {
  const bool traceless = std::abs(g.xx + g.yy + g.zz) < 1e-6 && std::abs(g.xx) < kFixedLimit / 2 &&
                         std::abs(g.yy) < kFixedLimit / 2;
  if (!traceless) return append_number(out, g.zz);
  const auto micro = [](double v) { return std::llround(v * static_cast<double>(kMicro)); };
  append_micro(out, -(micro(g.xx) + micro(g.yy)));
}

void append_gradient(std::string& out, const Gradient& g, bool is_tensor) {
  out += "{\"xx\":";
  append_number(out, g.xx);
  out += ",\"yy\":";
  append_number(out, g.yy);
  out += ",\"zz\":";
  if (is_tensor) {
    append_zz(out, g);
  } else {
    append_number(out, g.zz);
  }
  out += ",\"xy\":";
  append_number(out, g.xy);
  out += ",\"xz\":";
  append_number(out, g.xz);
  out += ",\"yz\":";
  append_number(out, g.yz);
  out += '}';
}

void append_invariants(std::string& out, const std::optional<Invariants>& invariants) {
  if (!invariants) {
    out += "null";
    return;
  }
  out += R"({"I1_nT2_per_m2":)";
  append_number(out, invariants->I1_nT2_per_m2);
  out += R"(,"I2_nT3_per_m3":)";
  append_number(out, invariants->I2_nT3_per_m3);
  out += R"(,"contraction_nT_per_m":)";
  append_number(out, invariants->contraction_nT_per_m);
  out += '}';
}

void append_flags(std::string& out, Flags flags) {
  out += '[';
  if (flags.any()) {
    const char* separator = "";
    for_each_name(flags, [&](std::string_view name) {
      out += separator;
      out += '"';
      out += name;
      out += '"';
      separator = ",";
    });
  }
  out += ']';
}

/// Of the cross by name, of another array the numbers that it has.
void append_closure(std::string& out, const Closure& closure) {
  const bool cross = std::isfinite(closure.curl_nT_per_m);
  out += R"({"curl_nT_per_m":)";
  append_number(out, closure.curl_nT_per_m);
  out += R"(,"center_nT":)";
  if (cross) {
    append_vector(out, closure.center_nT);
  } else {
    out += "null";
  }
  out += R"(,"chi2":)";
  append_number(out, closure.chi2);
  if (!cross) {
    out += R"(,"dof":)";
    append_integer(out, static_cast<std::uint64_t>(closure.dof));
    out += R"(,"combinations_nT":[)";
    for (Eigen::Index i = 0; i < closure.combinations_nT.size(); ++i) {
      if (i > 0) out += ',';
      append_number(out, closure.combinations_nT[i]);
    }
    out += ']';
  }
  out += '}';
}

/// Names of columns are letters, digits and _.
void append_inputs(std::string& out, std::span<const InputValue> inputs) {
  out += '{';
  const char* separator = "\"";
  for (const InputValue& input : inputs) {
    out += separator;
    out += input.column;
    out += "\":";
    append_number(out, input.value);
    separator = ",\"";
  }
  out += '}';
}

/// "2026-11-21T10:00:00." as format_utc writes it, but without an allocation once `out` holds 20 characters.
void write_second(std::string& out, std::int64_t second) {
  const std::chrono::sys_seconds t{std::chrono::seconds{second}};
  const auto day = std::chrono::floor<std::chrono::days>(t);
  const std::chrono::year_month_day date{day};
  const std::chrono::hh_mm_ss time{t - day};
  std::array<char, 32> text{};
  const auto written = fmt::format_to_n(text.data(), text.size(), "{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.",
                                        static_cast<int>(date.year()), static_cast<unsigned>(date.month()),
                                        static_cast<unsigned>(date.day()), time.hours().count(),
                                        time.minutes().count(), time.seconds().count());
  out.assign(text.data(), written.size);
}

}  // namespace

void TensorEncoder::append_time(WallTime t) {
  std::int64_t second = t.ns / 1'000'000'000;
  if (t.ns % 1'000'000'000 < 0) --second;
  if (second != second_) {
    second_ = second;
    write_second(second_text_, second);
  }
  line_ += second_text_;
  append_six(line_, static_cast<std::uint64_t>(t.ns - second * 1'000'000'000) / 1000);
  line_ += "Z\",\"t_ns\":";
  const fmt::format_int ns(t.ns);
  line_.append(ns.data(), ns.size());
}

std::string_view TensorEncoder::encode(const TensorSample& sample, std::span<const InputValue> inputs) {
  line_.assign(R"({"class":"TENSOR","seq":)");
  append_integer(line_, sample.seq);
  line_ += R"(,"t":")";
  append_time(sample.t.wall);
  line_ += R"(,"frame":"platform","cal":)";
  if (sample.calibration_id) {
    line_ += '"';
    line_ += *sample.calibration_id;
    line_ += '"';
  } else {
    line_ += "null";
  }
  line_ += R"(,"b_nT":)";
  append_vector(line_, sample.b_P_nT);
  line_ += R"(,"f_nT":)";
  append_number(line_, sample.f_nT);
  line_ += R"(,"g_nT_per_m":)";
  append_gradient(line_, sample.g_nT_per_m, true);
  line_ += R"(,"g_sd_nT_per_m":)";
  append_gradient(line_, sample.g_sd_nT_per_m, false);
  line_ += R"(,"invariants":)";
  append_invariants(line_, invariants(sample.g_nT_per_m));
  if (sample.along_line) {
    line_ += R"(,"along_line_nT_per_m":)";
    append_vector(line_, sample.along_line->nT_per_m);
    line_ += R"(,"along_line_sd_nT_per_m":)";
    append_vector(line_, sample.along_line->sd_nT_per_m);
  }
  line_ += R"(,"closure":)";
  append_closure(line_, sample.closure);
  line_ += R"(,"flags":)";
  append_flags(line_, sample.flags);
  if (!inputs.empty()) {
    line_ += R"(,"inputs":)";
    append_inputs(line_, inputs);
  }
  line_ += '}';
  return line_;
}

}  // namespace mgtd
