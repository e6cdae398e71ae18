#include "common/report/report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace chorus::report {

std::string name_of(Judgement judgement) {
  switch (judgement) {
    case Judgement::NotJudged:
      return "";
    case Judgement::Good:
      return "good";
    case Judgement::Doubtful:
      return "doubtful";
    case Judgement::Bad:
      return "bad";
  }
  return "";
}

Judgement worst_of(const std::vector<Section>& sections) {
  Judgement worst = Judgement::NotJudged;
  for (const Section& section : sections)
    for (const Figure& figure : section.figures) worst = std::max(worst, figure.judgement);
  return worst;
}

std::string readable(double value) {
  if (!std::isfinite(value)) return "-";
  const double size = std::abs(value);
  if (size >= 1e7 || (size > 0.0 && size < 1e-4)) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", value);
    return text;
  }
  const int whole_digits = size < 1.0 ? 1 : static_cast<int>(std::floor(std::log10(size))) + 1;
  char text[48];
  std::snprintf(text, sizeof text, "%.*f", std::max(0, 4 - whole_digits), value);
  std::string number = text;
  if (number.find('.') == std::string::npos) return number;
  number.erase(number.find_last_not_of('0') + 1);
  if (number.back() == '.') number.pop_back();
  return number == "-0" ? "0" : number;
}

}  // namespace chorus::report
