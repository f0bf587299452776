// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <utility>

/// An answer file keeps what the runs of a campaign answered, one JSON line each: a campaign of many hours
/// can be interrupted, and goes on with the next call. Delete the file when the program changes.
namespace mgtd::calib::testing {

/// `Answer` has to_json() and from_json() as nlohmann::json finds them; its keys are neither "kind" nor
/// "seed".
template <class Answer>
class AnswerFile {
 public:
  /// Reads what is there; without a path nothing is kept. Throws std::runtime_error with the line that is no
  /// answer; the last one, cut by an interruption, is left away.
  explicit AnswerFile(const std::string& path) {
    if (path.empty()) return;
    const std::uintmax_t whole = read(path);
    if (std::filesystem::exists(path)) std::filesystem::resize_file(path, whole);
    out_.open(path, std::ios::app);
    if (!out_) throw std::runtime_error(path + " cannot be written");
  }

  /// Null: this run has not been made.
  [[nodiscard]] const Answer* find(const std::string& kind, std::uint64_t seed) const {
    const auto found = answers_.find({kind, seed});
    return found == answers_.end() ? nullptr : &found->second;
  }

  /// On disk when it returns.
  void add(const std::string& kind, std::uint64_t seed, const Answer& answer) {
    answers_[{kind, seed}] = answer;
    nlohmann::json line = answer;
    line["kind"] = kind, line["seed"] = seed;
    if (out_.is_open()) out_ << line.dump() << '\n' << std::flush;
  }

 private:
  /// Bytes of the lines that are whole.
  std::uintmax_t read(const std::string& path) {
    std::uintmax_t whole = 0;
    std::ifstream in(path);
    std::string line;
    for (int number = 1; std::getline(in, line) && !in.eof(); ++number) {
      try {
        const auto j = nlohmann::json::parse(line);
        answers_[{j.at("kind"), j.at("seed")}] = j.get<Answer>();
      } catch (const std::exception& e) {
        throw std::runtime_error(fmt::format("{}:{}: {}", path, number, e.what()));
      }
      whole += line.size() + 1;
    }
    return whole;
  }

  std::map<std::pair<std::string, std::uint64_t>, Answer> answers_;
  std::ofstream out_;
};

}  // namespace mgtd::calib::testing
