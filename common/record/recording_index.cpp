#include "common/record/recording_index.h"

#include <algorithm>
#include <array>
#include <system_error>

#include <nlohmann/json.hpp>

#include "common/base/file.h"
#include "common/base/json.h"

namespace chorus::record {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 5> kStateNames{"recording", "stopping", "finished", "failed",
                                                      "interrupted"};
constexpr std::size_t kMaxName = 64;
constexpr std::uintmax_t kMaxIndexBytes = 1u << 20;

std::string text_at(const nlohmann::json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? found->get<std::string>() : std::string{};
}

std::uint64_t count_at(const nlohmann::json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_number_unsigned() ? found->get<std::uint64_t>() : 0;
}

std::optional<Timestamp> time_at(const nlohmann::json& json, const char* key) {
  const auto time = parse_iso8601(text_at(json, key));
  return time ? std::optional(*time) : std::nullopt;
}

RecordingState state_named(std::string_view name) {
  const auto found = std::find(kStateNames.begin(), kStateNames.end(), name);
  const auto state = static_cast<RecordingState>(found - kStateNames.begin());
  const bool ended = state == RecordingState::Finished || state == RecordingState::Failed;
  return found != kStateNames.end() && ended ? state : RecordingState::Interrupted;
}

/// Adds the files in the index, with their sizes on disk, because the last file grew after the
/// index was written.
void add_files(const fs::path& folder, const nlohmann::json& json, RecordingReport& report) {
  const auto files = json.find("files");
  if (files == json.end() || !files->is_array()) return;
  for (const auto& file : *files) {
    RecordedFile one;
    one.name = file.is_object() ? text_at(file, "name") : std::string{};
    std::error_code error;
    one.bytes = fs::file_size(folder / fs::path(one.name).filename(), error);
    if (error || one.name.empty() || one.name != fs::path(one.name).filename()) continue;
    one.started = time_at(file, "started").value_or(Timestamp{});
    report.files.push_back(std::move(one));
  }
}

}  // namespace

std::string_view name_of(RecordingState state) noexcept {
  return kStateNames.at(static_cast<std::size_t>(state));
}

std::uint64_t RecordingReport::bytes() const {
  std::uint64_t sum = 0;
  for (const RecordedFile& file : files) sum += file.bytes;
  return sum;
}

bool is_recording_name(std::string_view name) {
  const auto fits = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-';
  };
  return !name.empty() && name.size() <= kMaxName && std::all_of(name.begin(), name.end(), fits);
}

std::string utc_name(Timestamp t) {
  std::string name;
  const std::string iso = to_iso8601(t);
  for (const char c : iso.substr(0, iso.find('.'))) {
    if (c != '-' && c != ':') name += c;
  }
  return name + "Z";
}

Result<void> write_index(const fs::path& folder, const RecordingReport& report) {
  nlohmann::json json{{"name", report.name},
                      {"state", name_of(report.state)},
                      {"started", to_iso8601(report.started)},
                      {"frames", report.frames},
                      {"dropped", report.dropped},
                      {"files", nlohmann::json::array()}};
  if (!report.reason.empty()) json["reason"] = report.reason;
  if (report.stopped) json["stopped"] = to_iso8601(*report.stopped);
  for (const RecordedFile& file : report.files) {
    json["files"].push_back(
        {{"name", file.name}, {"started", to_iso8601(file.started)}, {"bytes", file.bytes}});
  }
  return replace_file(folder / kIndexFile,
                      json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

Result<RecordingReport> read_index(const fs::path& folder) {
  const fs::path path = folder / kIndexFile;
  const auto text = read_file(path, kMaxIndexBytes);
  if (!text) return pass(text);
  const auto json = parse_json(*text, {.bytes = kMaxIndexBytes}).value_or(nlohmann::json());
  const bool usable = json.is_object() && time_at(json, "started");
  if (!usable) return fail(ErrorCode::Malformed, path.string(), "this is no index of a recording");
  RecordingReport report;
  report.name = folder.filename().string();
  report.state = state_named(text_at(json, "state"));
  report.reason = text_at(json, "reason");
  report.started = *time_at(json, "started");
  report.stopped = time_at(json, "stopped");
  report.frames = count_at(json, "frames");
  report.dropped = count_at(json, "dropped");
  add_files(folder, json, report);
  return report;
}

}  // namespace chorus::record
