// Reads MCAP front to back, without trust in its index: every length is checked before it is used,
// a chunk counts whole or not at all, and whatever is left out is named.
#include <zstd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include "common/record/mcap_format.h"
#include "common/record/recording.h"

namespace chorus::record {

namespace {

using mcap::ByteReader;
using mcap::Op;

struct Schema {
  std::string name;
  std::string json;

  bool operator==(const Schema&) const = default;
};

/// What is known at some point of the file, and what was collected so far.
struct Contents {
  std::map<std::uint16_t, Schema> schemas;
  std::map<std::uint16_t, Channel> channels;
  std::set<std::uint16_t> skipped;  ///< Channels nobody wants.
  std::vector<Message> messages;
  /// Memory of the messages, tiny ones with long topics included, and of what channels and schemas
  /// say: a small file can repeat one long schema in 65535 channels.
  std::uintmax_t bytes = 0;
};

struct RawRecord {
  Op op;
  std::string_view content;
};

/// Next record, or nothing when the bytes end inside it.
std::optional<RawRecord> take_record(ByteReader& bytes) {
  const auto op = static_cast<Op>(bytes.u8());
  const std::uint64_t length = bytes.u64();
  const std::string_view content = bytes.raw(length);
  if (!bytes.ok()) return std::nullopt;
  return RawRecord{op, content};
}

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

/// Writers repeat their definitions in every chunk; only what is new takes memory.
template <class Definition>
void define(std::map<std::uint16_t, Definition>& known, std::uint16_t id, Definition definition,
            Contents& into) {
  const auto found = known.find(id);
  if (found != known.end() && found->second == definition) return;
  into.bytes += sizeof(Definition) + size_of(definition);
  known.insert_or_assign(id, std::move(definition));
}

// Each of these returns "" or what is wrong with the record.

std::string read_schema(std::string_view content, Contents& into) {
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

std::string read_channel(std::string_view content, const ReadLimits& limits, Contents& into) {
  ByteReader fields(content);
  const std::uint16_t id = fields.u16();
  const std::uint16_t schema = fields.u16();
  Channel channel;
  channel.topic = fields.text();
  (void)fields.text();  // the encoding: the reader of the topic knows what it expects
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

std::string read_message(std::string_view content, Contents& into) {
  ByteReader fields(content);
  const std::uint16_t channel = fields.u16();
  Message message;
  message.sequence = fields.u32();
  const auto log_time = to_time(fields.u64());
  const auto publish_time = to_time(fields.u64());
  if (!fields.ok()) return "a message record is cut short";
  if (into.skipped.contains(channel)) return {};
  const auto known = into.channels.find(channel);
  if (known == into.channels.end()) {
    return "a message names channel " + std::to_string(channel) + ", which is not there";
  }
  if (!log_time || !publish_time) return "a message has a time beyond the year 2262";
  message.topic = known->second.topic;
  message.log_time = *log_time;
  message.publish_time = *publish_time;
  message.data = fields.rest();
  into.bytes += sizeof(Message) + message.topic.size() + message.data.size();
  into.messages.push_back(std::move(message));
  return {};
}

std::string read_definition_or_message(const RawRecord& record, const ReadLimits& limits,
                                       Contents& into) {
  switch (record.op) {
    case Op::Schema:
      return read_schema(record.content, into);
    case Op::Channel:
      return read_channel(record.content, limits, into);
    case Op::Message:
      return read_message(record.content, into);
    default:
      return {};  // unknown or of no interest: skipped, as the format asks
  }
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
    return fail(ErrorCode::Unsupported, "chunk", "its compression is neither zstd nor none");
  }
  const auto stated = ZSTD_getFrameContentSize(chunk.packed.data(), chunk.packed.size());
  if (stated == ZSTD_CONTENTSIZE_ERROR ||
      (stated != ZSTD_CONTENTSIZE_UNKNOWN && stated != chunk.size)) {
    return fail(ErrorCode::Malformed, "chunk", "its compressed bytes disagree with its size");
  }
  std::string bytes(static_cast<std::size_t>(chunk.size), '\0');
  const std::size_t got =
      ZSTD_decompress(bytes.data(), bytes.size(), chunk.packed.data(), chunk.packed.size());
  if (ZSTD_isError(got) != 0 || got != bytes.size()) {
    return fail(ErrorCode::Malformed, "chunk", "it does not decompress");
  }
  return bytes;
}

class Reading {
 public:
  explicit Reading(const ReadLimits& limits) : limits_(limits) {}

  Result<Recording> read(std::string_view bytes);

 private:
  bool step(const RawRecord& record);  ///< False: the records of interest are over.
  void read_metadata(std::string_view content);
  std::string read_chunk(std::string_view content);
  void check_end(ByteReader bytes);
  void note(std::string text);
  Recording finish();
  [[nodiscard]] bool over_total() const { return contents_.bytes > limits_.max_total_bytes; }

  const ReadLimits& limits_;
  Contents contents_;
  Recording out_;
  std::size_t chunk_number_ = 0;
};

void Reading::note(std::string text) {
  if (out_.notes.size() + 1 == kMaxNotes) text = "and more is wrong with this file";
  if (out_.notes.size() < kMaxNotes) out_.notes.push_back(std::move(text));
}

std::string Reading::read_chunk(std::string_view content) {
  ByteReader fields(content);
  (void)fields.u64();  // first and last log time: the messages say it themselves
  (void)fields.u64();
  ChunkHead head;
  head.size = fields.u64();
  head.crc = fields.u32();
  head.compression = fields.text();
  head.packed = fields.raw(fields.u64());
  if (!fields.ok()) return "its record is cut short";
  const auto bytes = unpack(head, limits_);
  if (!bytes) return bytes.error().message;
  if (head.crc != 0 && head.crc != mcap::crc32(*bytes)) return "its checksum is wrong";

  const std::size_t kept = contents_.messages.size();
  ByteReader records(*bytes);
  std::string wrong;
  while (wrong.empty() && !records.rest().empty() && !over_total()) {
    const auto record = take_record(records);
    wrong = record ? read_definition_or_message(*record, limits_, contents_)
                   : "a record in it is cut short";
  }
  if (!wrong.empty()) contents_.messages.resize(kept);
  return wrong;
}

void Reading::read_metadata(std::string_view content) {
  ByteReader fields(content);
  const std::string_view name = fields.text();
  auto values = fields.strings();
  if (!fields.ok()) return note("a metadata record is cut short");
  out_.metadata.insert_or_assign(std::string(name), std::move(values));
}

bool Reading::step(const RawRecord& record) {
  switch (record.op) {
    case Op::DataEnd:
    case Op::Footer:
      return false;
    case Op::Metadata:
      read_metadata(record.content);
      return true;
    case Op::Chunk: {
      ++chunk_number_;
      const std::string wrong = read_chunk(record.content);
      if (!wrong.empty()) note("chunk " + std::to_string(chunk_number_) + " left out: " + wrong);
      return !over_total();
    }
    default: {
      const std::string wrong = read_definition_or_message(record, limits_, contents_);
      if (!wrong.empty()) note(wrong);
      return !over_total();
    }
  }
}

/// What follows the data section: summary records, a footer, the magic.  Only whether it is there
/// counts.
void Reading::check_end(ByteReader bytes) {
  bool footer = false;
  while (!footer && bytes.rest() != mcap::kMagic) {
    const auto record = take_record(bytes);
    if (!record) break;
    footer = record->op == Op::Footer;
  }
  out_.truncated = bytes.rest() != mcap::kMagic;
}

Recording Reading::finish() {
  out_.messages = std::move(contents_.messages);
  std::stable_sort(out_.messages.begin(), out_.messages.end(),
                   [](const Message& a, const Message& b) { return a.log_time < b.log_time; });
  for (auto& [id, channel] : contents_.channels) out_.channels.push_back(std::move(channel));
  if (out_.truncated) note("the end is missing; read up to the last complete chunk");
  return std::move(out_);
}

Result<Recording> Reading::read(std::string_view bytes) {
  if (bytes.substr(0, mcap::kMagic.size()) != mcap::kMagic) {
    return fail(ErrorCode::Malformed, "recording", "this is not an MCAP file of version 0");
  }
  ByteReader records(bytes.substr(mcap::kMagic.size()));
  bool more = true;
  while (more) {
    const ByteReader here = records;
    const auto record = take_record(records);
    if (!record) {
      out_.truncated = true;
      break;
    }
    more = step(*record);
    if (!more) check_end(record->op == Op::Footer ? here : records);
  }
  if (over_total()) {
    return fail(ErrorCode::TooLarge, "recording",
                "it unpacks to more than " + std::to_string(limits_.max_total_bytes) + " bytes");
  }
  return finish();
}

Error in_file(Error error, const std::filesystem::path& path) {
  error.context = path.string();
  return error;
}

}  // namespace

Result<Recording> read_recording_bytes(std::string_view bytes, const ReadLimits& limits) {
  if (bytes.size() > limits.max_file_bytes) {
    return fail(ErrorCode::TooLarge, "recording",
                "it has more than " + std::to_string(limits.max_file_bytes) + " bytes");
  }
  return Reading(limits).read(bytes);
}

Result<Recording> read_recording(const std::filesystem::path& path, const ReadLimits& limits) {
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  if (error) {
    const bool absent = error == std::errc::no_such_file_or_directory;
    return fail(absent ? ErrorCode::NotFound : ErrorCode::Io, path.string(),
                "cannot read the recording: " + error.message());
  }
  if (size > limits.max_file_bytes) {
    return fail(ErrorCode::TooLarge, path.string(),
                "it has more than " + std::to_string(limits.max_file_bytes) + " bytes");
  }
  std::ifstream file(path, std::ios::binary);
  std::string bytes(static_cast<std::size_t>(size), '\0');
  if (!file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) {
    return fail(ErrorCode::Io, path.string(), "the recording cannot be read");
  }
  auto recording = read_recording_bytes(bytes, limits);
  if (!recording) return tl::unexpected<Error>(in_file(recording.error(), path));
  return recording;
}

}  // namespace chorus::record
