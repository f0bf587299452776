// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <deque>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "tests/scenario/virtual_daemon.h"

/// Holds a stream against the rig's truth: its numbers tile, its times rise, and what is wrong in it is
/// flagged.
namespace mgtd::test {

inline constexpr double kSamplePeriod_s = 0.02;

/// What the sensors ought to have read, remembered for as long as an epoch may be late.
class Truth {
 public:
  void remember(VirtualDaemon& daemon) {
    Moment now{daemon.t_s, {}};
    for (int i = 0; i < kSensors; ++i)
      now.y_nT[static_cast<std::size_t>(i)] = daemon.rig.world().quiet_reading(i, daemon.t_s);
    past_.push_back(now);
    while (past_.front().t_s < daemon.t_s - 30) past_.pop_front();
  }
  /// By how much an epoch leaves the range that the sensors ought to have read within window_s around t, and
  /// how far a straight line between two samples may lead away from it there. Empty where t is not known.
  struct Judged {
    double beyond_nT{0}, bend_nT{0};
  };
  [[nodiscard]] std::optional<Judged> judge(const Epoch& epoch, double t_s, double window_s) const {
    const double from_s = t_s - window_s - 2 * kSamplePeriod_s, to_s = t_s + window_s + 2 * kSamplePeriod_s;
    if (past_.empty() || past_.front().t_s > t_s - 2 * kSamplePeriod_s || past_.back().t_s < t_s)
      return std::nullopt;
    Judged out;
    for (std::size_t i = 0; i < kSensors; ++i) {
      Eigen::Vector3d low = (*at(t_s))[i], high = low;
      for (const double end_s : {t_s - window_s, t_s + window_s}) {
        const auto there = at(end_s);
        if (!there) continue;
        low = low.cwiseMin((*there)[i]);
        high = high.cwiseMax((*there)[i]);
      }
      const auto begin = std::lower_bound(past_.begin(), past_.end(), from_s, earlier);
      const auto end = std::lower_bound(past_.begin(), past_.end(), to_s, earlier);
      constexpr std::ptrdiff_t kApart = 4;  // steps in a sample's period
      for (auto m = begin; m != end; ++m) {
        if (std::abs(m->t_s - t_s) <= window_s) {
          low = low.cwiseMin(m->y_nT[i]);
          high = high.cwiseMax(m->y_nT[i]);
        }
        if (m - begin < kApart || end - m <= kApart) continue;
        const Eigen::Vector3d bend = (m - kApart)->y_nT[i] - 2 * m->y_nT[i] + (m + kApart)->y_nT[i];
        out.bend_nT = std::max(out.bend_nT, bend.cwiseAbs().maxCoeff() / 2);
      }
      const Eigen::Vector3d beyond = (low - epoch.y_nT[i]).cwiseMax(epoch.y_nT[i] - high);
      out.beyond_nT = std::max(out.beyond_nT, beyond.maxCoeff());
    }
    return out;
  }

 private:
  using Readings = PerSensor<Eigen::Vector3d>;
  struct Moment {
    double t_s;
    Readings y_nT;
  };
  static bool earlier(const Moment& m, double t_s) { return m.t_s < t_s; }
  [[nodiscard]] std::optional<Readings> at(double t_s) const {
    const auto after = std::lower_bound(past_.begin(), past_.end(), t_s, earlier);
    if (after == past_.begin() || after == past_.end()) return std::nullopt;
    const Moment &a = *std::prev(after), &b = *after;
    const double u = (t_s - a.t_s) / (b.t_s - a.t_s);
    Readings out;
    for (std::size_t i = 0; i < kSensors; ++i) out[i] = (1 - u) * a.y_nT[i] + u * b.y_nT[i];
    return out;
  }
  std::deque<Moment> past_;
};

class StreamJudge {
 public:
  void watch(VirtualDaemon& daemon) {
    daemon.on_item = [this, &daemon](const EpochOrGap& item) {
      if (const auto* gap = std::get_if<Gap>(&item)) {
        EXPECT_EQ(gap->from_seq, next_seq_);
        EXPECT_FALSE(gap->why.empty());
        next_seq_ = gap->to_seq + 1;
        why_gaps.push_back(gap->why);
      } else {
        take(daemon, std::get<Epoch>(item));
      }
    };
    daemon.on_step = [this, &daemon] {
      truth_.remember(daemon);
      for (; !waiting_.empty() && waiting_.front().t_s < daemon.t_s - 3 * kSamplePeriod_s;
           waiting_.pop_front())
        judge(waiting_.front().epoch, waiting_.front().t_s);
    };
  }
  /// A rate that changes at once does not show before its samples are later than delivery may be: until then
  /// an epoch may lie beyond its bound and say nothing. It is counted all the same.
  void forgive(double from_s, double to_s) { forgiven_.emplace_back(from_s, to_s); }
  void restarted() {
    next_seq_ = 0;
    last_.reset();
    waiting_.clear();
  }

  /// An epoch that is further off than its bound has said so when it is flagged clock_unsettled. Counted.
  bool unsettled_is_said{false};
  std::uint64_t judged{0}, flagged{0};
  std::uint64_t uncertain{0};  ///< whose bound is more than half a period
  std::uint64_t beyond{0};     ///< further from the truth than their bound says
  Flags seen;                  ///< all that any epoch had
  std::vector<std::string> why_gaps{};

 private:
  struct Waiting {
    Epoch epoch;
    double t_s;  ///< on the rig's clock
  };

  void take(const VirtualDaemon& daemon, const Epoch& epoch) {
    EXPECT_EQ(epoch.seq, next_seq_);
    next_seq_ = epoch.seq + 1;
    EXPECT_TRUE(!last_ || epoch.t.mono > *last_);
    last_ = epoch.t.mono;
    seen |= epoch.flags;
    waiting_.push_back({epoch, to_seconds(epoch.t.mono - daemon.now().mono) + daemon.t_s});
  }
  void judge(const Epoch& epoch, double t_s) {
    // The epoch's time and each of its samples are right to within the bound that it states. Bytes are handed
    // over here in steps: a delay of up to one that no clock model can know, whose edges bend the model.
    const auto found = truth_.judge(epoch, t_s, 2 * epoch.skew_bound_s + 1.5 * kStep_s);
    if (!found) return;
    ++judged;
    if (epoch.flags.has(Flag::saturated) || epoch.flags.has(Flag::frozen) ||
        epoch.flags.has(Flag::identity)) {
      ++flagged;
      return;
    }
    uncertain += epoch.skew_bound_s > kSamplePeriod_s / 2;
    const double most_nT = 2 + found->bend_nT;  // noise 0.3 nT, six of it
    beyond += found->beyond_nT >= most_nT;
    const bool forgiven = (unsettled_is_said && epoch.flags.has(Flag::clock_unsettled)) ||
                          std::any_of(forgiven_.begin(), forgiven_.end(),
                                      [&](const auto& f) { return f.first <= t_s && t_s <= f.second; });
    EXPECT_TRUE(forgiven || found->beyond_nT < most_nT) << fmt::format(
        "epoch {} at {:.3f} s is off by {:.1f} nT where {:.1f} may be, skew bound {:.6f} s, flags {}",
        epoch.seq, t_s, found->beyond_nT, most_nT, epoch.skew_bound_s, fmt::join(names(epoch.flags), " "));
  }

  Truth truth_;
  std::vector<std::pair<double, double>> forgiven_;
  std::deque<Waiting> waiting_;  ///< for what the sensors read after them
  std::uint64_t next_seq_{0};
  std::optional<Instant> last_;
};

}  // namespace mgtd::test
