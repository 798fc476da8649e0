// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/report_page.h"

#include <fmt/format.h>

#include "eyeslam/files/markup.h"

namespace eyeslam::trials {

using files::escaped;

namespace {

constexpr const char* kStyle = R"css(
:root { color-scheme: light; }
body { margin: 0; background: #fff; color: #1b1b1b; line-height: 1.5; font-size: 15px;
  font-family: "Helvetica Neue", Helvetica, Arial, "Liberation Sans", "Segoe UI", Roboto, sans-serif; }
main { max-width: 1080px; margin: 0 auto; padding: 28px 24px 64px; }
h1 { font-size: 26px; line-height: 1.25; margin: 0 0 2px; font-weight: 650; overflow-wrap: anywhere; }
h2 { font-size: 19px; margin: 40px 0 10px; padding-top: 14px; border-top: 1px solid #d5d5d5; font-weight: 650;
  overflow-wrap: anywhere; }
p { margin: 8px 0; max-width: 82ch; }
.subtitle { color: #555; margin: 0 0 18px; overflow-wrap: anywhere; }
.warnings { border: 1px solid #c62828; border-left: 6px solid #c62828; background: #fdf1f0; padding: 10px 16px;
  margin: 16px 0; border-radius: 3px; overflow-wrap: anywhere; }
.warnings strong { color: #a31515; }
.warnings ul { margin: 6px 0 0; padding-left: 20px; }
.note { border-left: 4px solid #b58900; background: #fdf9ec; padding: 8px 14px; margin: 12px 0; max-width: none;
  font-size: 14px; }
.headlines { display: grid; grid-template-columns: repeat(auto-fit, minmax(150px, 1fr)); gap: 12px; margin: 18px 0; }
.headlines div { border: 1px solid #dcdcdc; border-radius: 4px; padding: 10px 14px; }
.headlines b { display: block; font-size: 24px; font-weight: 600; line-height: 1.2; white-space: nowrap; }
.headlines b small { font-size: 14px; font-weight: 400; color: #555; }
.headlines span { color: #555; font-size: 13px; }
figure { margin: 22px 0; break-inside: avoid; }
figure svg { display: block; max-width: 100%; height: auto; font-family: inherit; overflow: visible; }
figure svg svg { overflow: hidden; }
figcaption, .caption { font-size: 13.5px; color: #333; max-width: 120ch; }
figcaption { margin-top: 8px; }
.caption { margin: 0 0 6px; }
.wide { overflow-x: auto; margin: 18px 0; break-inside: avoid; }
table { border-collapse: collapse; font-size: 13.5px; font-variant-numeric: tabular-nums; }
th, td { padding: 4px 12px 4px 0; text-align: right; white-space: nowrap; }
th.words, td.words { text-align: left; }
td.words + td.words { white-space: normal; }
th { font-weight: 600; border-bottom: 1px solid #333; border-top: 1px solid #333; vertical-align: bottom; }
td { border-bottom: 1px solid #ececec; }
tbody tr:last-child td { border-bottom: 1px solid #333; }
details { margin: 12px 0; }
summary { cursor: pointer; font-weight: 600; }
pre { font: 12.5px/1.45 "DejaVu Sans Mono", Menlo, Consolas, monospace; background: #f7f7f7; padding: 12px;
  overflow-x: auto; border-radius: 3px; }
@media print { main { max-width: none; padding: 0; } body { font-size: 10.5pt; } .wide { overflow: visible; }
  table { font-size: 8.5pt; } th, td { padding-right: 7px; } }
)css";

std::string rowOf(const std::vector<std::string>& cells, std::size_t words, const std::string& element)
{
  std::string row = "<tr>";
  for (std::size_t i = 0; i < cells.size(); ++i)
    row += fmt::format("<{0}{1}>{2}</{0}>", element, i < words ? " class=\"words\"" : "", escaped(cells[i]));
  return row + "</tr>\n";
}

std::string written(const ReportTable& table, const std::string& caption)
{
  std::string html = "<div class=\"wide\">";
  if (!caption.empty()) html += fmt::format("<p class=\"caption\">{}</p>\n", caption);
  html += "<table>\n<thead>" + rowOf(table.names, table.words, "th") + "</thead>\n<tbody>\n";
  for (const std::vector<std::string>& row : table.rows) html += rowOf(row, table.words, "td");
  return html + "</tbody></table></div>\n";
}

}  // namespace

ReportPage::ReportPage(const std::string& title, const std::string& subtitle) : title_(escaped(title))
{
  body_ = fmt::format("<h1>{}</h1>\n<p class=\"subtitle\">{}</p>\n", title_, escaped(subtitle));
}

void ReportPage::warnings(const std::vector<std::string>& warnings)
{
  if (warnings.empty()) return;
  body_ += fmt::format("<div class=\"warnings\"><strong>{} warning{}</strong>\n<ul>\n", warnings.size(),
                       warnings.size() == 1 ? "" : "s");
  for (const std::string& warning : warnings) body_ += fmt::format("<li>{}</li>\n", escaped(warning));
  body_ += "</ul></div>\n";
}

void ReportPage::headlines(const std::vector<Headline>& headlines)
{
  if (headlines.empty()) return;
  body_ += "<div class=\"headlines\">\n";
  for (const Headline& headline : headlines)
    body_ += fmt::format("<div><b>{} <small>{}</small></b><span>{}</span></div>\n", escaped(headline.value),
                         escaped(headline.unit), escaped(headline.name));
  body_ += "</div>\n";
}

void ReportPage::section(const std::string& title) { body_ += fmt::format("<h2>{}</h2>\n", escaped(title)); }
void ReportPage::paragraph(const std::string& text) { body_ += fmt::format("<p>{}</p>\n", escaped(text)); }
void ReportPage::note(const std::string& text) { body_ += fmt::format("<p class=\"note\">{}</p>\n", escaped(text)); }

void ReportPage::figure(const std::string& svg, const std::string& caption)
{
  if (svg.empty()) return;
  body_ += fmt::format("<figure>\n{}<figcaption><b>Figure {}.</b> {}</figcaption>\n</figure>\n", svg, ++figures_,
                       escaped(caption));
}

void ReportPage::table(const ReportTable& table, const std::string& caption)
{
  if (table.rows.empty()) return;
  body_ += written(table, fmt::format("<b>Table {}.</b> {}", ++tables_, escaped(caption)));
}

void ReportPage::folded(const std::string& summary, const std::string& text)
{
  body_ += fmt::format("<details><summary>{}</summary><pre>{}</pre></details>\n", escaped(summary), escaped(text));
}

void ReportPage::foldedTable(const std::string& summary, const ReportTable& table)
{
  if (table.rows.empty()) return;
  body_ += fmt::format("<details><summary>{}</summary>\n{}</details>\n", escaped(summary), written(table, {}));
}

std::string ReportPage::html() const
{
  return fmt::format(
             "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
             "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n<title>{}</title>\n<style>{}"
             "</style>\n</head>\n<body>\n<main>\n",
             title_, kStyle) +
         body_ + "</main>\n</body>\n</html>\n";
}

}  // namespace eyeslam::trials
