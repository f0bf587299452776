// SPDX-License-Identifier: Apache-2.0
#include "calib/report/reference_text.h"

#include <fmt/format.h>

namespace mgtd::calib::report {
namespace {

std::string stated(const fit::joint::ReferenceScatter& s) {
  return s.stated ? fmt::format("ref_sd_nT says {:.3g} nT", s.stated_nT)
                  : fmt::format("{:.3g} nT is assumed, since ref_sd_nT is not given", s.stated_nT);
}

std::string measured(const fit::joint::ReferenceScatter& s) {
  const char* against = s.by_scalar ? "f_nT" : "the sensors";
  return s.measured_nT > 0 ? fmt::format("scatters {:.2g} nT against {}", s.measured_nT, against)
                           : fmt::format("scatters no more against {} than that itself does", against);
}

std::string advice(const fit::joint::ReferenceScatter& s) {
  return s.measured_nT > 0 ? fmt::format("give ref_sd_nT = {:.2g}", s.measured_nT)
                           : "give a smaller ref_sd_nT";
}

}  // namespace

std::string reference_scatter_text(const fit::joint::ReferenceScatter& s) {
  return fmt::format("the vector {}; {}", measured(s), stated(s));
}

std::string reference_scatter_remark(const fit::joint::ReferenceScatter& s) {
  const std::string found = fmt::format("the vector reference {}, and {}", measured(s), stated(s));
  if (s.less())
    return fmt::format(
        "{}: the fit trusts it too little, and the uncertainties that come from it are too large; {}", found,
        advice(s));
  if (!s.more()) return {};
  if (s.by_scalar)
    return fmt::format(
        "{}: either its noise is larger, or the field moves differently at the two places; {}, or bring the "
        "two together",
        found, advice(s));
  return fmt::format(
      "{}: either its noise is larger, or the model of the sensors lacks something (mgt explain asks what); "
      "if it is the noise, {}",
      found, advice(s));
}

std::string dwell_motion_text(const fit::DwellMotion& motion, double sample_noise_nT) {
  constexpr double kMatters = 1.0 / 3;
  if (motion.component_nT < kMatters * sample_noise_nT) return {};
  if (motion.vector)
    return fmt::format(
        "within a dwell the field moves by {:.2g} nT rms a component, by the vector reference from pose to "
        "pose, and that is taken off the spread of the samples; motion faster than the poses stays in it, "
        "and "
        "the uncertainties are then too large: measure shorter dwells",
        motion.component_nT);
  return fmt::format(
      "within a dwell the total field moves by {:.2g} nT rms, from pose to pose, where a sample has {:.2g} "
      "nT "
      "of noise: the spread of the samples contains it, and nothing in these data takes it out; the "
      "uncertainties are too large. Measure shorter dwells, or with a vector reference beside the table",
      motion.component_nT, sample_noise_nT);
}

}  // namespace mgtd::calib::report
