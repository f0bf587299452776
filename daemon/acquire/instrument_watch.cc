// SPDX-License-Identifier: Apache-2.0
#include "daemon/acquire/instrument_watch.h"

#include <fmt/format.h>

#include <algorithm>

namespace mgtd::daemon::acquire {
namespace {

bool is_sensor(const InstrumentIdentity& i) {
  return i.place.size() > 1 && i.place[0] == 's' && i.place[1] >= '1' && i.place[1] <= '9';
}

std::string_view model_of(const InstrumentIdentity& i) {
  return std::string_view(i.identity).substr(0, i.identity.find(", serial "));
}

std::string named(const InstrumentIdentity& i) {
  const auto serial = serial_of(i);
  return serial.empty() ? fmt::format("'{}'", i.identity) : fmt::format("serial number {}", serial);
}

}  // namespace

void InstrumentWatch::want(const std::vector<InstrumentIdentity>& instruments) {
  wanted_.clear();
  for (const InstrumentIdentity& i : instruments)
    if (is_sensor(i)) wanted_[i.place] = i;
  another_ = !others().empty();
}

void InstrumentWatch::answers(const InstrumentIdentity& who) {
  if (!is_sensor(who)) return;
  answering_[who.place] = who;
  another_ = !others().empty();
}

bool InstrumentWatch::is_another(const InstrumentIdentity& wanted) const {
  const auto found = answering_.find(wanted.place);
  if (found == answering_.end()) return false;
  const InstrumentIdentity& now = found->second;
  if (!serial_of(wanted).empty() && !serial_of(now).empty()) return serial_of(wanted) != serial_of(now);
  return !wanted.identity.empty() && !now.identity.empty() && model_of(wanted) != model_of(now);
}

std::vector<std::string> InstrumentWatch::others() const {
  std::vector<std::string> out;
  for (const auto& [place, wanted] : wanted_)
    if (is_another(wanted)) out.push_back(place);
  return out;
}

std::string InstrumentWatch::home_of(const InstrumentIdentity& who) const {
  for (const auto& [place, wanted] : wanted_)
    if (!serial_of(who).empty() && serial_of(wanted) == serial_of(who)) return place;
  return {};
}

std::string InstrumentWatch::sentence(const std::string& place) const {
  const InstrumentIdentity& now = answering_.at(place);
  const std::string home = home_of(now);
  if (home.empty())
    return fmt::format("another device answers as {}: {}, and {} {}", place, named(now), by_.with,
                       named(wanted_.at(place)));
  return fmt::format("the device with {}, {} {}, now answers on the port of {}", named(now), by_.as, home,
                     place);
}

std::string InstrumentWatch::measured() const {
  std::string out;
  std::vector<std::string> left = others();
  while (!left.empty()) {
    const std::string place = left.front();
    left.erase(left.begin());
    const std::string home = home_of(answering_.at(place));
    const auto partner = std::find(left.begin(), left.end(), home);
    if (!out.empty()) out += "; ";
    if (partner != left.end() && home_of(answering_.at(home)) == place) {
      left.erase(partner);
      // The device that belongs to the first place is named first.
      out += fmt::format("{0} and {1} are exchanged: {2}, and {3}", place, home, sentence(home),
                         sentence(place));
    } else {
      out += sentence(place);
    }
  }
  return out;
}

std::string InstrumentWatch::remedy() const {
  const std::vector<std::string> places = others();
  const bool all_known = std::all_of(places.begin(), places.end(), [this](const std::string& place) {
    return !home_of(answering_.at(place)).empty();
  });
  if (all_known) return "swap the plugs back, or exchange the ports in the configuration";
  return std::string(by_.new_one);
}

}  // namespace mgtd::daemon::acquire
