#include "common/importers/text_recording.h"

#include <algorithm>
#include <string_view>
#include <utility>

namespace chorus::importers {
namespace {

std::ptrdiff_t separators(std::string_view line) {
  return std::ranges::count_if(line, [](char c) { return c == ',' || c == ' ' || c == '\t'; });
}

/// True when the last line has no line end and fewer separators than the line before.
bool cut_off(std::string_view text) {
  const std::size_t end = text.rfind('\n');
  if (end == std::string_view::npos || end + 1 == text.size()) return false;
  const std::string_view before = text.substr(0, end);
  const std::size_t begin = before.rfind('\n');
  return separators(text.substr(end + 1)) <
         separators(begin == std::string_view::npos ? before : before.substr(begin + 1));
}

}  // namespace

Result<record::FrameRecording> read_text_recording(const std::filesystem::path& file,
                                                   const ImportOptions& options,
                                                   const TextFormat& format) {
  const auto text = read_bounded(file, options.limits.max_text_bytes);
  if (!text) return pass(text);
  const auto sensor = sensor_for(file, options);
  if (!sensor) return pass(sensor);
  record::FrameRecording recording;
  recording.sensor = *sensor;
  recording.device = format.device;
  recording.floor = options.floor;
  recording.notes = format.notes;
  recording.notes["origin"] = file.filename().string();
  record::FrameRecording whole = recording;
  LineReader lines(*text, file.string());
  auto read = format.read(lines, options, whole);
  if (!read && cut_off(*text)) {
    // The program that wrote the file was stopped in the middle of a line.
    whole = std::move(recording);
    const std::string_view complete = std::string_view(*text).substr(0, text->rfind('\n') + 1);
    LineReader again(complete, file.string());
    if (format.read(again, options, whole) && !whole.frames.empty()) {
      whole.notes["damage.1"] = "the last line is cut off and was left out";
      read = {};
    }
  }
  if (!read) return pass(read);
  if (whole.frames.empty())
    return fail(ErrorCode::Malformed, file.string(), "holds no " + format.unit + " at all.");
  return whole;
}

}  // namespace chorus::importers
