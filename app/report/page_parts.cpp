#include "app/report/page_parts.h"

#include "app/report/number_text.h"
#include "app/report/svg_plot.h"

namespace rovigo::app {
namespace {

const char* const kPageStyle = R"(
:root{color-scheme:light dark;--page:#fff;--ink:#1f2328;--soft:#59636e;--line:#d9dee3;--card:#f6f8fa;
 --good:#1a7f37;--bad:#b3261e}
@media (prefers-color-scheme:dark){:root{--page:#0d1117;--ink:#e6edf3;--soft:#9da7b1;--line:#30363d;
 --card:#161b22;--good:#3fb950;--bad:#ff7b72}}
*{box-sizing:border-box}
body{margin:0;background:var(--page);color:var(--ink);
 font:16px/1.5 system-ui,"DejaVu Sans",sans-serif}
main{max-width:1160px;margin:0 auto;padding:28px 20px 48px}
h1{font-size:26px;margin:0 0 4px;line-height:1.25}
h2{font-size:18px;margin:34px 0 10px}
.summary{margin:0 0 18px;color:var(--soft)}
.badge{display:inline-block;padding:1px 12px;border-radius:99px;color:#fff;font-size:14px;
 font-weight:600;vertical-align:3px;margin-left:8px}
.badge.good{background:#1a7f37}.badge.bad{background:#b3261e}
.figures{display:grid;grid-template-columns:repeat(auto-fit,minmax(150px,1fr));gap:10px;margin:18px 0}
.figure{background:var(--card);border:1px solid var(--line);border-radius:8px;padding:10px 14px}
.figure b{display:block;font-size:20px;font-weight:600}
.figure span{color:var(--soft);font-size:13.5px}
.map{width:100%;height:auto;border:1px solid var(--line);border-radius:8px;background:#fff;
 display:block}
.plots{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(460px,100%),1fr));gap:14px}
.plots>div{border:1px solid var(--line);border-radius:8px;padding:6px}
.columns{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(460px,100%),1fr));
 gap:0 34px}
table{border-collapse:collapse;width:100%;font-size:15px}
td,th{text-align:left;padding:5px 10px 5px 0;border-bottom:1px solid var(--line);
 font-weight:400}
th{color:var(--soft);font-size:13.5px}
td.n,th.n{text-align:right;font-variant-numeric:tabular-nums;white-space:nowrap}
.pass{color:var(--good);font-weight:600}.fail{color:var(--bad);font-weight:600}
code{background:var(--card);border:1px solid var(--line);border-radius:6px;padding:8px 12px;
 display:block;overflow-x:auto;font:13.5px/1.5 ui-monospace,"DejaVu Sans Mono",monospace}
a{color:inherit}
ul{padding-left:20px;margin:6px 0}
@media print{.plots>div,.map{break-inside:avoid}}
)";

}  // namespace

std::string page_begin(const std::string& title) {
  return "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n<title>" +
         escaped(title) + "</title>\n<style>" + kPageStyle + plot_style() +
         "</style>\n</head>\n<body><main>\n";
}

std::string page_title(const std::string& title, bool good, const std::string& badge) {
  return "<h1>" + escaped(title) + " <span class=\"badge " + (good ? "good" : "bad") + "\">" +
         escaped(badge) + "</span></h1>\n";
}

std::string page_figure(const std::string& name, const std::string& value) {
  return "<div class=\"figure\"><b>" + escaped(value) + "</b><span>" + escaped(name) +
         "</span></div>\n";
}

std::string page_cells(const std::vector<std::string>& cells) {
  std::string out = "<tr>";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    out += (i > 0 ? "<td class=\"n\">" : "<td>") + escaped(cells[i]) + "</td>";
  }
  return out + "</tr>\n";
}

std::string page_heads(const std::vector<std::string>& heads) {
  std::string out = "<tr>";
  for (std::size_t i = 0; i < heads.size(); ++i) {
    out += (i > 0 ? "<th class=\"n\">" : "<th>") + escaped(heads[i]) + "</th>";
  }
  return out + "</tr>\n";
}

}  // namespace rovigo::app
