// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/config_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>

namespace mgtd::rig {
namespace {

/// Ranges of the sensors that have a profile of their own, uT at 10 V.
constexpr std::array kProfiles_uT{70.0, 100.0, 250.0, 500.0, 1000.0};

std::string sensor_scale(double uT_full_scale) {
  if (std::find(kProfiles_uT.begin(), kProfiles_uT.end(), uT_full_scale) != kProfiles_uT.end())
    return fmt::format("profile = \"mag-13-{:.0f}\"", uT_full_scale);
  const double nT_per_V = uT_full_scale * 1000 / 10;
  return fmt::format("scale_nT_per_V = [{0}, {0}, {0}]", nT_per_V);
}

std::string sensor(const Scenario& s, int slot, const std::string& port) {
  std::string out = fmt::format(
      "\n[[sensor]]\ndriver = \"obsdaq\"\nport = \"{}\"\npalmacq = {}\nrate_hz = {}\nrange_V = {}\n{}\n"
      "temperature = \"p\"\ndegC_per_V = 10.0\ndegC_at_0V = 0.0\n",
      port, s.palmacq, s.rate_hz, s.range_V, sensor_scale(s.uT_full_scale));
  for (const Covariate& c : on_digitiser(s.covariates, slot))
    out += fmt::format("inputs.{} = {{name = \"{}\", unit = \"{}\", scale = {}, offset = {}}}\n",
                       c.input->letter, c.name, c.input->unit, c.input->per_V, c.input->at_0V);
  return out;
}

std::string places(const Scenario& s) {
  if (s.is_cross()) return fmt::format("baseline_m = {}\n", s.baseline_m);
  std::string list;
  for (const Eigen::Vector3d& x_m : s.positions_m)
    list += fmt::format("{}[{}, {}, {}]", list.empty() ? "" : ", ", x_m[0], x_m[1], x_m[2]);
  return fmt::format("\n[array]\npositions_m = [{}]\n", list);
}

std::string table(const Scenario& s, const std::string& dir) {
  if (s.hands == "table") return "\n[table]\ndriver = \"hand\"\n";
  const std::string axes = s.hands == "mount"
                               ? "mount_by_hand = true\n"
                               : fmt::format(
                                     "axes.pitch = \"2\"\naxes.roll = \"3\"\nlimits.pitch = [-{0}, {0}]\n"
                                     "limits.roll = [-{0}, {0}]\n",
                                     s.tilt_limit_deg);
  return fmt::format(
      "\n[table]\ndriver = \"gcs2\"\nport = \"{}/table\"\nbaud = 115200\nvelocity_deg_per_s = {}\n"
      "axes.azimuth = \"1\"\nlimits.azimuth = [-360, 360]\n{}",
      dir, s.table_velocity_deg_per_s, axes);
}

std::string auxiliary(const std::vector<Covariate>& inputs, const std::string& dir) {
  std::string columns;
  for (const Covariate& input : inputs)
    columns += fmt::format("{}\"{}\"", columns.empty() ? "" : ", ", input.name);
  return fmt::format("\n[[auxiliary]]\ndriver = \"dcon\"\nport = \"{}/auxiliary\"\nchannels = [{}]\n", dir,
                     columns);
}

/// A port of the console beside that of the stream: the next one, or any free one as well.
std::string beside(const std::string& tcp) {
  const std::size_t colon = tcp.rfind(':');
  const int port = colon == std::string::npos ? 0 : std::atoi(tcp.c_str() + colon + 1);
  return fmt::format("127.0.0.1:{}", port == 0 ? 0 : port + 1);
}

}  // namespace

std::string config_text(const Scenario& s, const std::string& dir, const std::string& state_dir,
                        double speed_up, const std::string& tcp) {
  std::string out = fmt::format("# For the simulated rig '{}'.\n[rig]\nname = \"{}\"\nrate_hz = {}\n{}",
                                s.name, s.name, s.rate_hz, places(s));
  for (int i = 0; i < static_cast<int>(s.sensors()); ++i)
    out += sensor(s, i, fmt::format("{}/fluxgate{}", dir, i + 1));
  out += table(s, dir);
  if (s.scalar) {
    out += fmt::format("\n[scalar]\ndriver = \"gsm\"\nport = \"{}/scalar\"\nbaud = 115200\n", dir);
  } else {
    out += fmt::format("\n[site]\nfield_nT = {}\n", s.f_nT);
  }
  if (const auto inputs = on_module(s.covariates); !inputs.empty()) out += auxiliary(inputs, dir);
  // Long enough that the host's own pauses, which a fast clock makes long, leave something to look at.
  const double preflight_s = 5 + (speed_up - 1) / 2;
  return out + fmt::format(
                   "\n[store]\ndir = \"{0}\"\n\n[stream]\ntcp = \"{1}\"\nunix = \"{0}/stream.sock\"\n\n"
                   "[control]\nunix = \"{0}/control.sock\"\n\n[console]\nlisten = "
                   "\"{4}\"\n\n[run]\npreflight_s = {3}\n\n[daemon]\nspeed_up "
                   "= {2}\n",
                   state_dir, tcp, speed_up, preflight_s, beside(tcp));
}

}  // namespace mgtd::rig
