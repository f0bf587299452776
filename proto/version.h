// SPDX-License-Identifier: Apache-2.0
/// version() is the version of the programs, as `--version` prints it and as files and messages carry it. It
/// is compiled into one small file, so a new version compiles that file again and links, and nothing else.
#pragma once

#include <string>

namespace mgtd {

/// The version of the project in CMakeLists.txt: "0.2.0".
const char* version();

/// How a file or a message names the software that wrote it: "mgtd 0.2.0".
std::string software();

}  // namespace mgtd
