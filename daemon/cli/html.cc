// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/html.h"

#include "daemon/cli/svg.h"

namespace mgtd::daemon::cli {

const char* const kHtmlStyle = R"(
:root{color-scheme:light;--ink:#1d2329;--quiet:#66707a;--rule:#d9dee3;--good:#1b7f4b;--bad:#b3401a;--open:#8a6100}
*{box-sizing:border-box}body{margin:0 auto;max-width:980px;padding:28px 24px 60px;color:var(--ink);background:#fff;
font:15px/1.5 system-ui,"Segoe UI",Roboto,"Noto Sans",sans-serif}
h1{font-size:26px;margin:0 0 2px}h2{font-size:19px;margin:38px 0 8px;padding-top:14px;border-top:1px solid var(--rule)}
h3{font-size:15px;margin:18px 0 4px}.quiet,.good{color:var(--quiet)}.good{font-size:13.5px;margin:6px 0 0}
.good b{color:var(--good);font-weight:600}
.banner{margin:18px 0 0;padding:14px 18px;border-left:6px solid var(--open);background:#faf7ef;border-radius:4px}
.banner.pass{border-color:var(--good);background:#f0f8f3}.banner.bad{border-color:var(--bad);background:#fbf1ed}
.banner strong{font-size:18px;margin-right:8px}
table{border-collapse:collapse;width:100%;font-size:13.5px;font-variant-numeric:tabular-nums}
th{font-weight:600;text-align:right;color:var(--quiet);border-bottom:1px solid var(--rule);padding:4px 8px}
td{text-align:right;padding:4px 8px;border-bottom:1px solid #eef1f3;vertical-align:top}
th:first-child,td:first-child,.words td,.words th{text-align:left}
tr.now td{font-weight:600}.failed td{color:var(--bad)}
.plots{display:grid;grid-template-columns:repeat(auto-fill,minmax(145px,1fr));gap:8px}
figure{margin:0;padding:6px 8px;border:1px solid var(--rule);border-radius:5px}figure.out{border-color:#d55e00}
figcaption{font-size:12px;color:var(--quiet)}svg{display:block;width:100%;height:auto}
svg text{font:11px system-ui,"Noto Sans",sans-serif;fill:#39424b}svg.bars text{font-size:13px}
svg .zero{stroke:#c3c9cf;stroke-width:1}svg .mark{stroke:#39424b;stroke-dasharray:4 3}svg text.quiet{fill:#66707a}
code{font:13px ui-monospace,"DejaVu Sans Mono",monospace;background:#f4f6f8;padding:1px 4px;border-radius:3px;
overflow-wrap:anywhere}footer{margin-top:40px;font-size:13px;color:var(--quiet)}
@media print{body{max-width:none;padding:0}h2{break-after:avoid}figure{break-inside:avoid}}
)";

std::string html_table(const std::vector<std::string>& head, const Rows& rows, bool words,
                       const std::set<std::size_t>& failed) {
  std::string out = words ? "<table class=\"words\"><tr>" : "<table><tr>";
  for (const std::string& cell : head) out += "<th>" + escaped(cell) + "</th>";
  out += "</tr>";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    out += failed.contains(i) ? "<tr class=\"failed\">" : "<tr>";
    for (const std::string& cell : rows[i]) out += "<td>" + escaped(cell) + "</td>";
    out += "</tr>";
  }
  return out + "</table>";
}

std::string html_good(const std::string& text) {
  return "<p class=\"good\"><b>What good looks like:</b> " + text + "</p>";
}

}  // namespace mgtd::daemon::cli
