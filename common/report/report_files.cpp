#include "common/report/report_files.h"

#include <cmath>
#include <system_error>

#include <nlohmann/json.hpp>

#include "common/base/file.h"
#include "common/report/html.h"

namespace chorus::report {
namespace {

using nlohmann::ordered_json;

ordered_json numbers(const std::vector<double>& values) {
  ordered_json out = ordered_json::array();
  for (const double value : values)
    out.push_back(std::isfinite(value) ? ordered_json(value) : nullptr);
  return out;
}

ordered_json figure_json(const Figure& figure) {
  const bool has_value = figure.value && std::isfinite(*figure.value);
  return {{"key", figure.key},
          {"name", figure.name},
          {"value", has_value ? ordered_json(*figure.value) : ordered_json(nullptr)},
          {"unit", figure.unit},
          {"text", figure.text},
          {"judgement", name_of(figure.judgement)},
          {"limit", figure.limit}};
}

ordered_json section_json(const Section& section) {
  ordered_json out = {{"key", section.key}, {"title", section.title}};
  out["figures"] = ordered_json::array();
  for (const Figure& figure : section.figures) out["figures"].push_back(figure_json(figure));
  out["tables"] = ordered_json::array();
  for (const Table& table : section.tables)
    out["tables"].push_back(
        {{"title", table.title}, {"columns", table.columns}, {"rows", table.rows}});
  out["series"] = ordered_json::array();
  for (const Plot& plot : section.plots)
    for (const Series& series : plot.series)
      out["series"].push_back({{"plot", plot.title},
                               {"name", series.name},
                               {"x", numbers(series.x)},
                               {"y", numbers(series.y)}});
  return out;
}

std::string field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

}  // namespace

std::string json_of(const Report& report) {
  ordered_json out = {{"kind", report.kind},
                      {"title", report.title},
                      {"judgement", name_of(report.judgement)},
                      {"verdict", report.verdict}};
  out["subject"] = ordered_json::object();
  for (const auto& [name, value] : report.subject) out["subject"][name] = value;
  out["sections"] = ordered_json::array();
  for (const Section& section : report.sections) out["sections"].push_back(section_json(section));
  return out.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

std::string csv_of(const Report& report) {
  std::string out = "section,key,name,value,unit,judgement,limit,text\r\n";
  for (const Section& section : report.sections)
    for (const Figure& figure : section.figures) {
      const bool has_value = figure.value && std::isfinite(*figure.value);
      out += field(section.key) + "," + field(figure.key) + "," + field(figure.name) + "," +
             (has_value ? ordered_json(*figure.value).dump() : "") + "," + field(figure.unit) +
             "," + name_of(figure.judgement) + "," + field(figure.limit) + "," +
             field(figure.text) + "\r\n";
    }
  return out;
}

Result<void> may_write_report(const std::filesystem::path& file) {
  constexpr std::size_t kLongestName = 240;  // file systems allow 255 bytes, ".partial" included
  const std::string ending = file.extension().string();
  if (ending != ".html" && ending != ".json" && ending != ".csv")
    return fail(ErrorCode::InvalidArgument, file.string(),
                "a report is written as .html, .json or .csv");
  const std::string name = file.filename().string();
  if (name.size() > kLongestName)
    return fail(ErrorCode::InvalidArgument, name.substr(0, 40) + "...",
                "is too long a name for a file (" + std::to_string(name.size()) +
                    " bytes); use at most " + std::to_string(kLongestName));
  std::error_code error;
  const std::filesystem::path folder = file.parent_path();
  if (!folder.empty() && !std::filesystem::is_directory(folder, error))
    return fail(ErrorCode::NotFound, file.string(), "its folder is not there; make it first");
  if (std::filesystem::is_directory(file, error))
    return fail(ErrorCode::InvalidArgument, file.string(), "is a folder; name a file");
  return {};
}

Result<void> write_report(const Report& report, const std::filesystem::path& file) {
  if (auto ok = may_write_report(file); !ok) return ok;
  const std::string ending = file.extension().string();
  if (ending == ".html") return replace_file(file, html_of(report));
  if (ending == ".json") return replace_file(file, json_of(report));
  return replace_file(file, csv_of(report));
}

Result<void> write_reports(const Report& report, const std::filesystem::path& folder,
                           const std::string& name) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return fail(ErrorCode::Io, folder.string(), "cannot be made: " + error.message());
  for (const char* ending : {".html", ".json", ".csv"}) {
    const auto written = write_report(report, folder / (name + ending));
    if (!written) return written;
  }
  return {};
}

}  // namespace chorus::report
