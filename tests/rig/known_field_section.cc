// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/known_field_section.h"

#include <fmt/format.h>

namespace mgtd::rig {
namespace {

constexpr double kMostRows = 2e6;

void read_cage(Section& section, Scenario& s) {
  if (!section.is_there()) return;
  Cage cage;
  std::string fields = "sphere";
  section.read("fields", fields);
  if (fields != "sphere" && fields != "random")
    section.complain("fields", fmt::format("fields = '{}' must be sphere or random", fields));
  cage.sphere = fields == "sphere";
  section.read("max_nT", cage.max_nT, {1, 1e6});
  section.read("poses", cage.poses);
  if (cage.poses < 1 || cage.poses > 100'000) section.complain("poses", "poses must be 1 to 100000");
  section.refuse_rest();
  s.cage = cage;
}

void read_reference(Section& section, Scenario& s) {
  VectorReference reference;
  bool vector = false;
  std::string frame = "platform";
  section.read("vector", vector);
  section.read("sd_nT", reference.sd_nT, {0, 1e5});
  section.read("misalignment_deg", reference.misalignment_deg);
  section.read("frame", frame);
  section.read("at_m", reference.at_m);
  if (frame != "platform" && frame != "site")
    section.complain("frame", fmt::format("frame = '{}' must be platform or site", frame));
  reference.on_platform = frame != "site";
  if (vector) {
    s.reference = reference;
    s.angles = !reference.on_platform;
    if (s.cage) s.scalar = false;
  }
  section.read("angles", s.angles);
  section.read("scalar", s.scalar);
  section.refuse_rest();
}

void read_recording(Section& section, Scenario& s) {
  if (!section.is_there()) return;
  Recording recording;
  std::string motion = "hand";
  s.rate_hz = 10;
  if (!s.reference) s.angles = false;
  section.read("motion", motion);
  if (!read_motion(motion, recording.motion))
    section.complain("motion", fmt::format("motion = '{}'; there are: {}", motion, kMotions));
  section.read("rate_hz", s.rate_hz, {0.1, 1000});
  section.read("duration_s", recording.duration_s, {1, 36'000});
  section.read("rest_s", recording.rest_s, {0, 36'000});
  section.read("ar", s.noise.ar1_rho, {-0.999, 0.999});
  section.read("angles", s.angles);
  section.read("scalar", s.scalar);
  if (recording.duration_s < 2 * recording.rest_s + kLeastMotion_s)
    section.complain("duration_s",
                     fmt::format("duration_s = {} leaves less than {} s of motion beside two rests of {} s",
                                 recording.duration_s, kLeastMotion_s, recording.rest_s));
  if (recording.duration_s * s.rate_hz > kMostRows)
    section.complain("rate_hz", fmt::format("{} s at {} Hz are more than {} rows", recording.duration_s,
                                            s.rate_hz, kMostRows));
  section.refuse_rest();
  s.recording = recording;
}

}  // namespace

void read_known_field(Section& cage, Section& reference, Section& recording, Scenario& s) {
  read_cage(cage, s);
  read_reference(reference, s);
  read_recording(recording, s);
  if (s.cage && !s.reference)
    cage.complain("", "the fields of a cage are known by the reference: [reference] vector = true");
  if (s.cage && s.reference && !s.reference->on_platform)
    reference.complain("frame", "a cage stands round the array: frame = \"platform\"");
  if (s.cage && s.recording)
    recording.complain("", "a recording is of an array in motion, in a [cage] it stands still");
  if (s.reference && s.reference->on_platform && s.reference->at_m != VectorReference{}.at_m)
    reference.complain("at_m", "only a reference beside the table has a place of its own: frame = \"site\"");
  if (s.reference && !s.reference->on_platform && !s.angles)
    reference.complain("angles",
                       "a reference in the site frame says nothing without angles: angles = true, or frame = "
                       "\"platform\"");
}

}  // namespace mgtd::rig
