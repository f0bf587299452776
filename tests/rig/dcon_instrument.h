// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "tests/rig/covariate.h"
#include "tests/rig/instrument.h"

/// This simulates an I-7017-like input module at address 01, 9600 Bd, checksum off: #01 is answered by all
/// channels in engineering units, $01M by its name, another command by ?01, another address not at all. Its
/// inputs are the covariates of the scenario that are on no other, in their order.
namespace mgtd::rig {

class DconInstrument final : public Instrument {
 public:
  explicit DconInstrument(std::vector<Covariate> inputs) : inputs_(std::move(inputs)) {}

  void receive(std::string_view bytes, double now_s) override;
  void advance(double /*now_s*/) override {}
  [[nodiscard]] double next_s() const override { return 1e300; }
  [[nodiscard]] int baud() const override { return 9600; }

 private:
  void obey(std::string_view command, double now_s);
  [[nodiscard]] std::string values(double now_s);

  std::vector<Covariate> inputs_;
  std::string command_;  ///< as far as it has come
  std::string last_;
};

}  // namespace mgtd::rig
