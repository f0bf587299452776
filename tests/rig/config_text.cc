// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/config_text.h"

#include <fmt/format.h>

namespace mgtd::rig {

std::string config_text(const Scenario& s, const std::string& dir, const std::string& state_dir,
                        double speed_up, const std::string& tcp) {
  std::string out =
      fmt::format("# For the simulated rig '{}'.\n[rig]\nname = \"{}\"\nbaseline_m = {}\nrate_hz = {}\n",
                  s.name, s.name, s.baseline_m, s.rate_hz);
  for (int i = 1; i <= 4; ++i) {
    out += fmt::format(
        "\n[[sensor]]\ndriver = \"obsdaq\"\nport = \"{}/fluxgate{}\"\npalmacq = {}\nrate_hz = {}\nrange_V = "
        "{}\n"
        "profile = \"mag-13-{:.0f}\"\ntemperature = \"p\"\ndegC_per_V = 10.0\ndegC_at_0V = 0.0\n",
        dir, i, s.palmacq, s.rate_hz, s.range_V, s.uT_full_scale);
  }
  out += fmt::format(
      "\n[table]\ndriver = \"gcs2\"\nport = \"{}/table\"\nbaud = 115200\nvelocity_deg_per_s = "
      "{}\naxes.azimuth = \"1\"\naxes.pitch = "
      "\"2\"\naxes.roll = \"3\"\n",
      dir, s.table_velocity_deg_per_s);
  if (s.scalar) {
    out += fmt::format("\n[scalar]\ndriver = \"gsm\"\nport = \"{}/scalar\"\nbaud = 115200\n", dir);
  } else {
    out += fmt::format("\n[site]\nfield_nT = {}\n", s.f_nT);
  }
  // Long enough that the host's own pauses, which a fast clock makes long, leave something to look at.
  const double preflight_s = 5 + (speed_up - 1) / 2;
  out += fmt::format(
      "\n[store]\ndir = \"{0}\"\n\n[stream]\ntcp = \"{1}\"\nunix = \"{0}/stream.sock\"\n\n[control]\nunix = "
      "\"{0}/control.sock\"\n"
      "\n[run]\npreflight_s = {3}\n\n[daemon]\nspeed_up = {2}\n",
      state_dir, tcp, speed_up, preflight_s);
  return out;
}

}  // namespace mgtd::rig
