// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/formula_values.h"

namespace mgtd::calib::discovery {
namespace {

/// Values of the columns of one member; zeros where they have none.
Result<Eigen::MatrixXd> values_of(const Columns& columns, int channel, LawInputs& inputs) {
  Eigen::MatrixXd out(inputs.poses(), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t j = 0; j < columns.size(); ++j) {
    const auto values = inputs(columns[j], channel);
    if (!values) return tl::unexpected(values.error());
    if (values->size() == 0) {
      out.col(static_cast<Eigen::Index>(j)).setZero();
    } else {
      out.col(static_cast<Eigen::Index>(j)) = *values;
    }
  }
  return out;
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
  for (int c = 0; c < inputs.channels(); ++c) {
    Eigen::MatrixXd all(inputs.poses(), columns);
    for (const Member& m : out.members_) {
      const Family& family = grammar.families[m.family];
      if (c > 0 && family.common) {
        all.middleCols(m.first, m.count) = out.columns_.front().middleCols(m.first, m.count);
        continue;
      }
      const auto values = values_of(family.columns(family.inner[m.inner]), c, inputs);
      if (!values) return tl::unexpected(values.error());
      all.middleCols(m.first, m.count) = *values;
    }
    out.columns_.push_back(std::move(all));
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
