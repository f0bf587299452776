// SPDX-License-Identifier: Apache-2.0
// Plays inputs to one parser without a fuzzer:
//   fuzz_replay NAME FILE|FOLDER...     each file as it is, and 64 damaged copies of each
// A property that does not hold ends the program with abort(), after the name of the file was printed.
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "daemon/store/durable_file.h"
#include "fuzz_targets.h"

namespace {

namespace fs = std::filesystem;
constexpr int kDamaged = 64;

std::vector<fs::path> files_of(const fs::path& path) {
  if (fs::is_regular_file(path)) return {path};
  std::vector<fs::path> out;
  for (const auto& entry : fs::recursive_directory_iterator(path)) {
    if (entry.is_regular_file()) out.push_back(entry.path());
  }
  return out;
}

/// One to four wounds: a byte changed, a piece cut out, a piece said twice, the end torn off.
std::string damaged(std::string bytes, std::mt19937_64& random) {
  for (std::uint64_t wounds = 1 + random() % 4; wounds > 0 && !bytes.empty(); --wounds) {
    const std::size_t at = random() % bytes.size(), length = 1 + random() % 16;
    switch (random() % 4) {
      case 0:
        bytes[at] = static_cast<char>(random());
        break;
      case 1:
        bytes.erase(at, length);
        break;
      case 2:
        bytes.insert(at, bytes.substr(at, length));
        break;
      default:
        bytes.resize(at);
    }
  }
  return bytes;
}

void play(FuzzTarget target, const std::string& bytes) {
  target(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
}

}  // namespace

int main(int argc, char** argv) {
  const auto target = argc < 3 ? kFuzzTargets.end() : kFuzzTargets.find(argv[1]);
  if (target == kFuzzTargets.end()) {
    std::fputs("fuzz_replay NAME FILE|FOLDER..., NAME one of:", stderr);
    for (const auto& [name, of] : kFuzzTargets) std::fprintf(stderr, " %s", name.c_str());
    std::fputs("\n", stderr);
    return 2;
  }
  int played = 0;
  for (int i = 2; i < argc; ++i) {
    for (const fs::path& file : files_of(argv[i])) {
      const std::string bytes = mgtd::daemon::store::read_file(file).value();
      std::fprintf(stderr, "%s\n", file.c_str());
      play(target->second, bytes);
      std::mt19937_64 random(20261121 + bytes.size());
      for (int n = 0; n < kDamaged; ++n) play(target->second, damaged(bytes, random));
      ++played;
    }
  }
  std::fprintf(stderr, "%d inputs, %d damaged copies of each\n", played, kDamaged);
  return played > 0 ? 0 : 1;
}
