// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <set>
#include <string>
#include <vector>

/// A Figure is a picture with everything that must stand beside it: what it shows, what a good one looks like
/// with the numbers of this run in it, and the table of its data for those who do not see it or want the
/// numbers.
namespace mgtd::calib::report::figures {

struct DataTable {
  std::vector<std::string> head{};
  std::vector<std::vector<std::string>> rows{};
  std::string note{};  ///< what a row is, where that is not plain
};

struct Figure {
  std::string name{};  ///< "waterfall": ids begin with it, and a file is called like it
  std::string title{};
  std::string svg{};
  std::string caption{};  ///< what is drawn
  std::string good{};     ///< what a good one looks like, with the number of this run
  DataTable data{};
  bool wide{false};        ///< takes the whole width of a page
  bool stands_out{false};  ///< this one is not what a good one looks like
};

/// The figure with its title, its captions and its table, folded away, as an element of a page. Without
/// values there is no picture, and the caption says why.
[[nodiscard]] std::string figure_html(const Figure& figure);

/// A table by itself. The first column is text, the others are numbers unless `words`. Rows in `failed` have
/// that class.
[[nodiscard]] std::string table_html(const DataTable& table, bool words = false,
                                     const std::set<std::size_t>& failed = {});

/// Style of figures on a page, light, dark and printed, as CSS; it uses no variable of the page.
[[nodiscard]] std::string figure_style();

}  // namespace mgtd::calib::report::figures
