// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "calib/effects/effect_context.h"
#include "calib/sensor/dual.h"
#include "proto/error.h"
#include "proto/pose.h"

/// An Effect is one physical effect: an exact term with named coefficients, acting at exactly one level of
/// the measurement model (g = unit gravity in the platform frame, x = R' r_i in metres from the array's
/// centre, site frame):
///
///     site       B(x) = B0 + sum term(x)                    nT, site frame
///     table      angles = recorded + sum term(angles)       azimuth, pitch, roll, two tilts of the axis; rad
///     platform   b_i = R B(R' r_i) + sum term(b, g)         nT
///     sensor     v_i = C_i A_i R_i' b_i                     sensor_model.h; has no terms of its own
///     axis       y_i = v_i + I_i + sum term(v)              nT at nominal scale
///     reference  f = |B(0)| + sum term(R B(0)/|B(0)|)       nT, what the scalar magnetometer reads
///
/// Terms of one level see the same input and add up. Derivatives come from dual numbers: an effect writes its
/// equation once, templated on the scalar, and derives from EffectOf. With all coefficients zero a term must
/// vanish.
namespace mgtd::calib::effects::laws {
class LiveMemory;
}  // namespace mgtd::calib::effects::laws

namespace mgtd::calib::effects {

enum class Level { site, table, platform, axis, reference };
[[nodiscard]] std::string_view to_string(Level level);

/// Inputs a level hands to its effects, and outputs it takes from them.
[[nodiscard]] constexpr int inputs_of(Level level) {
  return level == Level::platform ? 6 : level == Level::table ? 5 : 3;
}
[[nodiscard]] constexpr int outputs_of(Level level) {
  return level == Level::table ? 5 : level == Level::reference ? 1 : 3;
}

struct Coefficient {
  std::string name;  ///< "Gxx", "s3.z", ...
  std::string unit;  ///< as printed: "nT/m", "nT/degC"
  /// Size that occurs in practice, same unit: scale of steps and differences, never a limit.
  double typical{1};
  double prior_sd{0};  ///< of a Gaussian prior about zero; 0: no prior
};

/// Mean of covariates over the run a calibration was fitted to, by name: the zero of effects of currents.
using CovariateMeans = std::map<std::string, double>;
/// Over the poses that are fitted: those of the set "check" do not count.
[[nodiscard]] CovariateMeans covariate_means(const PoseTable& table);

/// What is known of the pose at which a term is evaluated.
struct Conditions {
  const Pose& pose;
  double t_h{0};                  ///< since the start of the run that was fitted, hours
  const Pose* previous{nullptr};  ///< the pose before it; null for the first
  const CovariateMeans* means{nullptr};
};

/// Slots: inputs of a level (at most 6), then the coefficients that act at one sensor (at most 10).
inline constexpr int kMaxActive = 10, kJetSlots = 6 + kMaxActive;
using Jet = sensor::Dual<kJetSlots>;

/// The first table angle that a pose lacks, as a column name; empty when it has all three.
[[nodiscard]] std::string_view missing_angle(const Pose& pose);

class Effect;

/// What poses of a table lack for a term to be evaluated.
struct Lack {
  std::string column{};  ///< the first that one lacks
  std::size_t poses{0};  ///< how many have none
  int first{0};          ///< number of the first

  [[nodiscard]] std::string text(std::string_view effect, const PoseTable& table) const;
};

/// An effect that reads the memory beside it, which the samples of a stream move on (live_memory.h).
struct LiveEffect {
  std::shared_ptr<const Effect> effect;
  std::shared_ptr<laws::LiveMemory> memory;
};

class Effect {
 public:
  virtual ~Effect() = default;
  [[nodiscard]] virtual std::string_view name() const = 0;  ///< of its family in the library
  /// Everything that makes this effect again (make_effect): "axis.hysteresis@s2,w=0.1".
  [[nodiscard]] virtual std::string spec() const { return std::string(name()); }
  /// This effect as it is on one run: with the memory of the readings before each pose, or with coefficients
  /// for the currents and mountings that the run has. Null when the run makes no difference. Refuses, with
  /// what is missing.
  [[nodiscard]] virtual Result<std::shared_ptr<const Effect>> bound(const EffectContext&) const {
    return std::shared_ptr<const Effect>();
  }
  /// This effect as it is on a stream, where it has a memory; null where it has none.
  [[nodiscard]] virtual LiveEffect live() const { return {}; }
  [[nodiscard]] virtual Level level() const = 0;
  [[nodiscard]] virtual const std::vector<Coefficient>& coefficients() const = 0;
  /// Indices of the coefficients that act at sensor `sensor`, in the order `c` has in term().
  [[nodiscard]] virtual std::span<const int> at(int sensor) const = 0;
  /// The same at one pose; at most kMaxActive.
  [[nodiscard]] virtual std::span<const int> active(const Conditions&, int sensor) const {
    return at(sensor);
  }
  /// The first column that the term needs and this pose has not ("s3_T_degC", "azimuth_deg"); empty when the
  /// term can be evaluated. Where it is not empty the term counts as zero and term() is not called.
  [[nodiscard]] virtual std::string_view missing(const Pose& pose) const = 0;
  /// Refuses poses that lack what the term needs, and says what is missing.
  [[nodiscard]] virtual Result<void> applicable(const PoseTable& table) const;
  [[nodiscard]] Lack lack_of(const PoseTable& table) const;
  virtual void term(const Conditions& at, int sensor, std::span<const double> in, std::span<const double> c,
                    std::span<double> out) const = 0;
  virtual void term(const Conditions& at, int sensor, std::span<const Jet> in, std::span<const Jet> c,
                    std::span<Jet> out) const = 0;
  /// Of a term that is linear in its coefficients its derivatives by them, which need no jets: out[o +
  /// outputs j] that of output o by c[j], every one of them. False, and `out` as it was, for another term.
  [[nodiscard]] virtual bool shapes(const Conditions&, int /*sensor*/, std::span<const double> /*in*/,
                                    std::span<double> /*out*/) const {
    return false;
  }
  /// What the term does not know of the way of the table before a pose, where it remembers that: a standard
  /// deviation for each radian of the table's accuracy, of one axis; c as term() has it.
  [[nodiscard]] virtual double sd_nT_per_rad(const Conditions&, int /*sensor*/, int /*axis*/,
                                             std::span<const double> /*c*/) const {
    return 0;
  }
};

/// Derive as `class Mine : public EffectOf<Mine>` and write
///     template <class S>
///     void equation(const Conditions&, int sensor, std::span<const S> in, std::span<const S> c,
///                   std::span<S> out) const;
/// which assigns every element of `out`.
template <class Self>
class EffectOf : public Effect {
 public:
  void term(const Conditions& at, int sensor, std::span<const double> in, std::span<const double> c,
            std::span<double> out) const final {
    static_cast<const Self&>(*this).template equation<double>(at, sensor, in, c, out);
  }
  void term(const Conditions& at, int sensor, std::span<const Jet> in, std::span<const Jet> c,
            std::span<Jet> out) const final {
    static_cast<const Self&>(*this).template equation<Jet>(at, sensor, in, c, out);
  }
};

using EffectPtr = std::shared_ptr<const Effect>;

/// In their order.
[[nodiscard]] std::vector<std::string> specs_of(std::span<const EffectPtr> effects);

}  // namespace mgtd::calib::effects
