// Reads a whole recording at once: collects everything from the stream.
#include <algorithm>
#include <utility>

#include "common/record/recording_outline.h"
#include "common/record/recording_stream.h"

namespace chorus::record {
namespace {

Error too_many_bytes(std::string context, const ReadLimits& limits) {
  return {ErrorCode::TooLarge, std::move(context),
          "it has more than " + std::to_string(limits.max_file_bytes) + " bytes"};
}

Result<Recording> collect(RecordingStream stream, const ReadLimits& limits) {
  Recording out;
  std::uintmax_t bytes = 0;
  for (auto message = stream.next(); true; message = stream.next()) {
    if (!message) return pass(message);
    if (!*message) break;
    bytes += sizeof(Message) + (*message)->topic.size() + (*message)->data.size();
    if (bytes > limits.max_total_bytes) return tl::unexpected<Error>(over_total(limits));
    out.messages.push_back((*message)->copy());
  }
  // The stream orders chunks by the time of the first message that each states; where that time is
  // wrong, messages come out of order.
  std::ranges::stable_sort(out.messages, {}, &Message::log_time);
  out.channels = stream.channels();
  out.metadata = stream.metadata();
  out.truncated = stream.truncated();
  out.notes = stream.notes();
  return out;
}

}  // namespace

Result<Recording> read_recording_bytes(std::string_view bytes, const ReadLimits& limits) {
  if (bytes.size() > limits.max_file_bytes)
    return tl::unexpected<Error>(too_many_bytes("recording", limits));
  auto stream = RecordingStream::of_bytes(bytes, limits);
  if (!stream) return pass(stream);
  return collect(std::move(*stream), limits);
}

Result<Recording> read_recording(const std::filesystem::path& path, const ReadLimits& limits) {
  std::error_code unknown;
  const auto size = std::filesystem::file_size(path, unknown);
  if (!unknown && size > limits.max_file_bytes)
    return tl::unexpected<Error>(too_many_bytes(path.string(), limits));
  auto stream = RecordingStream::open(path, limits);
  if (!stream) return pass(stream);
  auto recording = collect(std::move(*stream), limits);
  if (recording) return recording;
  Error error = recording.error();
  error.context = path.string();
  return tl::unexpected<Error>(std::move(error));
}

}  // namespace chorus::record
