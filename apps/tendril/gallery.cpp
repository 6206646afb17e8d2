#include "gallery.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tendril/drawing/text.hpp"
#include "tendril/version.hpp"

namespace tendril::app {
namespace {

constexpr const char* kStyle = R"(
:root { color-scheme: light; }
* { box-sizing: border-box; }
body { margin: 0; background: #f5f6f8; color: #1d2430; font: 16px/1.55 Georgia, 'Times New Roman', 'Liberation Serif', serif; }
header, main, footer { max-width: 1120px; margin: 0 auto; padding: 0 28px; }
header { padding-top: 44px; }
h1 { font-size: 34px; line-height: 1.2; margin: 0 0 8px; }
h2 { font-size: 25px; line-height: 1.25; margin: 0; }
h3 { font: 600 13px/1.4 Helvetica, Arial, 'Liberation Sans', sans-serif; margin: 26px 0 8px; color: #4a5568; }
.lead { font-size: 18px; color: #4a5568; margin: 0 0 24px; }
section { background: #fff; border: 1px solid #dde1e8; border-radius: 6px; padding: 26px 30px 24px; margin: 26px 0; }
.where { font: 14px/1.4 Helvetica, Arial, 'Liberation Sans', sans-serif; color: #5b6675; margin: 4px 0 12px; }
.verdict { font: 600 13px/1 Helvetica, Arial, 'Liberation Sans', sans-serif; padding: 5px 9px; border-radius: 4px; white-space: nowrap; }
.good { background: #dff0ea; color: #00553f; }
.bad { background: #fbe3d6; color: #8c3500; }
.top { display: flex; flex-wrap: wrap; gap: 8px 18px; align-items: baseline; justify-content: space-between; }
table { border-collapse: collapse; width: 100%; font: 13px/1.4 Helvetica, Arial, 'Liberation Sans', sans-serif; }
sub, sup { font-size: 75%; line-height: 0; }
th, td { text-align: left; padding: 5px 10px 5px 0; border-bottom: 1px solid #e8ebf0; vertical-align: top; }
th { color: #4a5568; border-bottom: 1.5px solid #9aa5b4; }
.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
tr.fails td { background: #fbe3d6; }
.scroll { overflow-x: auto; }
figure { margin: 22px 0 6px; }
figure svg { display: block; max-width: 100%; height: auto; margin: 0 auto; }
figcaption { color: #3b4554; font-size: 15px; max-width: 820px; margin: 6px auto 0; }
ul { margin: 0; padding-left: 20px; }
a { color: #00598c; }
footer { padding: 8px 28px 44px; font-size: 14px; color: #5b6675; }
@media print {
  body { background: #fff; font-size: 10.5pt; }
  header, main, footer { max-width: none; padding: 0; }
  section { border: 0; padding: 0; margin: 0 0 14pt; }
  section + section { break-before: page; }
  figure, tr { break-inside: avoid; }
  h2, h3 { break-after: avoid; }
  .good, .bad { border: 1px solid; }
  .scroll { overflow: visible; }
}
)";

// Names and texts, escaped; texts with their subscripts and superscripts set.
std::string escaped(std::string_view text) { return drawing::escape_xml(text); }
std::string typeset(std::string_view text) { return drawing::text_html(text); }

std::string chip(const Computed& c) {
  return fmt::format("<span class=\"verdict {}\">{}</span>", holds(c) ? "good" : "bad", escaped(verdict(c)));
}

std::string table(const reproduce::Outcome& outcome) {
  if (outcome.rows.empty()) return "";
  std::string out =
      "<h3>Computed against expected</h3>\n<div class=\"scroll\"><table>\n<thead><tr><th>quantity</th><th "
      "class=\"n\">computed"
      "</th><th class=\"n\">expected</th><th class=\"n\">difference</th><th "
      "class=\"n\">tolerance</th><th>source</th></tr>"
      "</thead>\n<tbody>\n";
  for (const reproduce::Row& row : outcome.rows) {
    out += fmt::format(
        "<tr{}><td>{}</td><td class=\"n\">{:.10g}</td><td class=\"n\">{:.10g}</td><td class=\"n\">{:.1e}</td><td "
        "class=\"n\">{:.1e}</td><td>{}</td></tr>\n",
        holds(row) ? "" : " class=\"fails\"", typeset(row.quantity), row.computed, row.expected,
        row.computed - row.expected, row.tolerance, typeset(row.source));
  }
  return out + "</tbody></table></div>\n";
}

std::string section(const Computed& c, const std::string& files) {
  const reproduce::System& system = *c.system;
  std::string out = fmt::format(
      "<section id=\"{}\">\n<div class=\"top\"><h2>{}</h2>{}</div>\n<p class=\"where\">Thesis {}; <code>tendril "
      "reproduce "
      "{}</code></p>\n<p>{}</p>\n",
      escaped(system.name), typeset(system.title), chip(c), typeset(system.section), escaped(system.name),
      typeset(system.summary));
  for (const reproduce::Picture& picture : c.outcome.pictures) {
    out += fmt::format("<figure>\n{}<figcaption>{}</figcaption>\n</figure>\n", drawing::render_svg(picture.figure),
                       typeset(picture.caption));
  }
  out += table(c.outcome);
  if (!c.outcome.notes.empty()) {
    out += "<h3>Notes</h3>\n<ul>\n";
    for (const std::string& note : c.outcome.notes) out += "<li>" + typeset(note) + "</li>\n";
    out += "</ul>\n";
  }
  if (c.finished) {
    out += "<h3>Files</h3>\n<p class=\"where\">";
    const auto link = [&](const std::string& name) {
      return fmt::format("<a href=\"{0}{1}\">{1}</a> ", escaped(files), escaped(name));
    };
    for (const reproduce::Data& data : c.outcome.data) out += link(data.name + ".csv");
    for (const reproduce::Picture& picture : c.outcome.pictures) out += link(picture.name + ".svg");
    out += link("table.csv") + "</p>\n";
  }
  return out + "</section>\n";
}

}  // namespace

bool holds(const reproduce::Row& row) { return std::abs(row.computed - row.expected) <= row.tolerance; }

bool holds(const Computed& computed) {
  const auto& rows = computed.outcome.rows;
  return computed.finished && !rows.empty() &&
         std::all_of(rows.begin(), rows.end(), [](const reproduce::Row& row) { return holds(row); });
}

double worst_share(const Computed& computed) {
  double worst = 0.0;
  for (const reproduce::Row& row : computed.outcome.rows) {
    const double difference = std::abs(row.computed - row.expected);
    const double share = row.tolerance > 0 ? difference / row.tolerance : difference == 0 ? 0.0 : INFINITY;
    worst = std::isnan(share) ? INFINITY : std::max(worst, share);
  }
  return worst;
}

std::string verdict(const Computed& computed) {
  if (!computed.finished) {
    return computed.failure.empty() ? "not computed" : "not computed: " + computed.failure;
  }
  const auto& rows = computed.outcome.rows;
  const auto good = std::count_if(rows.begin(), rows.end(), [](const reproduce::Row& row) { return holds(row); });
  return rows.empty() ? "nothing compared" : fmt::format("{} of {} rows hold", good, rows.size());
}

std::string gallery_page(const std::vector<Computed>& systems, bool subdirectories) {
  const bool one = systems.size() == 1;
  const std::string title = one ? systems.front().system->title : "The systems of the thesis";
  std::string out = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" content=\"width="
      "device-width, initial-scale=1\">\n<title>{}</title>\n<style>{}</style>\n</head>\n<body>\n",
      escaped(title), kStyle);
  if (!one) {
    out +=
        "<header>\n<h1>The systems of the thesis, computed</h1>\n<p class=\"lead\">Everything in A. Huynen, "
        "<cite>Eulerian formulation of constrained elastic rods</cite>, solved anew by the program: each system "
        "against its "
        "closed forms, independent formulations or printed numbers.</p>\n<div class=\"scroll\"><table>\n<thead><tr>"
        "<th>system</th><th>thesis</th><th>verdict</th><th class=\"n\">largest difference / tolerance</th></tr></thead>"
        "\n<tbody>\n";
    for (const Computed& c : systems) {
      out += fmt::format("<tr><td><a href=\"#{}\">{}</a></td><td>{}</td><td>{}</td><td class=\"n\">{}</td></tr>\n",
                         escaped(c.system->name), typeset(c.system->title), typeset(c.system->section), chip(c),
                         c.outcome.rows.empty() ? std::string("-") : fmt::format("{:.2g}", worst_share(c)));
    }
    out += "</tbody></table></div>\n</header>\n";
  }
  out += "<main>\n";
  for (const Computed& c : systems) out += section(c, subdirectories ? c.system->name + "/" : "");
  return out +
         fmt::format(
             "</main>\n<footer>tendril {}. A row holds when |computed &minus; expected| is at most its "
             "tolerance; the tolerances are printed digits, rounding, or the accuracy asked of the solver.</footer>\n"
             "</body>\n</html>\n",
             tendril::version());
}

}  // namespace tendril::app
