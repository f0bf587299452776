// SPDX-License-Identifier: Apache-2.0
#include "proto/version.h"

namespace mgtd {

const char* version() { return MGTD_VERSION; }

std::string software() { return "mgtd " MGTD_VERSION; }

}  // namespace mgtd
