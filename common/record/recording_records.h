// Internal to common/record: reads single records of a recording, and refuses broken ones.
//
// The functions read_...() return "" or what is wrong with the record.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "common/record/mcap_format.h"
#include "common/record/recording.h"

namespace chorus::record {

struct Schema {
  std::string name;
  std::string json;

  bool operator==(const Schema&) const = default;
};

/// The channels and schemas known at some point of the file.
struct Definitions {
  std::map<std::uint16_t, Schema> schemas;
  std::map<std::uint16_t, Channel> channels;
  std::set<std::uint16_t> skipped;  ///< Channels that ReadLimits::wanted does not want.
  /// Memory of all definitions.  It is limited, because a small file can repeat one long schema for
  /// 65535 channels.
  std::uintmax_t bytes = 0;
};

struct RawRecord {
  mcap::Op op;
  std::string_view content;
};

/// A message whose data points into the bytes of its chunk.
struct RawMessage {
  std::uint16_t channel = 0;
  std::uint32_t sequence = 0;
  Timestamp log_time;
  Timestamp publish_time;
  std::string_view data;
};

/// Takes the next record; none when the bytes end within it.
[[nodiscard]] std::optional<RawRecord> take_record(mcap::ByteReader& bytes);

[[nodiscard]] std::string read_schema(std::string_view content, Definitions& into);
[[nodiscard]] std::string read_channel(std::string_view content, const ReadLimits& limits,
                                       Definitions& into);
/// `out` stays empty for a channel in `known.skipped`.
[[nodiscard]] std::string read_message(std::string_view content, const Definitions& known,
                                       std::optional<RawMessage>& out);

/// The unpacked records of a chunk.  Refuses a chunk that claims to be larger than the limits, or
/// that is packed more tightly than any real recording.
[[nodiscard]] Result<std::string> unpack_chunk(std::string_view content, const ReadLimits& limits);

}  // namespace chorus::record
