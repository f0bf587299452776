// SPDX-License-Identifier: Apache-2.0
#include "calib/report/figures/figure.h"

#include <fmt/format.h>

#include <algorithm>

#include "calib/report/figures/drawing.h"
#include "calib/report/figures/escaped.h"

namespace mgtd::calib::report::figures {
namespace {

constexpr const char* kFigureStyle = R"(
figure{margin:0;padding:10px 12px;border:1px solid #d9dee3;border-radius:6px;min-width:0}
figure.out{border-color:#d55e00}figure svg{display:block;width:100%;height:auto}
figure h3{margin:0 0 4px;font-size:14px}figcaption{font-size:13px;line-height:1.45}
figcaption .good{margin:4px 0 0}figcaption p{margin:4px 0 0}
details{font-size:12.5px;margin-top:6px}summary{cursor:pointer;padding:2px 0}
details .scroll{max-height:320px;overflow:auto}
.figures{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(400px,100%),1fr));gap:12px}
.figures .wide{grid-column:1/-1}
@media screen and (prefers-color-scheme:dark){figure{border-color:#39424b}figure.out{border-color:#f58a3c}}
@media print{details{display:none}figure{break-inside:avoid}figcaption{font-size:11px}.figures{grid-template-columns:1fr 1fr}
svg{print-color-adjust:exact;-webkit-print-color-adjust:exact}}
)";

}  // namespace

std::string table_html(const DataTable& table, bool words, const std::set<std::size_t>& failed) {
  std::string out = words ? "<table class=\"words\">" : "<table>";
  if (std::any_of(table.head.begin(), table.head.end(), [](const auto& h) { return !h.empty(); })) {
    out += "<thead><tr>";
    for (const std::string& cell : table.head) {
      // A column without a name has no heading.
      out += cell.empty() ? "<td></td>" : "<th scope=\"col\">" + escaped(cell) + "</th>";
    }
    out += "</tr></thead>";
  }
  out += "<tbody>";
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    out += failed.contains(i) ? "<tr class=\"failed\">" : "<tr>";
    for (const std::string& cell : table.rows[i]) out += "<td>" + escaped(cell) + "</td>";
    out += "</tr>";
  }
  return out + "</tbody></table>";
}

std::string figure_html(const Figure& f) {
  std::string classes = f.wide ? "wide" : "";
  if (f.stands_out) classes += classes.empty() ? "out" : " out";
  std::string out = fmt::format("<figure id=\"{}\"{}><h3>{}</h3>{}<figcaption><p>{}</p>", escaped(f.name),
                                classes.empty() ? "" : fmt::format(" class=\"{}\"", classes),
                                escaped(f.title), f.svg, escaped(f.caption));
  if (!f.good.empty()) out += "<p class=\"good\"><b>Good:</b> " + escaped(f.good) + "</p>";
  out += "</figcaption>";
  if (!f.data.rows.empty()) {
    out += fmt::format("<details><summary>Data of “{}”</summary>", escaped(f.title));
    if (!f.data.note.empty()) out += "<p>" + escaped(f.data.note) + "</p>";
    out += fmt::format("<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"{}, data\">",
                       escaped(f.title)) +
           table_html(f.data) + "</div></details>";
  }
  return out + "</figure>\n";
}

std::string figure_style() { return kFigureStyle + drawing_style(); }

}  // namespace mgtd::calib::report::figures
