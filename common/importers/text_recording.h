// What all line-by-line formats share: reads the file, names the sensor, leaves out a last line
// that is cut off, and refuses a file without frames.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>

#include "common/importers/import_options.h"
#include "common/importers/text_rows.h"
#include "common/record/frame_recording.h"

namespace chorus::importers {

struct TextFormat {
  std::string device;  ///< The value of FrameRecording::device.
  /// Notes of the recording, to which the note "origin" is added.
  std::map<std::string, std::string> notes;
  std::string unit;  ///< What the format calls a frame, such as "row", for the error about a file
                     ///< without frames.
  std::function<Result<void>(LineReader&, const ImportOptions&, record::FrameRecording&)> read;
};

[[nodiscard]] Result<record::FrameRecording> read_text_recording(const std::filesystem::path& file,
                                                                 const ImportOptions& options,
                                                                 const TextFormat& format);

}  // namespace chorus::importers
