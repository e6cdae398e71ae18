#include "common/assessment/sheet.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "common/assessment/sheet_drawing.h"
#include "common/assessment/sheet_words.h"
#include "common/base/units.h"
#include "common/report/html.h"

namespace chorus::assessment {
namespace {

using ergonomics::Codes;
using ergonomics::Method;
using ergonomics::MethodSummary;
using ergonomics::Side;
using ergonomics::Text;

constexpr std::string_view kStyle = R"(
:root{color-scheme:light dark}body{font:14px/1.4 system-ui,sans-serif;margin:1.5em auto;max-width:52em;padding:0 1em;color:CanvasText;background:Canvas}
h1{font-size:1.4em}h2{font-size:1.15em;margin:1.2em 0 .3em}h3{font-size:1em;margin:1em 0 .3em}
table{border-collapse:collapse;width:100%}th,td{border:1px solid #888;padding:.2em .5em;text-align:left;vertical-align:top}
td.number,th.number{text-align:right}input{font:inherit;width:6em;border:1px solid #888;background:Field;color:FieldText}
.measured{border-left:5px solid #1a7f4b}.asked{border-left:5px solid #1f5fbf}.computed{border-left:5px solid #8888}.unknown{border-left:5px dashed #b3541e}
.result{font-size:1.2em;font-weight:600;padding:.4em 0}.small{font-size:.9em}
.figures{display:flex;flex-wrap:wrap;gap:1em}figure{margin:0}figcaption{font-size:.9em}
.bone{stroke:#888;stroke-width:4;stroke-linecap:round}.bone.left{stroke:#1f5fbf}.head{fill:none;stroke:#888;stroke-width:3}.floor{stroke:#888}
.timeline{width:100%}.timeline text{font-size:11px;fill:currentColor}.grid{stroke:#8886}.set{fill:#1f5fbf44}.none{fill:#8883}.score{fill:none;stroke:#1f5fbf;stroke-width:1.5}.worst{font-weight:700}
h1,h2,h3{break-after:avoid}section{break-after:page}section:last-of-type{break-after:auto}
@page{size:A4;margin:11mm}
@media print{button{display:none}body{margin:0;padding:0;max-width:none;font-size:10px;line-height:1.25}h1{font-size:15px;margin:0 0 2px}h2,h3{font-size:11px;margin:6px 0 2px}p{margin:2px 0}
th,td{padding:1px 5px}input{border:0;border-bottom:1px solid #000;height:11px}.result{font-size:13px;padding:2px 0}figure svg{height:104px;width:auto}.timeline{max-height:120px}figure,table,svg{break-inside:avoid}}
)";

/// Writes what was typed into the document, so that a saved page keeps it beside what was measured.
constexpr std::string_view kScript = R"(
addEventListener('input',e=>{if(e.target.tagName==='INPUT')e.target.setAttribute('value',e.target.value)});
document.querySelectorAll('button.keep').forEach(b=>b.addEventListener('click',()=>{
const a=document.createElement('a');a.href=URL.createObjectURL(new Blob(['<!doctype html>\n'+document.documentElement.outerHTML],{type:'text/html'}));
a.download='corrected-sheet.html';a.click()}));
)";

class Sheet {
 public:
  Sheet(const Assessment& about, Language language)
      : about_(about), german_(language == Language::German) {}

  std::string page(const SheetPerson& person, std::size_t method) const;
  std::string head() const;
  std::string foot() const { return fmt::format("<script>{}</script></body></html>\n", kScript); }

 private:
  std::string say(const Text& text) const { return report::escaped(german_ ? text.de : text.en); }
  std::string number(double value, int digits) const;
  /// "12", or "12-40" where unknown inputs leave a range.
  std::string from_to(double least, double most, int digits) const;
  std::string form(const SheetPerson& person, std::size_t method) const;
  std::string fields(const Method& method, const ergonomics::Observation& seen, Side side,
                     const ergonomics::Asked& asked) const;
  std::string code_odds(const Method& method, std::size_t input,
                        const ergonomics::Observation& seen, Side side) const;
  std::string times(const MethodSummary& summary) const;
  std::string worst(const SheetPerson& person, const MethodSummary& summary) const;
  std::string unseen(const MethodSummary& summary) const;

  const Assessment& about_;
  bool german_;
};

std::string Sheet::number(double value, int digits) const {
  std::string text = fmt::format("{:.{}f}", value, digits);
  if (german_) std::ranges::replace(text, '.', ',');
  return text;
}

std::string Sheet::head() const {
  return fmt::format(
      "<!doctype html><html lang=\"{}\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width\"><title>{}</title><style>{}</style></head><body>",
      german_ ? "de" : "en", say(word("title")), kStyle);
}

/// "3 (80 %), 4 (20 %)": the codes of an input among the drawn bodies.
std::string Sheet::code_odds(const Method& method, std::size_t input,
                             const ergonomics::Observation& seen, Side side) const {
  std::array<int, 16> counts{};
  ergonomics::Seen drawn = seen.seen;
  for (const auto& draw : seen.draws) {
    drawn.measures = draw;
    Codes codes{};
    method.measure(drawn, side, codes);
    ++counts[static_cast<std::size_t>(std::clamp<int>(codes[input], 0, 15))];
  }
  std::string text;
  for (std::size_t code = 1; code < counts.size(); ++code) {
    if (counts[code] == 0) continue;
    const double share = 100.0 * counts[code] / static_cast<double>(seen.draws.size());
    text += fmt::format("{}{} ({} %)", text.empty() ? "" : ", ", code, number(share, 0));
  }
  return text;
}

std::string Sheet::fields(const Method& method, const ergonomics::Observation& seen, Side side,
                          const ergonomics::Asked& asked) const {
  Codes measured{};
  method.measure(seen.seen, side, measured);
  const Codes codes = codes_of(method, seen.seen, side, asked);
  std::string rows;
  for (std::size_t i = 0; i < method.inputs.size(); ++i) {
    const auto& input = method.inputs[i];
    const bool known = codes[i] != 0;
    // An answer may stand for a measure, as that of a straight wrist.
    const bool own =
        known && input.origin == ergonomics::Origin::Measured && measured[i] == codes[i];
    const Text origin = !known ? word("unknown") : own ? word("measured") : word("asked");
    const std::string_view style = !known ? "unknown" : own ? "measured" : "asked";
    const std::string value =
        known ? std::to_string(codes[i]) : fmt::format("{}-{}", input.lowest, input.highest);
    const std::string doubt = own ? code_odds(method, i, seen, side) : std::string();
    rows += fmt::format(
        "<tr><td class=\"{0}\">{1}</td><td class=\"number\">{2}</td><td>{3}{4}</td><td><input "
        "aria-label=\"{5}: {1}\" value=\"\"></td></tr>",
        style, say(input.name), value, say(origin),
        doubt.empty() ? "" : fmt::format(" <span class=\"small\">{}</span>", doubt),
        say(word("correction")));
  }
  return rows;
}

std::string Sheet::form(const SheetPerson& person, std::size_t index) const {
  const auto& scored = person.person.scored;
  const MethodSummary& summary = scored.methods[index];
  const Method& method = *summary.method;
  if (summary.worst.empty()) return {};
  const auto& moment = summary.worst.front();
  const auto& seen = scored.observations[moment.index];
  const auto& score = scored.instants[moment.index].scores[index];
  const Side side =
      method.sided && score.sides[1].high > score.sides[0].high ? Side::Right : Side::Left;
  const auto asked = about_.task.asked_at(moment.at);
  std::string html = fmt::format(
      "<h3>{} ({} {} s{})</h3>", say(word("form")), say(word("at")), number(moment.at, 1),
      method.sided ? fmt::format(", {} {}", say(word("side")),
                                 say(side == Side::Left ? word("left") : word("right")))
                   : "");
  html +=
      fmt::format("<table><tr><th>{}</th><th class=\"number\">{}</th><th>{}</th><th>{}</th></tr>{}",
                  say(word("field")), say(word("value")), say(word("origin")),
                  say(word("correction")), fields(method, seen, side, asked));
  Codes codes = codes_of(method, seen.seen, side, asked);
  const bool whole = std::ranges::none_of(method.inputs, [&](const auto& input) {
    return codes[static_cast<std::size_t>(&input - method.inputs.data())] == 0;
  });
  if (whole) {
    for (const auto& step : method.steps(codes))
      html += fmt::format(
          "<tr><td class=\"computed\">{0}</td><td class=\"number\">{1}</td><td>{3}</td><td><input "
          "aria-label=\"{2}: {0}\" value=\"\"></td></tr>",
          say(step.name), step.value, say(word("correction")), say(word("computed")));
  }
  const auto& level = method.levels[level_of(method, moment.score.high)];
  html += fmt::format("</table><p class=\"result\">{}: {} - {}</p><p>{}: {} {} {}</p>",
                      say(word("result")), report::escaped(range_text(method, codes, german_)),
                      say(level.text), say(word("set")), moment.set.from, german_ ? "bis" : "to",
                      moment.set.to);
  return html;
}

std::string Sheet::from_to(double least, double most, int digits) const {
  const std::string low = number(least, digits);
  const std::string high = number(most, digits);
  return low == high ? low : low + "-" + high;
}

std::string Sheet::times(const MethodSummary& summary) const {
  std::string html = fmt::format(
      "<h3>{}</h3><table><tr><th></th><th class=\"number\">{}</th><th class=\"number\">{}"
      "</th><th>{}</th></tr>",
      say(word("times")), say(word("share")), say(word("per_minute")), say(word("correction")));
  for (std::size_t l = 0; l < summary.levels.size(); ++l) {
    const auto& zone = summary.levels[l];
    html += fmt::format(
        "<tr><td class=\"measured\">{0}</td><td class=\"number\">{1} % ({2}-{3} %)</td><td "
        "class=\"number\">{4}</td><td><input aria-label=\"{5}: {0}\" value=\"\"></td></tr>",
        say(summary.method->levels[l].text), from_to(100 * zone.least, 100 * zone.most, 0),
        number(100 * zone.low, 0), number(100 * zone.high, 0),
        from_to(60 * zone.least, 60 * zone.most, 1), say(word("correction")));
  }
  return html + "</table>";
}

std::string Sheet::worst(const SheetPerson& person, const MethodSummary& summary) const {
  if (summary.worst.empty()) return {};
  std::string html = fmt::format("<h3>{}</h3><div class=\"figures\">", say(word("worst")));
  for (std::size_t w = 0; w < summary.worst.size(); ++w) {
    const auto& moment = summary.worst[w];
    const auto& body = person.bodies[moment.index].body;
    html +=
        fmt::format("<figure>{}{}<figcaption>{}. {} {} s: {} ({} {} {}); {}</figcaption></figure>",
                    stick_figure(body, View::Front), stick_figure(body, View::Left), w + 1,
                    say(word("at")), number(moment.at, 1), moment.score.high, moment.set.from,
                    german_ ? "bis" : "to", moment.set.to, say(word("views")));
  }
  return html + "</div>";
}

std::string Sheet::unseen(const MethodSummary& summary) const {
  constexpr std::array<Text, ergonomics::kReasons> kReasons{
      {{"", ""},
       {"nobody saw the person; the body is only expected",
        "niemand sah die Person; der Körper ist nur erwartet"},
       {"joints not seen", "Gelenke nicht gesehen"},
       {"pose without defined angles", "Haltung ohne definierte Winkel"}}};
  std::string list;
  for (std::size_t r = 1; r < kReasons.size(); ++r) {
    if (summary.unscored[r] > 0.0)
      list += fmt::format("{}{} % {}", list.empty() ? "" : ", ",
                          number(100 * summary.unscored[r], 1), say(kReasons[r]));
  }
  return fmt::format("<p>{}: {}.</p>", say(word("unseen")),
                     list.empty() ? say(word("nothing")) : list);
}

std::string Sheet::page(const SheetPerson& person, std::size_t index) const {
  const auto& scored = person.person.scored;
  const MethodSummary& summary = scored.methods[index];
  const Method& method = *summary.method;
  std::string html = fmt::format(
      "<section><h1>{}{}{}</h1><p>{}</p><table><tr><th>{}</th><td>{}</td><th>{}</th><td>{}</td></"
      "tr>"
      "<tr><th>{}</th><td>{} s</td><th>{}</th><td><input aria-label=\"{}\" "
      "value=\"\"></td></tr></table>",
      say(method.title), about_.task.title.empty() ? "" : ": ", report::escaped(about_.task.title),
      say(word("screening")), say(word("source")), report::escaped(about_.source),
      say(word("person")), person.person.id, say(word("duration")), number(scored.seconds, 1),
      say(word("by")), say(word("by")));
  html += fmt::format("<p class=\"small\">{}</p>",
                      say(scored.has_stance ? word("stance_own") : word("stance_none")));
  html += form(person, index);
  html += times(summary);
  if (method.ordered) {
    html += fmt::format("<h3>{}</h3>{}", say(word("timeline")),
                        score_timeline(scored, index,
                                       german_ ? std::string(word("timeline").de)
                                               : std::string(word("timeline").en)));
  }
  html += worst(person, summary);
  html += unseen(summary);
  return html +
         fmt::format("<p class=\"small\">{}: {}</p><button class=\"keep\">{}</button></section>",
                     say(word("source_of")), report::escaped(method.source), say(word("keep")));
}

}  // namespace

std::string sheet_html(const Assessment& assessment, const std::vector<SheetPerson>& persons,
                       Language language) {
  const Sheet sheet(assessment, language);
  std::string html = sheet.head();
  for (const SheetPerson& person : persons) {
    for (std::size_t m = 0; m < assessment.methods.size(); ++m) html += sheet.page(person, m);
  }
  return html + sheet.foot();
}

}  // namespace chorus::assessment
