// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "calib/fit/method_choice/fit.h"
#include "daemon/cli/array_flags.h"
#include "daemon/store/pose_source.h"

/// FitFlags holds the options that every command with a fit understands; this header also says how they
/// combine with what a run file states.
namespace mgtd::daemon::cli {

struct FitFlags {
  std::string method{"joint"};
  std::vector<std::string> further;  ///< runs that are judged together with the first
  std::vector<std::string> with;     ///< effects by name; "none" leaves the model that the run file keeps
  bool keep_all{false};              ///< leave no reading out
  std::string without;               ///< numbers of poses that are left out this once
  std::optional<double> field_nT, field_sd_nT, inclination_deg, declination_deg, table_sd_deg;
  std::optional<std::uint64_t> seed;
  ArrayFlags array;
  /// Of another file of the command, for a pose table, which has no places itself.
  std::optional<calib::sensor::Geometry> known_places{};
  bool places_needed{true};  ///< false: the places are those of a calibration
};

std::shared_ptr<FitFlags> add_fit_flags(CLI::App* command);
/// The same for commands that fit several files, each by itself: numbers of poses and further runs belong to
/// one.
std::shared_ptr<FitFlags> add_fit_flags_of_several(CLI::App* command);
/// The same for commands that only know the joint fit.
std::shared_ptr<FitFlags> add_model_flags(CLI::App* command);
/// The same for commands about the model that a run file keeps, and no other.
std::shared_ptr<FitFlags> add_current_model_flags(CLI::App* command);
/// Those about the field alone.
void add_field_flags(CLI::App* command, FitFlags& flags);
/// That about the table's angles alone.
void add_table_flag(CLI::App* command, FitFlags& flags);

/// What was said of the field, the seed and the array, as options of a command line: name and value.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> field_options(const FitFlags& flags);

/// RUN, and the further runs behind it.
[[nodiscard]] Result<store::PoseSource> read_source(const std::string& run, const FitFlags& flags);

/// The files that a command with these flags reads, RUN first; empty names are none.
[[nodiscard]] std::vector<std::string> files_read(const std::string& run, const FitFlags& flags);

/// Says on stderr which poses of a run file are masked.
void tell_masked(const store::PoseSource& source);

/// What the command line says goes before what the run file says, and that before the defaults. Effects come
/// beside those of the model that the run file keeps; one of the same name stands in its place.
[[nodiscard]] Result<calib::fit::FitOptions> fit_options(const FitFlags& flags,
                                                         const store::PoseSource& source);

}  // namespace mgtd::daemon::cli
