// Internal to the room: the records of a recording and their places, found by stepping from record
// to record without unpacking.
//
// The index at a file's end is not used: after a crash or a disk failure there is none.  The
// message indexes beside each chunk only tell which chunks need not be unpacked.
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
  std::uint64_t offset = 0;  ///< Of the chunk's content, or of the first message's record.
  std::uint64_t length = 0;
  std::uint64_t first = 0;  ///< Log times as the chunk claims them.
  std::uint64_t last = 0;
  std::size_t chunk = 0;  ///< Counted from 1 in file order; 0: messages outside of chunks.
  /// Messages by channel; nothing where no index says so.
  std::optional<std::map<std::uint16_t, std::uint64_t>> counts = {};
};

struct Outline {
  Definitions definitions;  ///< Those outside of chunks.
  std::map<std::string, std::map<std::string, std::string>> metadata;
  std::vector<Piece> pieces;  ///< In file order.
  bool truncated = false;     ///< No footer, or the tail was unreadable.
  std::vector<std::string> notes;
};

[[nodiscard]] Result<Outline> outline_of(const ByteSource& source, const ReadLimits& limits);

/// "it unpacks to more than 100 bytes"
[[nodiscard]] Error over_total(const ReadLimits& limits);

/// At most kMaxNotes, each once.
void add_note(std::vector<std::string>& notes, std::string text);

}  // namespace chorus::record
