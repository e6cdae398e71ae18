#include "common/record/recording_records.h"

#include <zstd.h>

#include <limits>
#include <utility>

namespace chorus::record {
namespace {

using mcap::ByteReader;

/// Largest ratio of a chunk's unpacked to its packed size that is accepted, if its unpacked size
/// exceeds kSmallAnyway [bytes].  JSON of bodies is packed to a tenth of its size, that of empty
/// rooms to a fiftieth; beyond a thousandth it must be an attack.
constexpr std::uint64_t kTightest = 1000;
constexpr std::uint64_t kSmallAnyway = 1U << 16;

std::optional<Timestamp> to_time(std::uint64_t ns) {
  if (ns > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
    return std::nullopt;
  return from_unix_ns(static_cast<std::int64_t>(ns));
}

std::uintmax_t size_of(const Schema& schema) { return schema.name.size() + schema.json.size(); }

std::uintmax_t size_of(const Channel& channel) {
  std::uintmax_t sum =
      channel.topic.size() + channel.schema_name.size() + channel.schema_json.size();
  for (const auto& [key, value] : channel.metadata) sum += key.size() + value.size();
  return sum;
}

/// Stores a definition if it is new; some writers repeat their definitions in each chunk.
template <class Definition>
void define(std::map<std::uint16_t, Definition>& known, std::uint16_t id, Definition definition,
            Definitions& into) {
  const auto found = known.find(id);
  if (found != known.end() && found->second == definition) return;
  into.bytes += sizeof(Definition) + size_of(definition);
  known.insert_or_assign(id, std::move(definition));
}

struct ChunkHead {
  std::uint64_t size = 0;
  std::uint32_t crc = 0;
  std::string_view compression;
  std::string_view packed;
};

Result<std::string> unpack(const ChunkHead& chunk, const ReadLimits& limits) {
  if (chunk.size > limits.max_chunk_bytes) {
    return fail(ErrorCode::TooLarge, "chunk",
                "it claims " + std::to_string(chunk.size) + " bytes, the limit is " +
                    std::to_string(limits.max_chunk_bytes));
  }
  if (chunk.compression.empty()) {
    if (chunk.packed.size() != chunk.size) {
      return fail(ErrorCode::Malformed, "chunk", "its size is not the one it claims");
    }
    return std::string(chunk.packed);
  }
  if (chunk.compression != "zstd") {
    return fail(ErrorCode::Unsupported, "chunk",
                "its compression, " + std::string(chunk.compression.substr(0, 16)) +
                    ", is neither zstd nor none");
  }
  const auto stated = ZSTD_getFrameContentSize(chunk.packed.data(), chunk.packed.size());
  if (stated == ZSTD_CONTENTSIZE_ERROR ||
      (stated != ZSTD_CONTENTSIZE_UNKNOWN && stated != chunk.size)) {
    return fail(ErrorCode::Malformed, "chunk", "its compressed bytes disagree with its size");
  }
  if (chunk.size > kSmallAnyway && chunk.size / kTightest > chunk.packed.size()) {
    return fail(ErrorCode::TooLarge, "chunk",
                "it claims more than " + std::to_string(kTightest) + " times its packed size");
  }
  std::string bytes(static_cast<std::size_t>(chunk.size), '\0');
  const std::size_t got =
      ZSTD_decompress(bytes.data(), bytes.size(), chunk.packed.data(), chunk.packed.size());
  if (ZSTD_isError(got) != 0 || got != bytes.size()) {
    return fail(ErrorCode::Malformed, "chunk", "it does not decompress");
  }
  return bytes;
}

}  // namespace

std::optional<RawRecord> take_record(ByteReader& bytes) {
  const auto op = static_cast<mcap::Op>(bytes.u8());
  const std::uint64_t length = bytes.u64();
  const std::string_view content = bytes.raw(length);
  if (!bytes.ok()) return std::nullopt;
  return RawRecord{op, content};
}

std::string read_schema(std::string_view content, Definitions& into) {
  ByteReader fields(content);
  const std::uint16_t id = fields.u16();
  const std::string_view name = fields.text();
  const std::string_view encoding = fields.text();
  const std::string_view text = fields.text();
  if (!fields.ok()) return "a schema record is cut short";
  if (id == 0) return "a schema has the number 0";
  const std::string_view json = encoding == "jsonschema" ? text : std::string_view{};
  define(into.schemas, id, Schema{std::string(name), std::string(json)}, into);
  return {};
}

std::string read_channel(std::string_view content, const ReadLimits& limits, Definitions& into) {
  ByteReader fields(content);
  const std::uint16_t id = fields.u16();
  const std::uint16_t schema = fields.u16();
  Channel channel;
  channel.topic = fields.text();
  (void)fields.text();  // Skips the encoding; the topic's reader knows it.
  channel.metadata = fields.strings();
  if (!fields.ok()) return "a channel record is cut short";
  if (limits.wanted && !limits.wanted(channel.topic)) into.skipped.insert(id);
  if (const auto found = into.schemas.find(schema); found != into.schemas.end()) {
    channel.schema_name = found->second.name;
    channel.schema_json = found->second.json;
  } else if (schema != 0) {
    return "channel " + channel.topic + " names a schema that is not there";
  }
  define(into.channels, id, std::move(channel), into);
  return {};
}

std::string read_message(std::string_view content, const Definitions& known,
                         std::optional<RawMessage>& out) {
  ByteReader fields(content);
  RawMessage message;
  message.channel = fields.u16();
  message.sequence = fields.u32();
  const auto log_time = to_time(fields.u64());
  const auto publish_time = to_time(fields.u64());
  if (!fields.ok()) return "a message record is cut short";
  if (known.skipped.contains(message.channel)) return {};
  if (!known.channels.contains(message.channel)) {
    return "a message names channel " + std::to_string(message.channel) + ", which is not there";
  }
  if (!log_time || !publish_time) return "a message has a time beyond the year 2262";
  message.log_time = *log_time;
  message.publish_time = *publish_time;
  message.data = fields.rest();
  out = message;
  return {};
}

Result<std::string> unpack_chunk(std::string_view content, const ReadLimits& limits) {
  ByteReader fields(content);
  (void)fields.u64();  // Skips the first and last log time; the messages state theirs themselves.
  (void)fields.u64();
  ChunkHead head;
  head.size = fields.u64();
  head.crc = fields.u32();
  head.compression = fields.text();
  head.packed = fields.raw(fields.u64());
  if (!fields.ok()) return fail(ErrorCode::Malformed, "chunk", "its record is cut short");
  auto bytes = unpack(head, limits);
  if (bytes && head.crc != 0 && head.crc != mcap::crc32(*bytes))
    return fail(ErrorCode::Malformed, "chunk", "its checksum is wrong");
  return bytes;
}

}  // namespace chorus::record
