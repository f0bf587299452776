// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/formula_values.h"

#include "calib/linear/parts.h"

namespace mgtd::calib::discovery {
namespace {

/// Writes the values of the columns of one member; zeros where they have none.
Result<void> write_values(const Columns& columns, int channel, LawInputs& inputs,
                          Eigen::Ref<Eigen::MatrixXd> out) {
  for (std::size_t j = 0; j < columns.size(); ++j) {
    const auto values = inputs(columns[j], channel);
    if (!values) return tl::unexpected(values.error());
    if (values->size() == 0) {
      out.col(static_cast<Eigen::Index>(j)).setZero();
    } else {
      out.col(static_cast<Eigen::Index>(j)) = *values;
    }
  }
  return {};
}

}  // namespace

Result<FormulaValues> FormulaValues::of(const Grammar& grammar, LawInputs& inputs) {
  FormulaValues out(grammar);
  Eigen::Index columns = 0;
  for (std::size_t f = 0; f < grammar.families.size(); ++f) {
    const Family& family = grammar.families[f];
    for (std::size_t i = 0; i < family.inner.size(); ++i) {
      const auto count = static_cast<Eigen::Index>(family.columns(family.inner[i]).size());
      out.members_.push_back({f, i, columns, count});
      columns += count;
    }
  }
  out.columns_.assign(static_cast<std::size_t>(inputs.channels()), Eigen::MatrixXd(inputs.poses(), columns));
  std::vector<Result<void>> written(out.columns_.size());
  linear::for_each_part(written.size(), [&](std::size_t c) {
    for (const Member& m : out.members_) {
      const Family& family = grammar.families[m.family];
      if (c > 0 && family.common) continue;
      written[c] = write_values(family.columns(family.inner[m.inner]), static_cast<int>(c), inputs,
                                out.columns_[c].middleCols(m.first, m.count));
      if (!written[c]) return;
    }
  });
  for (std::size_t c = 0; c < written.size(); ++c) {
    if (!written[c]) return tl::unexpected(written[c].error());
    for (const Member& m : out.members_)
      if (c > 0 && grammar.families[m.family].common)
        out.columns_[c].middleCols(m.first, m.count) = out.columns_.front().middleCols(m.first, m.count);
  }
  return out;
}

FormulaValues FormulaValues::at(const std::vector<std::size_t>& poses) const {
  FormulaValues out(*grammar_);
  out.members_ = members_;
  for (const Eigen::MatrixXd& all : columns_) {
    Eigen::MatrixXd some(static_cast<Eigen::Index>(poses.size()), all.cols());
    for (std::size_t i = 0; i < poses.size(); ++i)
      some.row(static_cast<Eigen::Index>(i)) = all.row(static_cast<Eigen::Index>(poses[i]));
    out.columns_.push_back(std::move(some));
  }
  return out;
}

bool FormulaValues::asked(const Family& family, const Place& place) const {
  switch (place.kind) {
    case Place::Kind::axis:
      return family.foreign_sensor != place.at / 3 && family.foreign_axis != place.at % 3;
    case Place::Kind::sensor:
      return family.foreign_sensor != place.at;
    case Place::Kind::array:
      return family.whole_array;
    case Place::Kind::gradient:
      return family.of_site && family.common && family.foreign_sensor < 0;
  }
  return false;
}

}  // namespace mgtd::calib::discovery
