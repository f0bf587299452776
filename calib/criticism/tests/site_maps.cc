// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/site_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace mgtd::calib::criticism::tests {
namespace {

constexpr std::array<int, 12> kIndices{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};

/// Field of the site that is linear in its coefficients: `shape` gives the columns at a place, times a
/// function of time.
class SiteShape : public effects::EffectOf<SiteShape> {
 public:
  enum class Kind { uniform, gradient, curvature };
  SiteShape(Kind kind, int cosine, double from_h, double to_h)
      : kind_(kind), cosine_(cosine), from_h_(from_h), to_h_(to_h) {
    const int n = kind == Kind::uniform ? 3 : kind == Kind::gradient ? 5 : 7;
    for (int i = 0; i < n; ++i) coefficients_.push_back({.name = fmt::format("c{}", i), .unit = "nT"});
  }
  [[nodiscard]] std::string_view name() const override { return "site map"; }
  [[nodiscard]] effects::Level level() const override { return effects::Level::site; }
  [[nodiscard]] const std::vector<effects::Coefficient>& coefficients() const override {
    return coefficients_;
  }
  [[nodiscard]] std::span<const int> at(int) const override {
    return std::span(kIndices).first(coefficients_.size());
  }
  [[nodiscard]] std::string_view missing(const Pose& pose) const override {
    return effects::missing_angle(pose);
  }

  template <class S>
  void equation(const effects::Conditions& at, int, std::span<const S> x, std::span<const S> c,
                std::span<S> out) const {
    const double f = cosine_ == 0 ? 1 : time_cosine(2 * (at.t_h - from_h_) / (to_h_ - from_h_) - 1, cosine_);
    if (kind_ == Kind::uniform) {
      for (std::size_t i = 0; i < 3; ++i) out[i] = f * c[i];
    } else if (kind_ == Kind::gradient) {
      out[0] = f * (c[0] * x[0] + c[2] * x[1] + c[3] * x[2]);
      out[1] = f * (c[2] * x[0] + c[1] * x[1] + c[4] * x[2]);
      out[2] = f * (c[3] * x[0] + c[4] * x[1] - (c[0] + c[1]) * x[2]);
    } else {
      curvature(x, c, out);
    }
  }

 private:
  /// Gradients of the seven harmonic polynomials of third degree.
  template <class S>
  static void curvature(std::span<const S> p, std::span<const S> c, std::span<S> out) {
    const S &x = p[0], &y = p[1], &z = p[2];
    const S xx = x * x, yy = y * y, zz = z * z, xy = x * y, xz = x * z, yz = y * z;
    out[0] = 3.0 * c[0] * (xx - yy) + 6.0 * c[1] * xy + 2.0 * c[2] * xz + c[3] * yz +
             c[4] * (4.0 * zz - 3.0 * xx - yy) - 2.0 * c[5] * xy - 6.0 * c[6] * xz;
    out[1] = -6.0 * c[0] * xy + 3.0 * c[1] * (xx - yy) - 2.0 * c[2] * yz + c[3] * xz - 2.0 * c[4] * xy +
             c[5] * (4.0 * zz - xx - 3.0 * yy) - 6.0 * c[6] * yz;
    out[2] = c[2] * (xx - yy) + c[3] * xy + 8.0 * c[4] * xz + 8.0 * c[5] * yz +
             c[6] * (6.0 * zz - 3.0 * xx - 3.0 * yy);
  }

  Kind kind_;
  int cosine_;
  double from_h_, to_h_;
  std::vector<effects::Coefficient> coefficients_;
};

RowSource beside(std::vector<RowSource> parts) {
  RowSource out;
  for (const RowSource& part : parts) out.columns += part.columns;
  out.of = [columns = out.columns, parts = std::move(parts)](std::span<const Eigen::Index> poses) {
    Eigen::MatrixXd rows;
    Eigen::Index at = 0;
    for (const RowSource& part : parts) {
      const Eigen::MatrixXd own = part.of(poses);
      if (at == 0) rows.resize(own.rows(), columns);
      rows.middleCols(at, part.columns) = own;
      at += part.columns;
    }
    return rows;
  };
  return out;
}

}  // namespace

std::vector<SiteRows> site_map_rows(const fit::joint::JointProblem& problem,
                                    const fit::joint::JointState& state) {
  std::vector<SiteRows> out;
  if (!problem.has_angles) return out;
  using Kind = SiteShape::Kind;
  double from_h = problem.poses.front().t_h, to_h = from_h;
  for (const fit::joint::JointPose& pose : problem.poses) {
    from_h = std::min(from_h, pose.t_h);
    to_h = std::max(to_h, pose.t_h);
  }
  const auto rows = [&](Kind kind, int cosine) {
    return effect_source(problem, state, std::make_shared<const SiteShape>(kind, cosine, from_h, to_h));
  };
  if (to_h > from_h) {
    for (const auto& [kind, name] :
         {std::pair{Kind::uniform, "site field"}, {Kind::gradient, "site gradient"}}) {
      std::vector<RowSource> parts;
      for (int j = 1; j <= kCosines; ++j) parts.push_back(rows(kind, j));
      out.push_back({name, beside(std::move(parts))});
    }
  }
  out.push_back({"site map", beside({rows(Kind::gradient, 0), rows(Kind::curvature, 0)})});
  return out;
}

}  // namespace mgtd::calib::criticism::tests
