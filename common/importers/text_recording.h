// What all line-by-line formats share: reads the file, names the sensor, refuses an empty file.
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
  std::string device;                        ///< FrameRecording::device
  std::map<std::string, std::string> notes;  ///< "origin" is added to them.
  std::string unit;                          ///< What an empty file lacks, for the message.
  std::function<Result<void>(LineReader&, const ImportOptions&, record::FrameRecording&)> read;
};

[[nodiscard]] Result<record::FrameRecording> read_text_recording(const std::filesystem::path& file,
                                                                 const ImportOptions& options,
                                                                 const TextFormat& format);

}  // namespace chorus::importers
