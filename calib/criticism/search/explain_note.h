// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "calib/criticism/tests/candidate.h"
#include "calib/criticism/tests/exchange_in_run.h"

/// An ExplainNote holds one thing that explain() noticed beside its verdict, as a value;
/// report/explain_note_text.h puts it into words.
namespace mgtd::calib::criticism::search {

// Of the data:
struct SensorsMirrored {
  std::size_t of;                    ///< sensors in the array
  std::vector<std::size_t> sensors;  ///< by number, from 1
};
struct TableAnglesContradict {
  double sd_rad{0}, limit_rad{0};  ///< rms of the attitudes about the table angles, per pose
};
struct TableAnglesRough {
  double estimated_rad{0}, stated_rad{0};  ///< standard deviation of a table angle
};
struct PosesContradict {
  double share{0};  ///< of all poses
};
struct NoiseOverstated {
  std::string channel;       ///< "s3.z"
  double residual_ratio{0};  ///< its residual over the stated noise
};
/// A residual far above the noise that has no shape, or that a few readings make.
struct ResidualWithoutLaw {
  double noise_inflation{1};             ///< residual over noise
  double residual_nT{0}, typical_nT{0};  ///< Scatter
  double contradicting{0};               ///< share of all poses
};
struct SensorsExchanged {
  tests::ExchangeInRun exchange;
};
/// The run file does not hold how the table moved between poses, which a memory of the cores depends on.
struct TablePathUnknown {};

// Of the effects that were found:
struct ExcessRemains {
  std::string effect;
  double share{0};  ///< of the excess that it accounts for
};
struct FallNotAsPredicted {
  double realised{0}, predicted{0};  ///< fall of chi-square
};
struct LackOfFitRemains {
  std::string effect, where;
  double log10_p{0};
};
struct SizeTooSmall {
  std::string effect;
  double d{0};
};
/// Several steps or thresholds on one axis.
struct StepsFollowCurve {};
struct EvidenceOfOnePose {
  int pose{0};
  std::string effect;
};
struct FitWithEffectFailed {
  std::string spec, why;
};
struct SizeUnusual {
  tests::Candidate candidate;
};
struct SizeBeyondAll {
  tests::Candidate candidate;  ///< as last seen; it is not named
};
/// Of a recording of single samples, whose residual the effects describe and do not explain.
struct DescribesRecording {
  std::set<std::string> effects;     ///< that are not named
  double before_nT{0}, after_nT{0};  ///< residual without and with them
  bool curve{false};                 ///< they are steps that follow a curve; else they take the lesser part
};
/// Beside offsets that wander, the fit with the effect does not find it.
struct LostInWandering {
  std::string effect, where;
  double d{0};               ///< by which it stood out
  double log10_p_of_fit{0};  ///< that its coefficients are zero
};
/// It took next to nothing of a residual far above the noise.
struct TookLittle {
  std::string effect, where;
  double d{0};                       ///< by which it stood out
  double before_nT{0}, after_nT{0};  ///< residual without and with it
};
/// The residual stays far above the noise, without a shape that a test sees.
struct FarAboveNoise {
  double residual_nT{0}, noise_nT{0};
};
struct LawOfNoLibrary {
  std::string where;
  std::set<std::string> effects;  ///< that only describe it
};

using ExplainNote =
    std::variant<SensorsMirrored, TableAnglesContradict, TableAnglesRough, PosesContradict, NoiseOverstated,
                 ResidualWithoutLaw, SensorsExchanged, TablePathUnknown, ExcessRemains, FallNotAsPredicted,
                 LackOfFitRemains, SizeTooSmall, StepsFollowCurve, EvidenceOfOnePose, FitWithEffectFailed,
                 SizeUnusual, SizeBeyondAll, DescribesRecording, LostInWandering, TookLittle, FarAboveNoise,
                 LawOfNoLibrary>;

}  // namespace mgtd::calib::criticism::search
