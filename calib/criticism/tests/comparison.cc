// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "calib/criticism/tests/criticism.h"
#include "calib/criticism/tests/residual_fields.h"
#include "calib/fit/joint/joint_report.h"
#include "calib/fit/joint/pose_residuals.h"
#include "calib/poses/kept_columns.h"
#include "calib/stats/chi_square.h"
#include "calib/stats/f_distribution.h"

namespace mgtd::calib::criticism::tests {
namespace {

constexpr std::size_t kBins = 8;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

struct Covariate {
  std::string name;
  std::vector<double> values;  ///< by pose; NaN where it is not known
};

std::vector<Covariate> covariates(const fit::joint::JointProblem& problem) {
  std::vector<Covariate> out;
  const auto add = [&](std::string name, auto&& value) {
    Covariate c{std::move(name), {}};
    std::set<double> different;
    for (const fit::joint::JointPose& pose : problem.poses) {
      c.values.push_back(value(pose));
      if (std::isfinite(c.values.back())) different.insert(c.values.back());
    }
    if (different.size() > 1) out.push_back(std::move(c));
  };
  add("time_h", [](const fit::joint::JointPose& p) { return p.t_h; });
  add("azimuth_deg", [](const fit::joint::JointPose& p) {
    return p.pose->azimuth_rad ? to_deg(*p.pose->azimuth_rad) : kNone;
  });
  for (std::size_t i = 0; i < problem.geometry.sensors(); ++i) {
    add(fmt::format("s{}_T_degC", i + 1),
        [i](const fit::joint::JointPose& p) { return p.pose->T_degC[i].value_or(kNone); });
  }
  add("mount", [](const fit::joint::JointPose& p) {
    return p.pose->mount ? static_cast<double>(*p.pose->mount) : kNone;
  });
  std::set<std::string> columns;
  for (const fit::joint::JointPose& pose : problem.poses)
    for (const auto& [name, value] : pose.pose->covariates)
      if (!poses::never_fitted(name)) columns.insert(name);
  for (const std::string& column : columns) {
    add(column, [&](const fit::joint::JointPose& p) {
      const auto found = p.pose->covariates.find(column);
      return found == p.pose->covariates.end() ? kNone : found->second;
    });
  }
  return out;
}

/// Poses by the covariate, in equally filled bins; equal values stay together.
std::vector<std::vector<Eigen::Index>> bins_of(const Covariate& c) {
  std::vector<Eigen::Index> order;
  for (std::size_t k = 0; k < c.values.size(); ++k)
    if (std::isfinite(c.values[k])) order.push_back(static_cast<Eigen::Index>(k));
  const auto value = [&](Eigen::Index k) { return c.values[static_cast<std::size_t>(k)]; };
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return value(a) < value(b); });
  std::vector<std::vector<Eigen::Index>> out;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool full = !out.empty() && out.back().size() * kBins >= order.size();
    if (out.empty() || (full && value(order[i]) > value(order[i - 1]))) out.emplace_back();
    out.back().push_back(order[i]);
  }
  return out;
}

/// Those that make the same bins as one before them say nothing of their own.
std::vector<std::pair<std::string, std::string>> take_out_alike(std::vector<Covariate>& all) {
  std::vector<std::pair<std::string, std::string>> out;
  std::vector<Covariate> kept;
  for (Covariate& c : all) {
    const auto bins = bins_of(c);
    const auto same =
        std::find_if(kept.begin(), kept.end(), [&](const Covariate& k) { return bins_of(k) == bins; });
    if (same == kept.end()) {
      kept.push_back(std::move(c));
    } else {
      out.emplace_back(c.name, same->name);
    }
  }
  all = std::move(kept);
  return out;
}

/// One-way analysis of variance of a component over the bins.
double log10_p_of(const Eigen::VectorXd& values, const std::vector<std::vector<Eigen::Index>>& bins,
                  std::vector<double>& means, std::vector<double>& ses) {
  double total = 0, n = 0;
  for (const auto& bin : bins)
    for (const Eigen::Index k : bin) total += values[k], ++n;
  double between = 0, within = 0;
  means.clear(), ses.clear();
  for (const auto& bin : bins) {
    const auto size = static_cast<double>(bin.size());
    const double mean = values(bin).sum() / size;
    means.push_back(mean);
    between += size * std::pow(mean - total / n, 2);
    const double squares = (values(bin).array() - mean).square().sum();
    within += squares;
    ses.push_back(size > 1 ? std::sqrt(squares / (size - 1) / size) : kNone);
  }
  const double groups = static_cast<double>(bins.size());
  if (groups < 2 || n <= groups || !(within > 0)) return 0;
  return stats::f_log10_p(between / (groups - 1) / (within / (n - groups)), groups - 1, n - groups);
}

/// Means of the covariate itself.
std::vector<double> centers_of(const Covariate& c, const std::vector<std::vector<Eigen::Index>>& bins) {
  std::vector<double> out;
  for (const auto& bin : bins) {
    double sum = 0;
    for (const Eigen::Index k : bin) sum += c.values[static_cast<std::size_t>(k)];
    out.push_back(sum / static_cast<double>(bin.size()));
  }
  return out;
}

struct Component {
  std::string name;
  Eigen::VectorXd values;
};

ResidualChannel channel_of(ResidualChannel out, const std::vector<Component>& components,
                           const std::vector<Covariate>& all) {
  for (const Component& c : components)
    out.rms += c.values.squaredNorm() /
               static_cast<double>(c.values.size() * static_cast<Eigen::Index>(components.size()));
  out.rms = std::sqrt(out.rms);
  for (const Covariate& covariate : all) {
    const auto bins = bins_of(covariate);
    Dependence best{.covariate = covariate.name, .log10_p = 1};
    for (const Component& c : components) {
      std::vector<double> means, ses;
      const double log10_p = log10_p_of(c.values, bins, means, ses);
      if (log10_p >= best.log10_p) continue;
      best.log10_p = log10_p, best.component = c.name;
      best.means = std::move(means), best.ses = std::move(ses);
    }
    best.log10_p = std::min(0.0, best.log10_p + std::log10(static_cast<double>(components.size())));
    best.centers = centers_of(covariate, bins);
    for (const double x : covariate.values) {
      if (!std::isfinite(x)) continue;
      best.from = best.to = x;
      break;
    }
    for (const double x : covariate.values)
      if (std::isfinite(x)) best.from = std::min(best.from, x), best.to = std::max(best.to, x);
    out.against.push_back(std::move(best));
  }
  std::stable_sort(out.against.begin(), out.against.end(),
                   [](const Dependence& a, const Dependence& b) { return a.log10_p < b.log10_p; });
  return out;
}

std::vector<ResidualChannel> channels_of(const fit::joint::JointFit& fit, const std::vector<Covariate>& all) {
  const ResidualFields f = residual_fields(fit);
  std::vector<Component> whitened, scalar, attitude, between, closure;
  const int sensors = fit.problem.sensors();
  for (int c = 0; c < fit.problem.channels(); ++c) {
    const std::string axis = sensor::channel_name(c);
    whitened.push_back({axis, f.whitened.row(c)});
    Eigen::VectorXd d = f.delta_nT.row(c);
    for (int i = 0; i < sensors; ++i) d -= f.delta_nT.row(3 * i + c % 3).transpose() / sensors;
    between.push_back({axis, std::move(d)});
  }
  for (int i = 0; i < sensors; ++i) scalar.push_back({fmt::format("s{}", i + 1), f.scalar_nT.row(i)});
  for (int a = 0; a < 3; ++a) attitude.push_back({std::string(1, "xyz"[a]), f.attitude_deg.row(a)});
  for (Eigen::Index i = 0; i < f.closure_nT.rows(); ++i)
    closure.push_back({f.closure_names[static_cast<std::size_t>(i)], f.closure_nT.row(i)});
  std::vector<ResidualChannel> out;
  const auto add = [&](ResidualChannel channel, const std::vector<Component>& components) {
    out.push_back(channel_of(std::move(channel), components, all));
  };
  add({"whitened", "", "reading less prediction, in units of the noise of its pose mean"}, whitened);
  add({"scalar", "nT", "|b| of each sensor less F: blind to every error of angles"}, scalar);
  if (fit.problem.has_angles)
    add({"attitude", "deg", "what the table angles had to be corrected by: blind to the sensors"}, attitude);
  const bool cross = fit.problem.geometry.cross_baseline_m().has_value();
  if (sensors > 1)
    add({"inter-sensor", "nT",
         fmt::format("b of each sensor less the mean of the {}: blind to attitude and field",
                     cross ? "four" : std::to_string(sensors))},
        between);
  if (!closure.empty())
    add({"closure", "nT",
         cross ? "curl over the baseline, and centre of 1 and 3 less that of 2 and 4: zero in any gradient"
               : "what no uniform field and no gradient makes of these sensors"},
        closure);
  return out;
}

}  // namespace

Result<Comparison> compare(const PoseTable& table, const fit::FitOptions& options) {
  const auto joint = fit::joint::profiled_options(table, options);
  if (!joint) return tl::unexpected(joint.error());
  const auto fit = fit::joint::fit_joint_at_size(table, *joint);
  if (!fit) return tl::unexpected(fit.error());
  Criticism c = criticise(*fit, CandidateEffects{}, options.seed);
  look_at_maps(c);
  const fit::joint::PoseResiduals residuals = fit::joint::pose_residuals(fit->problem, fit->state);
  Comparison out{.noise = c.noise,
                 .noise_nT = fit->noise_nT(),
                 .residual_nT = residuals.residual_nT(),
                 .axis_noise_nT = fit->pose_noise_nT,
                 .fit = std::make_shared<const fit::joint::JointFit>(*fit)};
  out.axis_residual_nT = fit->pose_noise_nT.cwiseProduct(residuals.noise_ratio) * fit->noise_inflation;
  out.chi2 = chi2_at_stated_noise(*fit, c, fit->table_sd_rad), out.dof = c.dof;
  if (c.noise.reference.known) {
    out.log10_p = c.omnibus_log10_p;
  } else if (c.noise.known && !c.noise.correlated()) {
    out.log10_p = stats::chi_square_log10_p(out.chi2, out.dof);
  }

  out.table_sd_deg = to_deg(fit->table_sd_rad);
  std::vector<Covariate> all = covariates(fit->problem);
  out.alike = take_out_alike(all);
  out.channels = channels_of(*fit, all);
  out.maps = c.maps;
  out.outliers = fit->outliers;
  out.fits = !c.rejects();
  return out;
}

}  // namespace mgtd::calib::criticism::tests
