// SPDX-License-Identifier: Apache-2.0
#include "calib/linear/parts.h"

#include <sched.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <future>
#include <system_error>
#include <vector>

namespace mgtd::calib::linear {
namespace {

thread_local bool in_a_part = false;

/// Marks this thread as one that does a part.
class InAPart {
 public:
  InAPart() : before_(in_a_part) { in_a_part = true; }
  ~InAPart() { in_a_part = before_; }
  InAPart(const InAPart&) = delete;
  InAPart& operator=(const InAPart&) = delete;

 private:
  bool before_;
};

/// Another thread; none where the system gives no more.
void add_thread(const std::function<void()>& work, std::vector<std::future<void>>& threads) {
  try {
    threads.push_back(std::async(std::launch::async, work));
  } catch (const std::system_error&) {  // those that are there do its parts
  }
}

}  // namespace

std::size_t threads() {
  constexpr std::size_t kMost = 2;  // with four, half as much memory again
  constexpr rlim_t kAddressSpaceEach = 500'000'000;
  if (in_a_part) return 1;
  cpu_set_t allowed;
  rlimit memory{};
  if (sched_getaffinity(0, sizeof allowed, &allowed) != 0) return 1;
  if (getrlimit(RLIMIT_AS, &memory) != 0) return 1;
  const auto processors = static_cast<std::size_t>(CPU_COUNT(&allowed));
  const auto held = static_cast<std::size_t>(memory.rlim_cur / kAddressSpaceEach);  // unbounded: very many
  return std::clamp<std::size_t>(std::min(processors, held), 1, kMost);
}

void keep_parts_on_this_thread() { in_a_part = true; }

void for_each_part(std::size_t count, const std::function<void(std::size_t)>& work) {
  const std::size_t together = std::min(count, threads());
  std::atomic<std::size_t> next{0};
  const auto take = [&] {
    const InAPart mark;
    try {
      for (std::size_t i = next++; i < count; i = next++) work(i);
    } catch (...) {
      next = count;
      throw;
    }
  };
  std::vector<std::future<void>> others;
  for (std::size_t i = 1; i < together; ++i) add_thread(take, others);
  take();
  for (std::future<void>& other : others) other.get();
}

std::size_t parts_of_poses(std::size_t poses) {
  constexpr std::size_t kPoses = 1024;  // for fewer, starting a thread takes longer than the loop
  constexpr std::size_t kMost = 64;     // sums of parts are held until the end
  return std::min(kMost, (poses + kPoses - 1) / kPoses);
}

void for_each_poses(std::size_t poses,
                    const std::function<void(std::size_t part, std::size_t from, std::size_t to)>& work) {
  const std::size_t parts = parts_of_poses(poses);
  for_each_part(parts,
                [&](std::size_t part) { work(part, part * poses / parts, (part + 1) * poses / parts); });
}

}  // namespace mgtd::calib::linear
