// Internal to the room: finds the records of a recording and their places by stepping from record
// to record without unpacking.
//
// The index at the end of a file is not used, because there is none after a crash or a disk
// failure. The message indexes after each chunk only tell which chunks need not be unpacked.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/record/byte_source.h"
#include "common/record/recording_records.h"

namespace chorus::record {

/// A chunk, or consecutive messages outside of one.
struct Piece {
  std::uint64_t offset = 0;  ///< Where the chunk's content, or the first message's record, begins.
  std::uint64_t length = 0;
  std::uint64_t first = 0;  ///< Log times as the chunk states them.
  std::uint64_t last = 0;
  std::size_t chunk = 0;  ///< Counted from 1 in file order; 0: messages outside of chunks.
  /// Number of messages by channel; none where no index states it.
  std::optional<std::map<std::uint16_t, std::uint64_t>> counts = {};
};

struct Outline {
  Definitions definitions;  ///< The definitions outside of chunks.
  std::map<std::string, std::map<std::string, std::string>> metadata;
  std::vector<Piece> pieces;  ///< In file order.
  bool truncated = false;     ///< No footer, or the tail was unreadable.
  std::vector<std::string> notes;
};

[[nodiscard]] Result<Outline> outline_of(const ByteSource& source, const ReadLimits& limits);

/// The error when a recording exceeds the limit: "it unpacks to more than 100 bytes"
[[nodiscard]] Error over_total(const ReadLimits& limits);

/// Adds a note that is not there yet, up to kMaxNotes.
void add_note(std::vector<std::string>& notes, std::string text);

}  // namespace chorus::record
