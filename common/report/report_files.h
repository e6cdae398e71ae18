// A report for programs, as JSON and CSV, and as files.
#pragma once

#include <filesystem>
#include <string>

#include "common/base/result.h"
#include "common/report/report.h"

namespace chorus::report {

/// {"kind", "title", "judgement", "verdict", "subject": {}, "sections": [{"key", "title",
/// "figures":
/// [{"key", "name", "value", "unit", "text", "judgement", "limit"}], "tables": [...], "series":
/// [...]}]}.  Values that are not finite are null.
[[nodiscard]] std::string json_of(const Report& report);

/// One line a figure: section,key,name,value,unit,judgement,limit,text (RFC 4180).
[[nodiscard]] std::string csv_of(const Report& report);

/// Whether write_report() can write this file: the ending is known, its folder is there, the name
/// is not too long.  Ask before work that takes minutes.
[[nodiscard]] Result<void> may_write_report(const std::filesystem::path& file);

/// Writes the report in the form that the ending names: .html, .json or .csv.  An error for other
/// endings, and when the file cannot be written.
[[nodiscard]] Result<void> write_report(const Report& report, const std::filesystem::path& file);

/// Writes FOLDER/NAME.html, .json and .csv; makes the folder.
[[nodiscard]] Result<void> write_reports(const Report& report, const std::filesystem::path& folder,
                                         const std::string& name);

}  // namespace chorus::report
