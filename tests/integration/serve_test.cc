// SPDX-License-Identifier: Apache-2.0
// The workbench on files by the real programs: jobs over HTTP, and that their answers are those of the
// terminal.
#include <gmock/gmock.h>

#include <csignal>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "tests/support/checkout.h"
#include "tests/support/child_process.h"
#include "tests/support/line_peer.h"

namespace mgtd::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class ServedRuns : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string scenario = source_path("tests/scenarios/hidden_temperature.toml");
    ASSERT_EQ(run({"mgt-rig", "table", "--scenario", scenario, "-o", dir_ / "poses.csv"}).exit_code, 0);
    server_ = std::make_unique<ChildProcess>(
        std::vector<std::string>{program("mgt"), "serve", dir_.path(), "--json"}, dir_.path(), "serve");
    ASSERT_TRUE(eventually([&] { return server_->out().find('\n') != std::string::npos; }));
    const json said = json::parse(server_->out());
    const std::string address = said.at("address");
    host_ = address.substr(7, address.size() - 8);
    token_ = said.at("token");
  }
  Finished run(std::vector<std::string> words) {
    words[0] = program(words[0]);
    return run_program(std::move(words), dir_.path());
  }
  /// The body of the answer, which is one line.
  std::string ask(const std::string& method, const std::string& target, const std::string& body = "") {
    LinePeer peer = LinePeer::tcp(static_cast<std::uint16_t>(std::stoi(host_.substr(host_.rfind(':') + 1))));
    peer.send(method + " " + target + " HTTP/1.1\r\nHost: " + host_ + "\r\nConnection: close\r\n" +
              "Authorization: Bearer " + token_ + "\r\nContent-Length: " + std::to_string(body.size()) +
              "\r\n\r\n" + body + "\n");
    EXPECT_TRUE(eventually([&] {
      peer.pump();
      return peer.closed;
    }));
    std::string out;
    for (const std::string& line : peer.lines) out = line.starts_with("{") ? line : out;
    return out;
  }
  /// "running" where we ask more often than is answered.
  json state(int job) {
    json out = json::parse(ask("GET", "/jobs/" + std::to_string(job)), nullptr, false);
    return out.is_object() ? out : json{{"state", "running"}};
  }
  json answer(const json& request) {
    json asked;
    EXPECT_TRUE(eventually([&] {
      asked = json::parse(ask("POST", "/jobs", request.dump()), nullptr, false);
      return asked.is_object();
    }));
    const int job = asked.at("job");
    json now;
    EXPECT_TRUE(eventually([&] {
      now = state(job);
      return now.at("state") != "waiting" && now.at("state") != "running";
    }));
    EXPECT_EQ(now.at("state"), "done") << now;
    json out;
    EXPECT_TRUE(eventually([&] {
      out = json::parse(ask("GET", "/jobs/" + std::to_string(job) + "/result"), nullptr, false);
      return out.is_object();
    }));
    return out;
  }

  TemporaryDirectory dir_;
  std::unique_ptr<ChildProcess> server_;
  std::string host_, token_;
};

TEST_F(ServedRuns, AJobAnswersWhatTheTerminalAnswers) {
  EXPECT_EQ(answer({{"verb", "import"}, {"run", "poses.csv"}}).value("poses", 0), 157);
  EXPECT_TRUE(eventually([&] { return ask("GET", "/runs").find("poses.mgtrun") != std::string::npos; }));
  const json explained = answer({{"verb", "explain"}, {"run", "poses.mgtrun"}});
  const Finished shown = run({"mgt", "explain", dir_ / "poses.mgtrun", "--confusion", "--impact", "--json"});
  EXPECT_EQ(explained, json::parse(shown.out));
  const std::string best = explained.at("candidates").at(0).at("spec");
  const json added = answer({{"verb", "add"}, {"run", "poses.mgtrun"}, {"args", {{"effect", best}}}});
  EXPECT_EQ(added.at("kept"), true);
  EXPECT_LT(added.at("held_out_after_nT"), added.at("held_out_before_nT").get<double>() / 10);
  const json after = answer({{"verb", "explain"}, {"run", "poses.mgtrun"}});
  EXPECT_EQ(after.at("verdict"), "PASS") << "not the answer from before the change";
  EXPECT_EQ(answer({{"verb", "undo"}, {"run", "poses.mgtrun"}}).at("model").size(), 0U);
}

TEST_F(ServedRuns, ARefusedFitAnswersWithWhatWasMeasured) {
  // The first twenty poses turn the table about the vertical alone.
  std::ifstream whole(dir_ / "poses.csv");
  std::ofstream part(dir_ / "flat.csv");
  std::string line;
  for (int i = 0; i <= 20 && std::getline(whole, line); ++i) part << line << '\n';
  part.close();
  const json said = answer({{"verb", "compare"}, {"run", "flat.csv"}});
  EXPECT_EQ(said.at("error").at("code"), "refused");
  EXPECT_THAT(said.at("error").at("message").get<std::string>(), HasSubstr("lie on a plane"));
  EXPECT_EQ(said.at("poses").at("reading_nT").at("s4.z").size(), 20U);
  EXPECT_EQ(said.at("panels").size(), 9U);
}

TEST_F(ServedRuns, CancelledJobsEndAndTheNextOneRuns) {
  const std::string scenario = source_path("tests/scenarios/hidden_temperature.toml");
  ASSERT_EQ(run({"mgt-rig", "table", "--scenario", scenario, "--poses", "grid5832", "-o", dir_ / "many.csv"})
                .exit_code,
            0);
  const json slow{{"verb", "explain"}, {"run", "many.csv"}};
  EXPECT_EQ(json::parse(ask("POST", "/jobs", slow.dump())).at("job"), 1);
  const json other{{"verb", "explain"}, {"run", "many.csv"}, {"args", {{"without", {1}}}}};
  EXPECT_EQ(json::parse(ask("POST", "/jobs", other.dump())).at("job"), 2);
  const json next{{"verb", "fit"}, {"run", "poses.csv"}};
  EXPECT_EQ(json::parse(ask("POST", "/jobs", next.dump())).at("job"), 3);
  EXPECT_EQ(state(1).at("state"), "running");
  EXPECT_EQ(state(2).at("state"), "running") << "nothing is acquired: two processors may compute";
  EXPECT_EQ(state(3).at("state"), "waiting");
  EXPECT_EQ(state(3).at("before"), 2);
  EXPECT_TRUE(eventually([&] { return state(1).value("said", "").starts_with("explain: working for "); }))
      << "it does not say how far it is";
  EXPECT_EQ(json::parse(ask("DELETE", "/jobs/1")).at("state"), "cancelled");
  EXPECT_TRUE(eventually([&] { return state(3).at("state") == "done"; }));
  EXPECT_TRUE(eventually([&] { return state(1).at("state") == "cancelled"; }));
}

TEST_F(ServedRuns, CtrlCEndsItWithItsJobs) {
  const json slow{{"verb", "explain"}, {"run", "poses.csv"}};
  ask("POST", "/jobs", slow.dump());
  server_->signal(SIGINT);
  const auto finished = server_->wait();
  ASSERT_TRUE(finished);
  EXPECT_EQ(finished->exit_code, 0);
}

TEST_F(ServedRuns, WhatIsNoRunIsRefused) {
  const Finished none = run({"mgt", "serve", dir_ / "nothing"});
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_THAT(none.err, HasSubstr("no run and no folder"));
}

TEST_F(ServedRuns, AnOccupiedPortIsRefusedWithTheOptionForAnother) {
  const Finished second = run({"mgt", "serve", dir_.path(), "--port", host_.substr(host_.rfind(':') + 1)});
  EXPECT_EQ(second.exit_code, 2);
  EXPECT_THAT(second.err, HasSubstr("is occupied by another program"));
  EXPECT_THAT(second.err, HasSubstr("choose another port with --port"));
}

}  // namespace
}  // namespace mgtd::testing
