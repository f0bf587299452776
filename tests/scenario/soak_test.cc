// SPDX-License-Identifier: Apache-2.0
// Left alone for weeks: memory, descriptors, log and disk stay where they are. In virtual time, with the real
// drivers, sampler, tensor, journal, samples on disk and a client, at five samples a second; every period a
// cable is out, a device hangs, a line is noisy.
//
//     env MGTD_SOAK_DAYS=30 build/bin/scenario_test --gtest_filter='Soak.*'
//
// Without the variable six hours, so that it is part of every test run.
#include <gtest/gtest.h>
#include <malloc.h>
#include <unistd.h>
#ifdef MGTD_SANITIZED
#include <sanitizer/allocator_interface.h>
#endif

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <numeric>
#include <span>

#include "daemon/serve/subscription.h"
#include "daemon/store/disk_ring.h"
#include "tests/scenario/virtual_stream.h"
#include "tests/support/child_process.h"

namespace mgtd::daemon {
namespace {

using test::perfect_calibration;
using test::scenario_of;
using test::VirtualStream;

constexpr std::uint64_t kKept_bytes = 4U << 20U, kBuffer_bytes = 1U << 16U;
constexpr double kStep_s = 0.05;  // the time is told every fourth

struct Figures {
  double heap_bytes{0}, rss_bytes{0}, descriptors{0}, disk_bytes{0}, files{0};
};

double count_in(const std::filesystem::path& directory) {
  double n = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(directory)) ++n;
  return n;
}

double heap_bytes() {
#ifdef MGTD_SANITIZED  // a malloc of its own
  return static_cast<double>(__sanitizer_get_current_allocated_bytes());
#else
  return static_cast<double>(::mallinfo2().uordblks);
#endif
}

Figures figures(const std::filesystem::path& store) {
  Figures out;
  out.heap_bytes = heap_bytes();
  long pages = 0;
  if (std::FILE* const statm = std::fopen("/proc/self/statm", "re"); statm != nullptr) {
    if (std::fscanf(statm, "%*d %ld", &pages) != 1) pages = 0;
    std::fclose(statm);
  }
  out.rss_bytes = static_cast<double>(pages) * 4096;
  out.descriptors = count_in("/proc/self/fd");
  for (const auto& entry : std::filesystem::recursive_directory_iterator(store)) {
    if (!entry.is_regular_file()) continue;
    out.disk_bytes += static_cast<double>(entry.file_size());
    ++out.files;
  }
  return out;
}

void sync(store::Journal& journal) {
  for (const int fd : journal.take_syncs()) {
    ::close(fd);
    journal.synced(0);
  }
}

store::JournalConfig journal_in(const std::string& store) {
  store::JournalConfig out;
  out.directory = store + "/runs";
  out.name = "raw-1";
  out.header = {"rig", ""};
  out.keep.bytes = kKept_bytes;
  out.rotate_bytes = kKept_bytes / 16;
  return out;
}

double mean(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// What stands around the stream in the daemon, small enough to turn over many times.
class Household {
 public:
  explicit Household(const rig::Scenario& scenario)
      : daemon(scenario, kStep_s),
        raw_(journal_in(store_.path()), daemon.now().mono),
        disk_({.directory = store_.path() + "/stream", .rig = "rig", .bytes = kKept_bytes}, daemon.now()),
        ring_(16'384) {
    daemon.on_raw = [this](const RawRecord& record) { raw_.append(record); };
    daemon.on_line = [this](const RingRecord& record) { take(record); };
    daemon.on_word = [this](const std::string& device, const std::string& words) {
      log_bytes += static_cast<double>(device.size() + words.size());
    };
    daemon.start();
    daemon.use(perfect_calibration(scenario));
    std::string out;
    client_.watch({}, ring_, out);
  }

  /// So long, with one fault after the other.
  void live(double seconds) {
    static constexpr std::array kFaults{"unplug fluxgate1 for 3", "stall fluxgate2 for 4",
                                        "unplug table for 3",     "garbage fluxgate4",
                                        "unplug scalar for 5",    "torn fluxgate3 for 5"};
    for (const char* fault : kFaults) {
      daemon.fault(fault);
      for (double t_s = 0; t_s < seconds / kFaults.size(); ++t_s) second();
    }
  }

  VirtualStream daemon;
  double log_bytes{0};
  std::uint64_t samples{0}, gap_records{0};
  [[nodiscard]] Figures look() const { return figures(store_.path()); }
  [[nodiscard]] const store::Journal& raw() const { return raw_; }

 private:
  void second() {
    daemon.run(1);
    raw_.tick(daemon.now().mono);
    disk_.tick(daemon.now());
    sync(raw_);
    sync(disk_.journal());
    out_.clear();
    client_.fill(ring_, out_, 1U << 20U);
  }
  void take(const RingRecord& record) {
    const bool is_gap = record.kind == RingRecord::Kind::gap;
    is_gap ? ring_.push_gap(record.from_seq, record.to_seq, record.line)
           : ring_.push_sample(record.from_seq, record.at.mono, record.line);
    disk_.push(record);
    ++(is_gap ? gap_records : samples);
  }

  mgtd::testing::TemporaryDirectory store_;
  store::Journal raw_;
  store::DiskRing disk_;
  serve::SampleRing ring_;
  serve::Subscription client_;
  std::string out_;
};

double change_percent(double before, double after) { return 100 * (after - before) / before; }

TEST(Soak, MemoryDescriptorsLogAndDiskStayWhereTheyAre) {
  const char* const wanted = std::getenv("MGTD_SOAK_DAYS");
  const double hours = wanted != nullptr ? 24 * std::atof(wanted) : 6;
  const double period_h = hours > 24 ? 12 : 1;
  const int periods = static_cast<int>(hours / period_h), warm = std::min(periods / 2, 6);
  ASSERT_GE(periods, 6);
  Household house(scenario_of("[rig]\nname = \"soak\"\nparameters = \"table6\"\n[sensors]\nrate_hz = 5\n"));
  Figures before;
  std::vector<double> log;  // bytes in each period
  for (int period = 0; period < periods; ++period) {
    const double told = house.log_bytes;
    house.live(3600 * period_h);
    log.push_back(house.log_bytes - told);
    if (period + 1 == warm) before = house.look();
    if (period_h > 1)
      std::printf("%.1f days: heap %.0f B\n", (period + 1) * period_h / 24, house.look().heap_bytes);
  }
  const Figures after = house.look();
  const auto since = std::span<const double>(log).subspan(static_cast<std::size_t>(warm));
  const double early = mean(since.first(since.size() / 2)), late = mean(since.subspan(since.size() / 2));
  std::printf(
      "%.1f h simulated, %lu samples, %lu gaps; since hour %.0f: heap %.0f B (%+.3f %%), resident %.1f MB "
      "(%+.3f %%), %.0f descriptors (%+.0f), log %.0f B a period (%+.2f %%), disk %.2f MB in %.0f files, "
      "%lu removed\n",
      hours, house.samples, house.gap_records, warm * period_h, after.heap_bytes,
      change_percent(before.heap_bytes, after.heap_bytes), after.rss_bytes / 1e6,
      change_percent(before.rss_bytes, after.rss_bytes), after.descriptors,
      after.descriptors - before.descriptors, late, change_percent(early, late), after.disk_bytes / 1e6,
      after.files, house.raw().files_removed());
  EXPECT_LT(std::abs(change_percent(before.heap_bytes, after.heap_bytes)), 1);
  EXPECT_LT(change_percent(before.rss_bytes, after.rss_bytes), 1);
  EXPECT_EQ(after.descriptors, before.descriptors);
  EXPECT_LT(std::abs(change_percent(early, late)), 1);
  EXPECT_GT(house.raw().files_removed(), 0U);
  EXPECT_LE(after.disk_bytes, 2 * kKept_bytes + 2 * kBuffer_bytes)
      << "journal and samples, each with its bound";
  EXPECT_GT(static_cast<double>(house.samples), 0.98 * 5 * 3600 * hours);
}

}  // namespace
}  // namespace mgtd::daemon
