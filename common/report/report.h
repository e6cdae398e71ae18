// A report: what was measured, what each figure means, and what to do when it is bad.
//
// A report is a value; html.h, report_files.h write it.  Every command that judges something
// (evaluate, score, position, scan, compare, report) fills one.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/report/plot.h"

namespace chorus::report {

/// How a figure stands against its limit.
enum class Judgement { NotJudged, Good, Doubtful, Bad };

/// "good", "doubtful", "bad", or "" for NotJudged.
[[nodiscard]] std::string name_of(Judgement judgement);

/// One measured figure.  It has a value, or a text that says why there is none or what was found.
struct Figure {
  std::string key;   ///< For programs, unique within its section: "wrist_left.missing".
  std::string name;  ///< For people: "left wrist missing".
  std::optional<double> value = std::nullopt;  ///< Not finite counts as none.
  std::string unit = {};                       ///< "mm", "%", "deg", ...
  std::string text = {};                       ///< Shown when there is no value, else behind it.
  std::string meaning = {};                    ///< One line: what the figure says.
  std::string limit = {};                      ///< "at most 5 %".
  std::string advice = {};                     ///< What to do when it is bad.
  Judgement judgement = Judgement::NotJudged;
};

/// Rows of text under headings.  A short row is filled with empty cells.
struct Table {
  std::string title;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};

/// An image in the file itself.
struct Picture {
  std::string title;
  std::string media_type;  ///< "image/png", "image/jpeg" or "image/svg+xml".
  std::string bytes;
  std::string alternative;  ///< What it shows, for those who cannot see it.
};

struct Section {
  std::string key;  ///< For programs, unique within the report: "calibration".
  std::string title;
  std::vector<std::string> paragraphs = {};
  std::vector<Figure> figures = {};
  std::vector<Table> tables = {};
  std::vector<Plot> plots = {};
  std::vector<Picture> pictures = {};
};

struct Report {
  std::string kind;  ///< For programs: "evaluation", "posture", "recording", ...
  std::string title;
  std::string language = "en";  ///< BCP 47, of the texts: "en", "de".
  Judgement judgement = Judgement::NotJudged;
  std::string verdict = {};  ///< One sentence at the top.
  /// What was measured: files, dates, versions, settings; name and value.
  std::vector<std::pair<std::string, std::string>> subject = {};
  std::vector<Section> sections = {};
};

/// The worst judgement of all figures; NotJudged if none is judged.
[[nodiscard]] Judgement worst_of(const std::vector<Section>& sections);

/// A value as people read it: four significant digits, no exponent below 1e7, "-" if not finite.
[[nodiscard]] std::string readable(double value);

}  // namespace chorus::report
