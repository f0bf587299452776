// SPDX-License-Identifier: Apache-2.0
// Whatever a page asks to be computed: what is accepted becomes words of mgt in which no text of the page is
// an option, a path or a line of its own.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/serve/console/job_request.h"

namespace console = mgtd::daemon::serve::console;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto request =
      console::parse_job_request(std::string_view(reinterpret_cast<const char*>(data), size));
  if (!request) {
    if (request.error().message.empty()) std::abort();
    return 0;
  }
  const std::string run = "/served/RUN", made = "/served/MADE";
  const auto words = console::job_words(*request, run, made, {"--field=50000"});
  if (words.front() != request->verb->name) std::abort();
  bool options = false;
  for (const std::string& word : words) {
    if (word.empty() || word.find('\n') != std::string::npos || word.find('\0') != std::string::npos)
      std::abort();
    if (!word.starts_with('-')) {
      if (options && word != made && word != "/dev/stdout") std::abort();
      continue;
    }
    options = true;
    if (word == "-o" || word == "--field=50000") continue;
    const std::string name = word.substr(0, word.find('='));
    const auto& known = request->verb->arguments;
    const bool of_table =
        std::any_of(known.begin(), known.end(), [&](const auto& a) { return a.option == name; });
    const bool fixed =
        (" " + std::string(request->verb->fixed) + " ").find(" " + name + " ") != std::string::npos;
    if (!of_table && !fixed) std::abort();
  }
  if (std::count(words.begin(), words.end(), run) < 1) std::abort();
  return 0;
}
