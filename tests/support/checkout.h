// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

/// These functions tell where this checkout and the programs built from it are. Only `checkout.cc` is
/// compiled with these paths, so that everything else compiles to the same bytes in every checkout, and a
/// compiler cache serves them all.
namespace mgtd::testing {

/// The absolute path of a file of the source tree: source_path("docs/stream.md").
std::string source_path(const std::string& path);

/// The absolute path of a program of this build: program("mgt-rig").
std::string program(const std::string& name);

/// The absolute path of the library that makes a pty look like a real serial port; see pty_shim.c.
std::string pty_shim();

}  // namespace mgtd::testing
