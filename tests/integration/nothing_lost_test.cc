// SPDX-License-Identifier: Apache-2.0
// The real programs, and what must not get lost: samples over a kill, the stream from its journal, the disk
// that is full.
#include <gmock/gmock.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <csignal>
#include <filesystem>

#include "tests/integration/bench.h"
#include "tests/support/line_peer.h"
#include "tests/support/whole_file.h"

namespace mgtd::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

/// The last sample that a line tells of; none where it tells of none.
std::optional<std::uint64_t> told_until(const std::string& line) {
  const json object = json::parse(line);
  if (object.at("class") != "TENSOR" && object.at("class") != "GAP") return std::nullopt;
  return object.at(object.contains("seq") ? "seq" : "to_seq").get<std::uint64_t>();
}

/// What a client that asks from `from_seq` on is told, until it has sample `last`. It reads as fast as it can
/// and looks at the lines afterwards: one that took its time over each would be told that it is too slow.
std::vector<std::string> stream_from(const Bench& bench, std::uint64_t from_seq, std::uint64_t last) {
  LinePeer peer = LinePeer::unix_socket(bench.dir() / "stream.sock");
  peer.send_line(R"({"watch":{"class":["TENSOR"],"from_seq":)" + std::to_string(from_seq) + "}}");
  EXPECT_TRUE(eventually([&] {
    peer.pump();
    return !peer.lines.empty() && told_until(peer.lines.back()).value_or(0) >= last;
  })) << "sample "
      << last << " did not come";
  std::vector<std::string> out;
  for (const std::string& line : peer.lines) {
    const auto until = told_until(line);
    if (!until) continue;
    out.push_back(line);
    if (*until >= last) break;
  }
  return out;
}

/// Every number from `next` on once; gives the one after the last.
std::uint64_t tiles(const std::vector<std::string>& lines, std::uint64_t next) {
  for (const std::string& line : lines) {
    const json object = json::parse(line);
    const bool sample = object.at("class") == "TENSOR";
    EXPECT_EQ(object.at(sample ? "seq" : "from_seq"), next) << line;
    next = object.at(sample ? "seq" : "to_seq").get<std::uint64_t>() + 1;
  }
  return next;
}

/// Of the sample that comes next.
std::uint64_t newest(const Bench& bench) {
  LinePeer peer = LinePeer::unix_socket(bench.dir() / "stream.sock");
  peer.send_line(R"({"watch":{"class":["TENSOR"]}})");
  std::optional<std::uint64_t> seq;
  EXPECT_TRUE(eventually([&] {
    peer.pump();
    for (const std::string& line : peer.lines) {
      const json object = json::parse(line);
      if (object.at("class") == "TENSOR") seq = object.at("seq");
    }
    return seq.has_value();
  })) << "no sample comes";
  return seq.value_or(0);
}

std::vector<std::string> lines_of(const std::string& file) {
  std::vector<std::string> out;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) out.push_back(line);
  return out;
}

/// A whole run with its calibration accepted, a kill, another life: the client that comes back is told of
/// every epoch, and the journals make the very same lines again.
TEST(NothingLost, OverAKillTheStreamIsWholeAndItsJournalMakesItAgain) {
  Bench bench("20");
  bench.start_daemon();
  ASSERT_EQ(bench.mgt(kShortRun).exit_code, 0) << bench.daemon().err();
  ASSERT_EQ(bench.mgt({"calibrations", "accept", "latest"}).exit_code, 0);
  ASSERT_EQ(bench.rig({"fault", bench.ports(), "unplug", "fluxgate2", "for", "10"}).exit_code, 0);
  const std::uint64_t seen = newest(bench);
  const auto first_life = stream_from(bench, 0, seen);
  EXPECT_EQ(tiles(first_life, 0), seen + 1);
  // On disk after half a second of the rig's time; then the daemon is killed, without a word.
  ASSERT_TRUE(eventually([&] { return newest(bench) > seen + 200; }));
  bench.daemon().signal(SIGKILL);
  ASSERT_TRUE(bench.daemon().wait());
  bench.start_daemon();
  const std::uint64_t end = newest(bench);
  const auto all = stream_from(bench, 0, end);
  EXPECT_EQ(tiles(all, 0), end + 1);
  ASSERT_GE(all.size(), first_life.size());
  EXPECT_TRUE(std::equal(first_life.begin(), first_life.end(), all.begin())) << "a line came back changed";
  EXPECT_EQ(std::count_if(all.begin(), all.end(),
                          [](const std::string& line) { return line.find("without a word") != line.npos; }),
            1);
  bench.daemon().signal(SIGTERM);
  ASSERT_TRUE(bench.daemon().wait());

  std::vector<std::string> command{program("mgt"), "replay", "-o", bench.dir() / "again.ndjson", "--json"};
  for (const std::string& file : journals(bench)) command.push_back(file);
  const Finished replay = run_program(command, bench.dir().path());
  ASSERT_EQ(replay.exit_code, 0) << replay.out << replay.err;
  const json counts = json::parse(replay.out);
  EXPECT_EQ(counts.at("lives"), 2);
  EXPECT_TRUE(counts.at("parted").is_null()) << counts;
  const auto again = lines_of(bench.dir() / "again.ndjson");
  command[3] = "/dev/stdout";
  const Finished printed = run_program(command, bench.dir().path());
  EXPECT_EQ(printed.out, whole_file(bench.dir() / "again.ndjson")) << "the lines alone";
  // Of the first life what was written before the kill, of the second all.
  const auto gap = std::find_if(all.begin(), all.end(), [](const std::string& line) {
    return line.find("without a word") != line.npos;
  });
  const auto gap_again = std::find(again.begin(), again.end(), *gap);
  ASSERT_NE(gap_again, again.end());
  const auto kept = std::min(gap - all.begin(), gap_again - again.begin());
  EXPECT_GT(kept, static_cast<std::ptrdiff_t>(first_life.size()));
  for (std::ptrdiff_t i = 0; i < kept; ++i)
    ASSERT_EQ(again[static_cast<std::size_t>(i)], all[static_cast<std::size_t>(i)]);
  ASSERT_GE(again.end() - gap_again, all.end() - gap);
  EXPECT_TRUE(std::equal(gap, all.end(), gap_again)) << "the second life differs";
}

/// No file can grow: recording stops and says so, the stream goes on.
TEST(NothingLost, ADiskThatRefusesStopsRecordingAndNothingElse) {
  Bench bench("20");
  std::filesystem::create_directories(bench.dir() / "runs");
  std::ofstream(bench.dir() / "stream") << "a file where the folder of the samples should be";
  bench.start_daemon();
  const std::uint64_t seen = newest(bench);
  ASSERT_TRUE(eventually([&] { return newest(bench) > seen + 100; }));
  const json status = bench.ask({"status"});
  EXPECT_EQ(status.at("ring").at("state"), "stopped");
  EXPECT_THAT(status.at("ring").at("why").get<std::string>(), HasSubstr("everything else goes on"));
  EXPECT_GT(status.at("ring").at("bytes_lost").get<std::uint64_t>(), 0U);
  EXPECT_EQ(status.at("journal").at("state"), "writing");
  EXPECT_THAT(bench.mgt({"status"}).out, HasSubstr("samples   stopped"));
  std::filesystem::remove(bench.dir() / "stream");
  ASSERT_TRUE(eventually([&] { return bench.ask({"status"}).at("ring").at("state") == "writing"; }))
      << bench.daemon().err();
  const std::string log = bench.daemon().err();
  EXPECT_THAT(log, HasSubstr("recorded again"));
  EXPECT_EQ(bench.ask({"status"}).at("ring").at("stops"), 1);
}

/// A disk of its own, which nobody outside this test sees.
class SmallDisk {
 public:
  SmallDisk(std::string where, const char* size) : where_(std::move(where)) {
    std::filesystem::create_directories(where_);
    mounted_ = ::unshare(CLONE_NEWNS) == 0 &&
               ::mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
               ::mount("tmpfs", where_.c_str(), "tmpfs", 0, size) == 0;
  }
  ~SmallDisk() {
    if (mounted_) ::umount2(where_.c_str(), MNT_DETACH);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  [[nodiscard]] bool mounted() const { return mounted_; }
  void fill() const {
    std::ofstream ballast(where_ + "/ballast");
    const std::string page(4096, 'x');
    while (ballast << page << std::flush) {
    }
  }
  void make_room() const { std::filesystem::remove(where_ + "/ballast"); }

 private:
  std::string where_;
  bool mounted_{false};
};

/// In the middle of a run: no pose counts that is not stored, the run waits, the stream does not.
TEST(NothingLost, OnAFullDiskTheRunPausesAndGoesOnWhenThereIsRoom) {
  Bench bench("20");
  const SmallDisk disk(bench.dir() / "runs", "size=128m");
  if (!disk.mounted()) GTEST_SKIP() << "mounting is not allowed here";
  bench.start_daemon();
  ASSERT_EQ(bench.mgt(detached(kShortRun)).exit_code, 0);
  const auto run = [&] { return bench.ask({"run", "status"}); };
  ASSERT_TRUE(eventually([&] { return run().value("pose", 0) >= 3; }));
  disk.fill();
  ASSERT_TRUE(eventually([&] { return run().value("state", "") == "paused"; })) << run();
  EXPECT_THAT(run().at("message").get<std::string>(), HasSubstr("could not be stored"));
  ASSERT_TRUE(eventually([&] { return bench.ask({"status"}).at("journal").at("state") == "stopped"; }));
  EXPECT_THAT(bench.ask({"status"}).at("journal").at("why").get<std::string>(), HasSubstr("free space"));
  const int stored = run().at("pose");
  const std::uint64_t seen = newest(bench);
  constexpr std::uint64_t kTwoMinutes = 6000;  // of the rig's time
  ASSERT_TRUE(eventually([&] { return newest(bench) > seen + kTwoMinutes; })) << "the stream stands";
  const std::string log = bench.daemon().err();
  for (const char* topic : {"run state: ", "run log: ", "table path: ", "checks: "}) {
    int lines = 0;
    for (std::size_t at = 0; (at = log.find(topic, at)) != std::string::npos; ++at) ++lines;
    EXPECT_LE(lines, 5) << topic << "is said on a change and once a minute\n" << log;
  }
  EXPECT_THAT(log, HasSubstr("more since the last line)"));
  disk.make_room();
  const Finished resumed = bench.mgt({"run", "resume"});
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err << bench.daemon().err();
  EXPECT_GT(run().at("pose").get<int>(), stored);
  EXPECT_EQ(run().at("pose"), run().at("poses")) << "a pose is missing";
  ASSERT_TRUE(eventually([&] { return bench.ask({"status"}).at("journal").at("state") == "writing"; }));
  EXPECT_GT(bench.ask({"status"}).at("journal").at("bytes_lost").get<std::uint64_t>(), 0U);
  bench.daemon().signal(SIGTERM);
  ASSERT_TRUE(bench.daemon().wait());
}

/// A socket of the service manager, as systemd holds it.
class NotifySocket {
 public:
  explicit NotifySocket(const std::string& path) : fd_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, sizeof address.sun_path - 1);
    EXPECT_EQ(::bind(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  }
  ~NotifySocket() { ::close(fd_); }
  NotifySocket(const NotifySocket&) = delete;
  NotifySocket& operator=(const NotifySocket&) = delete;

  /// Messages since the last call that contain `word`.
  int count(const std::string& word) {
    int found = 0;
    char text[4096];
    for (ssize_t n = 0; (n = ::recv(fd_, text, sizeof text, 0)) > 0;)
      found += std::string(text, static_cast<std::size_t>(n)).find(word) != std::string::npos ? 1 : 0;
    return found;
  }

 private:
  int fd_;
};

/// Ready when the sockets listen, fed while data move or are honestly missing, starved when the program
/// hangs.
TEST(NothingLost, TheWatchdogIsFedByTheDataPath) {
  Bench bench("20");
  NotifySocket manager(bench.dir() / "notify");
  ChildProcess daemon({"/usr/bin/env", "NOTIFY_SOCKET=" + (bench.dir() / "notify"), "WATCHDOG_USEC=4000000",
                       program("mgtd"), "--config", bench.config_path()},
                      bench.dir().path(), "mgtd");
  ASSERT_TRUE(eventually([&] { return manager.count("READY=1") == 1; })) << daemon.err();
  ASSERT_TRUE(eventually([&] { return bench.mgt({"status", "--wait", "10"}).exit_code == 0; }));
  ASSERT_TRUE(eventually([&] { return manager.count("WATCHDOG=1") > 0; }));
  for (const char* port : {"fluxgate1", "fluxgate2", "fluxgate3", "fluxgate4"})
    ASSERT_EQ(bench.rig({"fault", bench.ports(), "unplug", port}).exit_code, 0);
  static_cast<void>(manager.count(""));
  int fed = 0;
  EXPECT_TRUE(eventually([&] { return (fed += manager.count("WATCHDOG=1")) >= 3; }))
      << "gaps are movement too: a cable that is out must not restart the daemon";
  daemon.signal(SIGTERM);
  EXPECT_TRUE(eventually([&] { return manager.count("STOPPING=1") > 0; }));
  ASSERT_TRUE(daemon.wait());
}

}  // namespace
}  // namespace mgtd::testing
