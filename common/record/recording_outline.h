// Internal to common/record: finds the records of a recording and their offsets by stepping from
// record to record without unpacking.
//
// The index at the end of a file is not used, because after a crash or a disk failure there is
// none. The message indexes after each chunk are used only to count messages and to find chunks
// that need not be unpacked.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/record/byte_source.h"
#include "common/record/recording_records.h"

namespace chorus::record {

/// A chunk, or consecutive messages outside chunks.
struct Piece {
  /// File offset of the chunk's content, or of the first message's record.
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
  std::uint64_t first = 0;  ///< First log time, as the chunk states it.
  std::uint64_t last = 0;
  std::size_t chunk = 0;  ///< Counted from 1 in file order; 0: messages outside of chunks.
  /// Number of messages by channel; none if no index states it.
  std::optional<std::map<std::uint16_t, std::uint64_t>> counts = {};
};

struct Outline {
  Definitions definitions;  ///< Those outside chunks; a stream adds those of the chunks it unpacks.
  std::map<std::string, std::map<std::string, std::string>> metadata;
  std::vector<Piece> pieces;  ///< In file order.
  bool truncated = false;     ///< True if there is no footer, or the tail was unreadable.
  std::vector<std::string> notes;
};

[[nodiscard]] Result<Outline> outline_of(const ByteSource& source, const ReadLimits& limits);

/// The error when a recording exceeds the limit: "it unpacks to more than 100 bytes"
[[nodiscard]] Error over_total(const ReadLimits& limits);

/// Adds a note, unless it is already there or there are kMaxNotes.
void add_note(std::vector<std::string>& notes, std::string text);

}  // namespace chorus::record
