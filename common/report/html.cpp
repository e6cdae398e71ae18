#include "common/report/html.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace chorus::report {
namespace {

constexpr std::string_view kStyle = R"css(
:root{--ink:#1c2126;--soft:#5a6570;--ground:#fff;--line:#d5dbe1;--good:#1a7f37;--doubtful:#9a6700;--bad:#b3261e}
@media (prefers-color-scheme:dark){:root{--ink:#e6e9ec;--soft:#9ba7b2;--ground:#15191d;--line:#3a434c;--good:#4cc26a;--doubtful:#e3b341;--bad:#ff8a80}}
@media print{:root{--ink:#000;--soft:#444;--ground:#fff;--line:#bbb;--good:#1a7f37;--doubtful:#7a5200;--bad:#b3261e}section{break-inside:avoid-page}}
body{font:15px/1.5 system-ui,sans-serif;color:var(--ink);background:var(--ground);max-width:60rem;margin:2rem auto;padding:0 1rem}
h1{font-size:1.6rem;margin-bottom:.3rem}h2{font-size:1.2rem;margin-top:2rem;border-bottom:1px solid var(--line)}h3{font-size:1rem}
.verdict{font-size:1.1rem;border-left:.4rem solid var(--line);padding:.4rem .8rem;margin:1rem 0}
table{border-collapse:collapse;width:100%;margin:.6rem 0;display:block;overflow-x:auto}
th,td{text-align:left;vertical-align:top;padding:.25rem .6rem;border-bottom:1px solid var(--line)}
th{color:var(--soft);font-weight:600}td.value{white-space:nowrap;font-variant-numeric:tabular-nums}
.good{color:var(--good)}.doubtful{color:var(--doubtful)}.bad{color:var(--bad)}.verdict{border-color:currentColor}
.soft{color:var(--soft)}figure{margin:1rem 0}figure svg,figure img{max-width:100%;height:auto;background:#fff}
figcaption{color:var(--soft)}dl{display:grid;grid-template-columns:max-content 1fr;gap:.1rem 1rem}dt{color:var(--soft)}dd{margin:0}
)css";

struct Words {
  std::string_view language, figure, value, meaning, limit, no_plot, series, points, least, most;
  std::array<std::string_view, 4> judgements;
};
constexpr std::array<Words, 2> kWords = {Words{"en",
                                               "figure",
                                               "value",
                                               "what it says",
                                               "limit, and what to do",
                                               "The plot is not drawn: ",
                                               "series",
                                               "points",
                                               "least",
                                               "most",
                                               {"", "good", "doubtful", "bad"}},
                                         Words{"de",
                                               "Größe",
                                               "Wert",
                                               "Bedeutung",
                                               "Grenze und Abhilfe",
                                               "Das Diagramm fehlt: ",
                                               "Reihe",
                                               "Punkte",
                                               "kleinster",
                                               "größter",
                                               {"", "gut", "fraglich", "schlecht"}}};

const Words& words_of(const std::string& language) {
  for (const Words& words : kWords)
    if (words.language == language.substr(0, 2)) return words;
  return kWords.front();
}

std::string element(std::string_view name, std::string_view text, const std::string& kind = "") {
  std::string out = "<" + std::string(name);
  if (!kind.empty()) out += " class=\"" + kind + "\"";
  return out + ">" + escaped(text) + "</" + std::string(name) + ">";
}

std::string row(const std::vector<std::string>& cells, std::string_view cell, std::size_t width) {
  std::string out = "<tr>";
  for (std::size_t i = 0; i < width; ++i) out += element(cell, i < cells.size() ? cells[i] : "");
  return out + "</tr>\n";
}

std::string value_of(const Figure& figure) {
  if (!figure.value || !std::isfinite(*figure.value))
    return figure.text.empty() ? "-" : figure.text;
  std::string out = readable(*figure.value);
  if (!figure.unit.empty()) out += " " + figure.unit;
  return figure.text.empty() ? out : out + " (" + figure.text + ")";
}

std::string figure_row(const Figure& figure, const Words& words) {
  std::string out = "<tr><td>" + escaped(figure.name) + "</td><td class=\"value " +
                    name_of(figure.judgement) + "\">" + escaped(value_of(figure));
  if (figure.judgement != Judgement::NotJudged)
    out += " <small>" + std::string(words.judgements[static_cast<std::size_t>(figure.judgement)]) +
           "</small>";
  out += "</td>" + element("td", figure.meaning);
  out += "<td>" + escaped(figure.limit);
  const bool told = figure.judgement == Judgement::Doubtful || figure.judgement == Judgement::Bad;
  if (told && !figure.advice.empty())
    out += (figure.limit.empty() ? "" : "<br>") + element("strong", figure.advice);
  return out + "</td></tr>\n";
}

std::string figures_table(const std::vector<Figure>& figures, const Words& words) {
  if (figures.empty()) return "";
  std::string out = "<table><thead><tr>";
  for (const std::string_view head : {words.figure, words.value, words.meaning, words.limit})
    out += element("th", head);
  out += "</tr></thead><tbody>\n";
  for (const Figure& figure : figures) out += figure_row(figure, words);
  return out + "</tbody></table>\n";
}

std::string table_of(const Table& table) {
  std::string out = table.title.empty() ? "" : element("h3", table.title) + "\n";
  const std::size_t width = table.columns.size();
  out += "<table><thead>" + row(table.columns, "th", width) + "</thead><tbody>\n";
  for (const auto& cells : table.rows) out += row(cells, "td", width);
  return out + "</tbody></table>\n";
}

std::string ranges_of(const Plot& plot, const Words& words) {
  const auto name = [](std::string_view text) { return std::string(text); };
  Table table{plot.title,
              {name(words.series), name(words.points), name(words.least), name(words.most)},
              {}};
  for (const Series& series : plot.series) {
    double least = INFINITY;
    double most = -INFINITY;
    for (const double y : series.y)
      if (std::isfinite(y)) least = std::min(least, y), most = std::max(most, y);
    table.rows.push_back(
        {series.name, std::to_string(series.y.size()), readable(least), readable(most)});
  }
  return table_of(table);
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve(bytes.size() * 4 / 3 + 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t k) -> unsigned {
      return i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U;
    };
    const unsigned three = byte(0) << 16U | byte(1) << 8U | byte(2);
    for (unsigned k = 0; k < 4; ++k)
      out += i + k > bytes.size() ? '=' : digits[three >> (18U - 6U * k) & 63U];
  }
  return out;
}

std::string picture_of(const Picture& picture) {
  return "<figure><img alt=\"" + escaped(picture.alternative) +
         "\" src=\"data:" + escaped(picture.media_type) + ";base64," + base64(picture.bytes) +
         "\">" + element("figcaption", picture.title) + "</figure>\n";
}

// The plots of all sections in their order, drawn at once.
class DrawnPlots {
 public:
  explicit DrawnPlots(const Report& report) : words_(words_of(report.language)) {
    std::vector<Plot> plots;
    for (const Section& section : report.sections)
      plots.insert(plots.end(), section.plots.begin(), section.plots.end());
    drawn_ = drawn(plots);
  }

  std::string next(const Plot& plot) {
    if (!drawn_)
      return element("p", std::string(words_.no_plot) + drawn_.error().message, "soft") +
             ranges_of(plot, words_);
    return "<figure role=\"img\" aria-label=\"" + escaped(plot.title) + "\">" + (*drawn_)[next_++] +
           "</figure>\n";
  }

 private:
  const Words& words_;
  Result<std::vector<std::string>> drawn_;
  std::size_t next_ = 0;
};

std::string section_of(const Section& section, const Words& words, DrawnPlots& plots) {
  std::string out =
      "<section id=\"" + escaped(section.key) + "\">" + element("h2", section.title) + "\n";
  for (const std::string& text : section.paragraphs) out += element("p", text) + "\n";
  out += figures_table(section.figures, words);
  for (const Table& table : section.tables) out += table_of(table);
  for (const Plot& plot : section.plots) out += plots.next(plot);
  for (const Picture& picture : section.pictures) out += picture_of(picture);
  return out + "</section>\n";
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string html_of(const Report& report) {
  const Words& words = words_of(report.language);
  std::string out = "<!DOCTYPE html>\n<html lang=\"" + escaped(report.language) +
                    "\"><head><meta charset=\"utf-8\">"
                    "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">" +
                    element("title", report.title) + "<style>" + std::string(kStyle) +
                    "</style></head><body><main>\n" + element("h1", report.title) + "\n";
  if (!report.verdict.empty())
    out += element("p", report.verdict, "verdict " + name_of(report.judgement)) + "\n";
  if (!report.subject.empty()) {
    out += "<dl>";
    for (const auto& [name, value] : report.subject)
      out += element("dt", name) + element("dd", value);
    out += "</dl>\n";
  }
  DrawnPlots plots(report);
  for (const Section& section : report.sections) out += section_of(section, words, plots);
  return out + "</main></body></html>\n";
}

}  // namespace chorus::report
