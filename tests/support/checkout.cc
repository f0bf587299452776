// SPDX-License-Identifier: Apache-2.0
#include "tests/support/checkout.h"

namespace mgtd::testing {

std::string source_path(const std::string& path) { return MGTD_SOURCE_DIR "/" + path; }

std::string program(const std::string& name) { return MGTD_BIN_DIR "/" + name; }

std::string pty_shim() { return MGTD_PTY_SHIM; }

}  // namespace mgtd::testing
