// SPDX-License-Identifier: Apache-2.0
#include "calib/report/html.h"

#include "calib/report/figures/escaped.h"
#include "calib/report/figures/figure.h"

namespace mgtd::calib::report {
namespace {

constexpr const char* kPageStyle = R"(
:root{color-scheme:light dark;--ink:#1d2329;--quiet:#5a646e;--rule:#d9dee3;--paper:#fff;--shade:#f4f6f8;--good:#17693f;
--bad:#a8380f;--open:#8a6100}
@media screen and (prefers-color-scheme:dark){:root{--ink:#e6eaee;--quiet:#a3adb7;--rule:#39424b;--paper:#14181d;
--shade:#1d232a;--good:#58c48c;--bad:#f58a3c;--open:#e8b93a}}
*{box-sizing:border-box}body{margin:0;color:var(--ink);background:var(--paper);
font:15px/1.5 system-ui,"Segoe UI",Roboto,"Noto Sans","DejaVu Sans",sans-serif}
main,header,footer{margin:0 auto;max-width:1000px;padding:0 24px}header{padding-top:28px}footer{padding-bottom:60px}
h1{font-size:26px;margin:0 0 2px}h2{font-size:19px;margin:38px 0 8px;padding-top:14px;border-top:1px solid var(--rule)}
h3{font-size:15px;margin:18px 0 4px}.quiet,.good{color:var(--quiet)}.good{font-size:13.5px;margin:6px 0 0}
.good b{color:var(--good);font-weight:600}
.banner{margin:18px 0 0;padding:14px 18px;border-left:6px solid var(--open);background:var(--shade);border-radius:4px}
.banner.pass{border-color:var(--good)}.banner.bad{border-color:var(--bad)}
.banner strong{font-size:18px;margin-right:8px}
table{border-collapse:collapse;width:100%;font-size:13.5px;font-variant-numeric:tabular-nums}
th{font-weight:600;text-align:right;color:var(--quiet);border-bottom:1px solid var(--rule);padding:4px 8px;
vertical-align:bottom}
td{text-align:right;padding:4px 8px;border-bottom:1px solid var(--rule);vertical-align:top;overflow-wrap:break-word}
th:first-child,td:first-child,.words td,.words th{text-align:left}
.failed td{color:var(--bad)}.figures+.figures,table+.figures,.good+.figures{margin-top:12px}.wide{overflow-x:auto}
code{font:13px ui-monospace,"DejaVu Sans Mono",monospace;background:var(--shade);padding:1px 4px;border-radius:3px;
overflow-wrap:anywhere}footer{margin-top:40px;font-size:13px;color:var(--quiet)}
@page{size:A4;margin:16mm 14mm}
@media print{:root{color-scheme:light}body{font-size:12px}main,header,footer{max-width:none;padding:0}
h2,h3{break-after:avoid}tr,.banner{break-inside:avoid}thead{display:table-header-group}
table{font-size:10.5px}td,th{padding:2px 5px}p{orphans:3;widows:3}}
)";

}  // namespace

std::string html_style() { return kPageStyle + figures::figure_style(); }

std::string html_table(const std::vector<std::string>& head, const Rows& rows, bool words,
                       const std::set<std::size_t>& failed) {
  if (rows.empty()) return "";
  return figures::table_html({.head = head, .rows = rows, .note = {}}, words, failed);
}

std::string html_good(const std::string& text) {
  return "<p class=\"good\"><b>What good looks like:</b> " + figures::escaped(text) + "</p>";
}

}  // namespace mgtd::calib::report
