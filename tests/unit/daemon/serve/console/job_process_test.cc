// SPDX-License-Identifier: Apache-2.0
// Children of the system's own programs: what they inherit, and how they end.
#include "daemon/serve/console/job_process.h"

#include <fcntl.h>
#include <gmock/gmock.h>

#include <csignal>
#include <memory>
#include <optional>

#include "tests/support/event_loop.h"

namespace mgtd::daemon::serve::console {
namespace {

using mgtd::testing::run_until;
using ::testing::HasSubstr;

class JobProcessTest : public ::testing::Test {
 protected:
  void start(const std::vector<std::string>& words, const JobBounds& bounds = {}) {
    auto started = JobProcess::start(*io_, words, bounds, [this](JobEnd end) { end_ = std::move(end); });
    ASSERT_TRUE(started) << started.error().text();
    process_ = *std::move(started);
  }
  JobEnd end() {
    EXPECT_TRUE(run_until(*io_, [this] { return end_.has_value(); }));
    return end_.value_or(JobEnd{});
  }
  JobEnd shell(const std::string& script, const JobBounds& bounds = {}) {
    start({"/bin/sh", "-c", script}, bounds);
    return end();
  }

  std::unique_ptr<boost::asio::io_context> io_ = std::make_unique<boost::asio::io_context>();
  std::shared_ptr<JobProcess> process_;
  std::optional<JobEnd> end_;
};

TEST_F(JobProcessTest, GivesWhatItPrintedAndItsExitCode) {
  const JobEnd ended = shell("echo one; echo round 2 >&2; exit 1");
  EXPECT_EQ(ended.out, "one\n");
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_EQ(ended.why, "");
  EXPECT_EQ(process_->said(), "round 2");
}

/// However much a long computation says, it is the last line that counts.
TEST_F(JobProcessTest, SaysTheLastLineOfMany) {
  shell("i=0; while [ $i -lt 20000 ]; do i=$((i + 1)); echo round $i >&2; done");
  EXPECT_EQ(process_->said(), "round 20000");
}

/// Its threads would take address space, of which a job has a bounded amount.
TEST_F(JobProcessTest, StartsNoThreadsOfOpenBLAS) {
  EXPECT_EQ(shell("echo $OPENBLAS_NUM_THREADS").out, "1\n");
}

/// Neither a port, nor a socket, nor a word of our environment.
TEST_F(JobProcessTest, InheritsNothing) {
  const int held = ::open("/dev/null", O_RDONLY);
  ASSERT_GE(held, 3);
  ::setenv("MGTD_SECRET", "x", 1);
  const JobEnd ended = shell("ls /proc/self/fd; env | grep -c SECRET; cat; echo end");
  ::close(held);
  ::unsetenv("MGTD_SECRET");
  EXPECT_EQ(ended.out, "0\n1\n2\n3\n0\nend\n");  // the last one is the folder that ls reads
}

TEST_F(JobProcessTest, IsKilled) {
  start({"/bin/sh", "-c", "exec sleep 1000"});
  process_->kill();
  EXPECT_EQ(end().exit_code, -1);
  EXPECT_THAT(end_->why, HasSubstr("Killed"));
}

TEST_F(JobProcessTest, DiesWithItsOwner) {
  start({"/bin/sh", "-c", "echo $$ >&2; exec sleep 1000"});
  ASSERT_TRUE(run_until(*io_, [this] { return !process_->said().empty(); }));
  const int pid = std::stoi(std::string(process_->said()));
  EXPECT_EQ(::kill(pid, 0), 0);
  process_.reset();
  io_.reset();
  EXPECT_EQ(::kill(pid, 0), -1);
}

TEST_F(JobProcessTest, ProcessorTimeIsBounded) {
  JobBounds bounds;
  bounds.processor_s = 1;
  const JobEnd ended = shell("while :; do :; done", bounds);
  EXPECT_EQ(ended.exit_code, -1);
  EXPECT_THAT(ended.why, HasSubstr("more than 1 s of a processor"));
}

TEST_F(JobProcessTest, OutputIsBounded) {
  JobBounds bounds;
  bounds.output_bytes = 1'000'000;
  const JobEnd ended = shell("exec cat /dev/zero", bounds);
  EXPECT_THAT(ended.why, HasSubstr("more than 1 MB"));
}

TEST_F(JobProcessTest, AProgramThatIsNotThereIsSaid) {
  start({"/nowhere/mgt"});
  EXPECT_THAT(end().why, HasSubstr("could not be started"));
}

}  // namespace
}  // namespace mgtd::daemon::serve::console
