// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/noise_section.h"

namespace mgtd::rig {
namespace {

void read_kind(Section& section, NoiseKind& kind) {
  std::string text = "gaussian";
  section.read("noise", text);
  if (text != "gaussian" && text != "uniform" && text != "student")
    section.complain("noise", "noise must be gaussian, uniform or student");
  kind = text == "uniform"   ? NoiseKind::uniform
         : text == "student" ? NoiseKind::student
                             : NoiseKind::gaussian;
}

/// What a word for noise stands for where no key beside it says otherwise.
void read_noise_word(Section& sensors, SampleNoise& noise) {
  std::string text = "gaussian";
  sensors.read("noise", text);
  if (text == "uniform") {
    noise.kind = NoiseKind::uniform;
  } else if (text == "student") {
    noise.kind = NoiseKind::student;
  } else if (text == "ar") {
    noise.ar1_rho = 0.9;
  } else if (text == "walk") {
    noise.walk_nT_per_sqrt_h = 1;
  } else if (text == "flicker") {
    noise.flicker_nT_per_sqrt_hz = 0.02;  // 20 pT/sqrt(Hz) at 1 Hz: a basic fluxgate
  } else if (text == "quantised") {
    noise.mean_step_nT = 0.1;
  } else if (text != "gaussian") {
    sensors.complain("noise", "noise must be gaussian, uniform, student, ar, walk, flicker or quantised");
  }
}

}  // namespace

void read_sample_noise(Section& sensors, SampleNoise& noise) {
  read_noise_word(sensors, noise);
  sensors.read("noise_nT", noise.noise_nT, {0, 1e5});
  sensors.read("student_dof", noise.student_dof, {2.1, 1000});
  sensors.read("ar1_rho", noise.ar1_rho, {-0.999, 0.999});
  sensors.read("slow_nT", noise.slow_nT, {0, 1e5});
  sensors.read("slow_tau_s", noise.slow_tau_s, {0.01, 1e6});
  sensors.read("spike_share", noise.spike_share, {0, 1});
  sensors.read("spike_nT", noise.spike_nT, {0, 1e6});
  sensors.read("walk_nT_per_sqrt_h", noise.walk_nT_per_sqrt_h, {0, 1e5});
  sensors.read("flicker_nT_per_sqrt_hz", noise.flicker_nT_per_sqrt_hz, {0, 1e5});
  sensors.read("lsb_nT", noise.lsb_nT, {0, 1e5});
  sensors.read("mean_step_nT", noise.mean_step_nT, {0, 1e5});
  sensors.read("tells_n_eff", noise.tells_n_eff);
}

void read_visit_noise(Section& visit, VisitNoise& noise) {
  read_kind(visit, noise.kind);
  visit.read("noise_nT", noise.noise_nT, {0, 1e5});
  visit.read("student_dof", noise.student_dof, {2.1, 1000});
  visit.read("rho", noise.rho, {-0.999, 0.999});
  visit.read("outlier_share", noise.outlier_share, {0, 1});
  visit.read("outlier_nT", noise.outlier_nT, {0, 1e6});
  visit.read("cycle_nT", noise.cycle_nT, {-1e6, 1e6});
  visit.read("cycle_visits", noise.cycle_visits, {2, 1e6});
  noise.cycle_where = visit.where("cycle_where");
}

}  // namespace mgtd::rig
