// SPDX-License-Identifier: Apache-2.0
#include "drivers/registry.h"

#include <algorithm>
#include <array>

#include "drivers/dcon_driver.h"
#include "drivers/gcs2_driver.h"
#include "drivers/gsm_driver.h"
#include "drivers/manual_table.h"
#include "drivers/obsdaq_driver.h"

namespace mgtd::drivers {
namespace {

constexpr std::array kDrivers{
    DriverEntry{"dcon", Role::auxiliary,
                "analogue input module that speaks DCON (I-7000, ADAM-4000): currents, temperatures",
                &dcon::DconDriver::make},
    DriverEntry{"gcs2", Role::table, "Physik Instrumente GCS 2.0 turntable, one to three axes",
                &gcs2::Gcs2Driver::make},
    DriverEntry{"gsm", Role::scalar, "GEM Systems GSM-90 or GSM-19 total-field magnetometer",
                &gsm::GsmDriver::make},
    DriverEntry{"hand", Role::table, "a table that is turned by hand: the run asks for what its scales say",
                &ManualTable::make, false},
    DriverEntry{"obsdaq", Role::sensor, "Mingeo ObsDAQ digitiser, direct or behind a PalmAcq time-stamper",
                &obsdaq::ObsdaqDriver::make},
};

}  // namespace

std::span<const DriverEntry> drivers() { return kDrivers; }

const DriverEntry* find_driver(std::string_view name) {
  const auto found =
      std::find_if(kDrivers.begin(), kDrivers.end(), [&](const auto& d) { return d.name == name; });
  return found == kDrivers.end() ? nullptr : found;
}

}  // namespace mgtd::drivers
