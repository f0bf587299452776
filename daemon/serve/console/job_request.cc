// SPDX-License-Identifier: Apache-2.0
#include "daemon/serve/console/job_request.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "calib/effects/effect_spec.h"
#include "daemon/store/pose_numbers.h"
#include "proto/json_line.h"
#include "proto/pose_numbers_text.h"
#include "proto/shell_word.h"

namespace mgtd::daemon::serve::console {
namespace {

using nlohmann::json;
using enum ArgumentKind;

constexpr int kMostPose = 1'000'000'000;
constexpr std::size_t kLongestText = 500, kMostSpecs = 32, kMostPoses = 20'000;

// What every judging command takes: effects beside the model, poses left out this once.
constexpr JobArgument kRun{"", run, "", true}, kWith{"with", specs, "--with"},
    kWithout{"without", poses, "--without"};

constexpr std::array kJudged{kRun, kWith, kWithout};
constexpr std::array kOfOne{JobArgument{"effect", effect, "", true}, kRun, JobArgument{"at", text, "--at"},
                            kWith, kWithout};
constexpr std::array kNext{kRun, JobArgument{"effect", effect, ""}, JobArgument{"rival", effect, ""}, kWith,
                           kWithout};
constexpr std::array kRunAlone{kRun};
constexpr std::array kChange{JobArgument{"effect", effect, "", true}, kRun,
                             JobArgument{"force", flag, "--force"}, JobArgument{"try", flag, "--try"}};
constexpr std::array kMask{kRun, JobArgument{"poses", poses, "", true},
                           JobArgument{"why", text, "--why", true}};
constexpr std::array kUnmask{kRun, JobArgument{"poses", poses, "", true}, JobArgument{"why", text, "--why"}};
constexpr std::array kDefine{kRun,
                             JobArgument{"name", name, "", true},
                             JobArgument{"formula", formula, ""},
                             JobArgument{"level", text, "--level"},
                             JobArgument{"scale", text, "--scale"},
                             JobArgument{"unit", text, "--unit"},
                             JobArgument{"scan", text, "--scan"},
                             JobArgument{"prior", number, "--prior"},
                             JobArgument{"drop", flag, "--drop"},
                             JobArgument{"try", flag, "--try"}};
constexpr std::array kImport{kRun, JobArgument{"", made, "-o", true}};
constexpr std::array kReport{kRun, kWith};

constexpr std::array kVerbs{
    JobVerb{"compare", kJudged, "--poses --json"},
    JobVerb{"explain", kJudged, "--confusion --impact --json"},
    JobVerb{"fit", kJudged, "--json"},
    JobVerb{"why", kOfOne, "--poses --json"},
    JobVerb{"discover", kJudged, "--json"},
    JobVerb{"next", kNext, "--poses --json"},
    JobVerb{.name = "model",
            .arguments = kRunAlone,
            .fixed = "--json",
            .of_tables = false,
            .takes_model_options = false},
    JobVerb{.name = "add",
            .arguments = kChange,
            .fixed = "--json",
            .changes = true,
            .of_tables = true,
            .takes_who = true},
    JobVerb{.name = "drop",
            .arguments = kChange,
            .fixed = "--json",
            .changes = true,
            .of_tables = false,
            .takes_who = true},
    JobVerb{.name = "undo",
            .arguments = kRunAlone,
            .fixed = "--json",
            .changes = true,
            .of_tables = false,
            .takes_model_options = false,
            .takes_who = true},
    JobVerb{.name = "mask",
            .arguments = kMask,
            .fixed = "--json",
            .changes = true,
            .of_tables = false,
            .takes_who = true},
    JobVerb{.name = "unmask",
            .arguments = kUnmask,
            .fixed = "--json",
            .changes = true,
            .of_tables = false,
            .takes_who = true},
    JobVerb{.name = "define", .arguments = kDefine, .fixed = "--json", .changes = true, .of_tables = true},
    JobVerb{.name = "import",
            .arguments = kImport,
            .fixed = "--json",
            .changes = true,
            .takes_model_options = false},
    JobVerb{.name = "report", .arguments = kReport, .fixed = "-o /dev/stdout"},
};

tl::unexpected<Error> wrong(const JobVerb& verb, const JobArgument& argument, std::string_view what) {
  return fail(ErrorCode::bad_input, fmt::format("{}: {} {}", verb.name, argument.name, what));
}

bool one_line(const std::string& text) {
  return !text.empty() && text.size() <= kLongestText && std::none_of(text.begin(), text.end(), [](char c) {
    return static_cast<unsigned char>(c) < ' ' || c == 0x7f;
  });
}

bool is_effect(const json& value) {
  if (!value.is_string()) return false;
  const auto& spec = value.get_ref<const std::string&>();
  return one_line(spec) && spec.front() != '-' && calib::effects::EffectSpec::parse(spec).has_value();
}

bool are_poses(const json& value) {
  return value.is_array() && !value.empty() && value.size() <= kMostPoses &&
         std::all_of(value.begin(), value.end(),
                     [](const json& p) { return p.is_number_integer() && p >= 0 && p <= kMostPose; });
}

bool is_name(const std::string& text) {
  return one_line(text) && text.front() != '-' && std::all_of(text.begin(), text.end(), [](char c) {
           return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-' || c == '.';
         });
}

Result<void> check(const JobVerb& verb, const JobArgument& argument, const json& value) {
  const bool is_text = value.is_string() && one_line(value.get_ref<const std::string&>());
  switch (argument.kind) {
    case run:
    case made:
      break;
    case flag:
      if (!value.is_boolean()) return wrong(verb, argument, "is true or false");
      break;
    case effect:
      if (!is_effect(value)) return wrong(verb, argument, "is no effect: NAME[@WHERE][,PARAM=VALUE]");
      break;
    case specs:
      if (!value.is_array() || value.size() > kMostSpecs ||
          !std::all_of(value.begin(), value.end(), is_effect))
        return wrong(verb, argument, "is no list of effects");
      break;
    case poses:
      if (!are_poses(value)) return wrong(verb, argument, "is no list of pose numbers");
      break;
    case name:
      if (!is_text || !is_name(value)) return wrong(verb, argument, "has letters, digits, '_', '-' and '.'");
      break;
    case formula:
      if (!is_text) return wrong(verb, argument, "is one line of at most 500 characters");
      if (value.get_ref<const std::string&>().front() == '-')
        return wrong(verb, argument, "begins with '-': write 0 in front of it");
      break;
    case text:
      if (!is_text) return wrong(verb, argument, "is one line of at most 500 characters");
      break;
    case number:
      if (!value.is_number() || !std::isfinite(value.get<double>()))
        return wrong(verb, argument, "is no number");
      break;
  }
  return {};
}

std::string pose_text(const json& value) { return pose_numbers_text(value.get<std::set<int>>()); }

/// The value as a word.
std::string word_of(const JobArgument& argument, const json& value) {
  switch (argument.kind) {
    case poses:
      return pose_text(value);
    case number:
      return fmt::format("{}", value.get<double>());
    default:
      return value.get<std::string>();
  }
}

const JobVerb* verb_called(std::string_view wanted) {
  const auto found =
      std::find_if(kVerbs.begin(), kVerbs.end(), [&](const JobVerb& v) { return v.name == wanted; });
  return found == kVerbs.end() ? nullptr : &*found;
}

std::vector<std::string> split(std::string_view words) {
  std::istringstream in{std::string(words)};
  std::vector<std::string> out;
  for (std::string word; in >> word;) out.push_back(word);
  return out;
}

}  // namespace

std::span<const JobVerb> job_verbs() { return kVerbs; }

bool JobRequest::changes() const { return verb->changes && !arguments.value("try", false); }

Result<JobRequest> parse_job_request(std::string_view body) {
  constexpr std::string_view kExample = R"({"verb":"explain","run":"monday.mgtrun","args":{}})";
  auto read = parse_json_object(body, kExample);
  if (!read) return tl::unexpected(read.error());
  for (const char* key : {"verb", "run"}) {
    if (!read->contains(key) || !(*read)[key].is_string())
      return fail(ErrorCode::bad_input, fmt::format("a job has the text \"{}\"", key),
                  fmt::format("for instance {}", kExample));
  }
  const std::string verb_name = (*read)["verb"];
  JobRequest out{.verb = verb_called(verb_name), .run = (*read)["run"], .arguments = json::object()};
  if (out.verb == nullptr) {
    std::vector<std::string_view> names;
    for (const JobVerb& v : kVerbs) names.push_back(v.name);
    return fail(ErrorCode::bad_input, fmt::format("there is no job {}", excerpt(verb_name)),
                fmt::format("there are: {}", fmt::join(names, ", ")));
  }
  if (read->contains("args")) out.arguments = (*read)["args"];
  if (!out.arguments.is_object()) return fail(ErrorCode::bad_input, "the args of a job are an object");
  std::set<std::string> known;
  for (const JobArgument& argument : out.verb->arguments) {
    if (argument.name.empty()) continue;
    const std::string key(argument.name);
    known.insert(key);
    if (!out.arguments.contains(key)) {
      if (argument.required) return wrong(*out.verb, argument, "is missing");
      continue;
    }
    if (auto ok = check(*out.verb, argument, out.arguments[key]); !ok) return tl::unexpected(ok.error());
  }
  for (const auto& [key, value] : out.arguments.items())
    if (known.count(key) == 0)
      return fail(ErrorCode::bad_input, fmt::format("{} has no argument {}", out.verb->name, excerpt(key)),
                  fmt::format("it has: {}", fmt::join(known, ", ")));
  return out;
}

std::vector<std::string> job_words(const JobRequest& request, const std::string& run, const std::string& made,
                                   const std::vector<std::string>& model_options, const std::string& who) {
  std::vector<std::string> alone{std::string(request.verb->name)}, options;
  for (const JobArgument& a : request.verb->arguments) {
    if (a.kind == ArgumentKind::run) {
      alone.push_back(run);
    } else if (a.kind == ArgumentKind::made) {
      options.insert(options.end(), {std::string(a.option), made});
    } else if (const auto value = request.arguments.find(a.name); value != request.arguments.end()) {
      if (a.kind == flag) {
        if (value->get<bool>()) options.emplace_back(a.option);
      } else if (a.kind == specs) {
        for (const json& spec : *value)
          options.push_back(fmt::format("{}={}", a.option, spec.get<std::string>()));
      } else if (a.option.empty()) {
        alone.push_back(word_of(a, *value));
      } else {
        options.push_back(fmt::format("{}={}", a.option, word_of(a, *value)));
      }
    }
  }
  std::vector<std::string> out = std::move(alone);
  out.insert(out.end(), options.begin(), options.end());
  if (request.verb->takes_model_options) out.insert(out.end(), model_options.begin(), model_options.end());
  if (request.verb->takes_who && request.changes() && !who.empty()) out.push_back("--who=" + who);
  for (std::string& word : split(request.verb->fixed)) out.push_back(std::move(word));
  return out;
}

std::string typed(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : " ") + shell_word(word);
  return out;
}

}  // namespace mgtd::daemon::serve::console
