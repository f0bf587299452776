// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/grammar_writer.h"

#include "calib/discovery/formula_parts.h"

namespace mgtd::calib::discovery {
namespace {

/// Of one sensor or of all, as the scalar is.
Family& bound(Family& family, const Scalar& s) {
  family.foreign_sensor = s.foreign_sensor;
  family.common = s.common;
  return family;
}

}  // namespace

Family& GrammarWriter::add(Family family) {
  out_.families.push_back(std::move(family));
  return out_.families.back();
}

Family& GrammarWriter::add(std::vector<std::string> covariates, int symbols, const Columns& columns) {
  return add({.covariates = std::move(covariates), .symbols = symbols, .columns = [columns](double) {
                return columns;
              }});
}

Family& GrammarWriter::on(const Scalar& s, int more_symbols, const Columns& columns) {
  return bound(add({s.covariate}, s.symbols + more_symbols, columns), s);
}

Family& GrammarWriter::on(const Scalar& s, int more_symbols, std::vector<double> inner, std::string unit,
                          std::function<Columns(double)> columns) {
  return bound(add({.covariates = {s.covariate},
                    .symbols = s.symbols + more_symbols,
                    .inner = std::move(inner),
                    .inner_unit = std::move(unit),
                    .columns = std::move(columns),
                    .refined = true}),
               s);
}

Family& GrammarWriter::of_reading(const std::string& name, int symbols, const Columns& columns) {
  return reads(add({name}, symbols, columns), name);
}

Family& GrammarWriter::of_reading(const std::string& name, int symbols, std::vector<double> inner,
                                  std::function<Columns(double)> columns) {
  return reads(add({.covariates = {name},
                    .symbols = symbols,
                    .inner = std::move(inner),
                    .columns = std::move(columns),
                    .refined = true}),
               name);
}

Family& GrammarWriter::of_readings(std::vector<std::string> names, int symbols, const Columns& columns) {
  Family& family = add(std::move(names), symbols, columns);
  family.common = false;
  return family;
}

Family& GrammarWriter::reads(Family& family, const std::string& name) {
  family.common = false;
  for (int axis = 0; axis < 3; ++axis)
    if (name == kAxes[static_cast<std::size_t>(axis)] ||
        name == "prev_" + kAxes[static_cast<std::size_t>(axis)])
      family.foreign_axis = axis;
  return family;
}

}  // namespace mgtd::calib::discovery
