// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <string>

#include "proto/journal_note.h"

/// Any text: no crash, and what was understood is written so that it is understood the same.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto note = mgtd::parse_note({reinterpret_cast<const char*>(data), size});
  if (!note) return 0;
  const std::string text = mgtd::encode(*note);
  const auto again = mgtd::parse_note(text);
  if (!again || mgtd::encode(*again) != text) std::abort();
  return 0;
}
