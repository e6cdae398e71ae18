#include "common/importers/text_recording.h"

namespace chorus::importers {

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
  LineReader lines(*text, file.string());
  if (const auto read = format.read(lines, options, recording); !read) return pass(read);
  if (recording.frames.empty())
    return fail(ErrorCode::Malformed, file.string(), "holds no " + format.unit + " at all.");
  return recording;
}

}  // namespace chorus::importers
