// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/grammar.h"

#include "calib/discovery/gain_families.h"
#include "calib/discovery/grammar_writer.h"
#include "calib/discovery/neighbour_families.h"
#include "calib/discovery/product_families.h"
#include "calib/discovery/reading_families.h"
#include "calib/discovery/scalar_families.h"
#include "proto/sha256.h"

namespace mgtd::calib::discovery {

std::size_t Grammar::members() const {
  std::size_t out = 0;
  for (const Family& family : families) out += family.inner.size();
  return out;
}

std::string Grammar::hash() const {
  std::string all;
  for (const Family& family : families)
    for (const double inner : family.inner)
      for (const std::string& column : family.columns(inner)) all += column + ";";
  return sha256_hex(all).substr(0, 8);
}

/// The hash depends on the order.
Grammar grammar(const LawInputs& inputs) {
  GrammarWriter out(inputs);
  write_scalar_families(out);
  write_reading_families(out);
  write_product_families(out);
  write_gain_families(out);
  write_neighbour_families(out);
  return out.take();
}

}  // namespace mgtd::calib::discovery
