// Reads any bytes as a recording: no crash, no endless loop, no unbounded memory.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "common/record/cell_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const chorus::record::ReadLimits limits{
      .max_file_bytes = 1u << 20, .max_chunk_bytes = 1u << 20, .max_total_bytes = 16u << 20};
  auto read = chorus::record::read_recording_bytes(
      std::string_view(reinterpret_cast<const char*>(bytes), size), limits);
  if (!read) return 0;
  for (std::size_t i = 1; i < read->messages.size(); ++i) {
    if (read->messages[i].log_time < read->messages[i - 1].log_time) __builtin_trap();
  }
  if (read->notes.size() > chorus::record::kMaxNotes) __builtin_trap();
  // Reads it as a recording of a cell, too: the frames of every stream are ordered by time.
  const auto session = chorus::record::cell_of(*read, "fuzz", {.fused = true});
  if (!session) return 0;
  for (const auto& sensor : session->sensors) {
    for (std::size_t i = 1; i < sensor.frames.size(); ++i) {
      if (sensor.frames[i].captured <= sensor.frames[i - 1].captured) __builtin_trap();
    }
  }
  return 0;
}
