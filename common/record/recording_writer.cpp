// Writes MCAP.  Schemas and channels go directly into the data section, so that they survive a
// damaged chunk.  Messages go into zstd chunks, each of which is passed to the operating system as
// soon as it is closed.
#include <fcntl.h>
#include <unistd.h>
#include <zstd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>

#include "common/record/mcap_format.h"
#include "common/record/recording.h"

namespace chorus::record {

namespace {

using mcap::ByteWriter;
using mcap::Op;

constexpr int kCompressionLevel = 3;  // zstd's default; packs a frame's JSON to a tenth.
constexpr std::size_t kMaxMessageBytes = 32u << 20;  // Half of our reader's limit for a chunk.
constexpr std::size_t kMaxTextBytes = 16u << 20;     // The limit for a schema, and for metadata.

struct IndexEntry {
  std::uint64_t log_time;
  std::uint64_t offset;
};

/// First and last log time of a chunk or of the file; both zero if it is empty, as the format
/// requires.
struct Span {
  std::uint64_t first = 0;
  std::uint64_t last = 0;
  bool empty = true;

  void add(std::uint64_t t) {
    first = empty ? t : std::min(first, t);
    last = empty ? t : std::max(last, t);
    empty = false;
  }
};

struct Chunk {
  std::string records;
  Span span;
  std::map<std::uint16_t, std::vector<IndexEntry>> index;
};

std::uint64_t to_wire(Timestamp t) { return static_cast<std::uint64_t>(to_unix_ns(t)); }

std::size_t total_bytes(const std::map<std::string, std::string>& values) {
  std::size_t sum = 0;
  for (const auto& [key, value] : values) sum += key.size() + value.size();
  return sum;
}

}  // namespace

struct RecordingWriter::Impl {
  std::filesystem::path path;
  WriterOptions options;
  int file = -1;
  bool closed = false;
  std::optional<Error> failure;  ///< The first IO error; nothing is written after it.
  std::uint64_t offset = 0;      ///< Bytes written so far.
  std::uint64_t unpacked = 0;    ///< Bytes in chunks, before packing.
  std::uint64_t synced = 0;      ///< Bytes that the disk has stored for certain.
  std::uint32_t crc = 0;         ///< CRC of all bytes written.

  std::map<std::pair<std::string, std::string>, std::uint16_t> schema_ids;
  std::vector<std::string> schema_records;
  std::vector<std::string> channel_records;
  std::vector<std::string> chunk_indexes;
  std::vector<std::string> metadata_indexes;
  Chunk chunk;
  Span span;
  std::uint64_t message_count = 0;
  std::map<std::uint16_t, std::uint64_t> channel_counts;

  ~Impl() {
    if (file >= 0) ::close(file);
  }

  Result<void> fail_with(const char* what) {
    failure = Error{ErrorCode::Io, path.string(),
                    std::string("cannot ") + what + " the recording: " + std::strerror(errno)};
    return tl::unexpected<Error>(*failure);
  }

  Result<void> put(std::string_view bytes) {
    if (failure) return tl::unexpected<Error>(*failure);
    crc = mcap::crc32(bytes, crc);
    offset += bytes.size();
    while (!bytes.empty()) {
      const ssize_t count = ::write(file, bytes.data(), bytes.size());
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) return fail_with("write");
      bytes.remove_prefix(static_cast<std::size_t>(count));
    }
    return {};
  }

  Result<void> sync() {
    if (synced == offset) return {};
    if (::fdatasync(file) != 0) return fail_with("sync");
    synced = offset;
    return {};
  }

  Result<void> usable() const {
    if (failure) return tl::unexpected<Error>(*failure);
    if (closed) return fail(ErrorCode::Conflict, path.string(), "the recording is closed already");
    return {};
  }

  Result<void> acceptable(std::uint16_t channel, const Message& message) const;
  bool chunk_is_full_for(const Message& message) const;
  Result<std::uint16_t> schema_id(const Channel& channel);
  std::string message_indexes(std::uint64_t start, ByteWriter& offsets) const;
  Result<void> close_chunk();
  std::string statistics() const;
  Result<void> write_summary();
};

Result<std::uint16_t> RecordingWriter::Impl::schema_id(const Channel& channel) {
  if (channel.schema_json.empty()) return std::uint16_t{0};
  const auto key = std::pair(channel.schema_name, channel.schema_json);
  if (const auto known = schema_ids.find(key); known != schema_ids.end()) return known->second;
  const auto id = static_cast<std::uint16_t>(schema_ids.size() + 1);
  ByteWriter fields;
  fields.u16(id).text(channel.schema_name).text("jsonschema").text(channel.schema_json);
  schema_records.push_back(mcap::record(Op::Schema, fields.bytes()));
  if (auto ok = put(schema_records.back()); !ok) return pass(ok);
  schema_ids.emplace(key, id);
  return id;
}

/// Returns the message indexes of the chunk, and writes into `offsets` where each will be in the
/// file.
std::string RecordingWriter::Impl::message_indexes(std::uint64_t start, ByteWriter& offsets) const {
  std::string bytes;
  for (const auto& [channel, entries] : chunk.index) {
    offsets.u16(channel).u64(start + bytes.size());
    ByteWriter list;
    for (const IndexEntry& e : entries) list.u64(e.log_time).u64(e.offset);
    bytes += mcap::record(Op::MessageIndex, ByteWriter().u16(channel).text(list.bytes()).bytes());
  }
  return bytes;
}

Result<void> RecordingWriter::Impl::close_chunk() {
  if (chunk.span.empty) return {};
  std::string packed(ZSTD_compressBound(chunk.records.size()), '\0');
  const std::size_t size = ZSTD_compress(packed.data(), packed.size(), chunk.records.data(),
                                         chunk.records.size(), kCompressionLevel);
  if (ZSTD_isError(size) != 0) {
    return fail(ErrorCode::Internal, path.string(), ZSTD_getErrorName(size));
  }
  packed.resize(size);
  ByteWriter fields;
  fields.u64(chunk.span.first).u64(chunk.span.last).u64(chunk.records.size());
  fields.u32(mcap::crc32(chunk.records)).text("zstd").u64(packed.size()).raw(packed);
  const std::string body = mcap::record(Op::Chunk, fields.bytes());

  ByteWriter offsets;
  const std::string indexes = message_indexes(offset + body.size(), offsets);
  ByteWriter entry;
  entry.u64(chunk.span.first).u64(chunk.span.last).u64(offset).u64(body.size());
  entry.text(offsets.bytes()).u64(indexes.size()).text("zstd");
  entry.u64(packed.size()).u64(chunk.records.size());
  chunk_indexes.push_back(mcap::record(Op::ChunkIndex, entry.bytes()));
  unpacked += chunk.records.size();
  chunk = {};
  return put(body + indexes);
}

std::string RecordingWriter::Impl::statistics() const {
  ByteWriter counts;
  for (const auto& [channel, count] : channel_counts) counts.u16(channel).u64(count);
  const auto u32 = [](std::size_t n) { return static_cast<std::uint32_t>(n); };
  ByteWriter fields;
  fields.u64(message_count).u16(static_cast<std::uint16_t>(schema_records.size()));
  fields.u32(u32(channel_records.size())).u32(0).u32(u32(metadata_indexes.size()));
  fields.u32(u32(chunk_indexes.size())).u64(span.first).u64(span.last).text(counts.bytes());
  return mcap::record(Op::Statistics, fields.bytes());
}

Result<void> RecordingWriter::Impl::write_summary() {
  const std::vector<std::string> statistics_records{statistics()};
  const std::vector<std::pair<Op, const std::vector<std::string>*>> groups{
      {Op::Schema, &schema_records},
      {Op::Channel, &channel_records},
      {Op::ChunkIndex, &chunk_indexes},
      {Op::MetadataIndex, &metadata_indexes},
      {Op::Statistics, &statistics_records}};
  const std::uint64_t summary_start = offset;
  std::string summary;
  std::string offsets;
  for (const auto& [op, records] : groups) {
    const std::size_t before = summary.size();
    for (const std::string& one : *records) summary += one;
    if (summary.size() == before) continue;
    ByteWriter fields;
    fields.u8(static_cast<std::uint8_t>(op)).u64(summary_start + before);
    offsets += mcap::record(Op::SummaryOffset, fields.u64(summary.size() - before).bytes());
  }
  // The CRC of the summary also covers the footer, up to the CRC field.
  ByteWriter footer;
  footer.u8(static_cast<std::uint8_t>(Op::Footer)).u64(8 + 8 + 4);
  footer.u64(summary_start).u64(summary_start + summary.size());
  std::string end = summary + offsets + footer.bytes();
  end += ByteWriter().u32(mcap::crc32(end)).raw(mcap::kMagic).bytes();
  return put(end);
}

RecordingWriter::RecordingWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
RecordingWriter::RecordingWriter(RecordingWriter&&) noexcept = default;
RecordingWriter& RecordingWriter::operator=(RecordingWriter&& other) noexcept {
  if (this != &other) {
    if (impl_) (void)close();
    impl_ = std::move(other.impl_);
  }
  return *this;
}
RecordingWriter::~RecordingWriter() {
  if (impl_) (void)close();
}

Result<RecordingWriter> RecordingWriter::create(const std::filesystem::path& path,
                                                const WriterOptions& options) {
  auto impl = std::make_unique<Impl>();
  impl->path = path;
  impl->options = options;
  impl->file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  if (impl->file < 0) {
    const ErrorCode code = errno == EEXIST ? ErrorCode::Conflict : ErrorCode::Io;
    return fail(code, path.string(),
                std::string("cannot create the recording: ") + std::strerror(errno));
  }
  const std::string header = ByteWriter().text("").text(options.library).bytes();
  const auto ok = impl->put(std::string(mcap::kMagic) + mcap::record(Op::Header, header));
  if (!ok) return pass(ok);
  return RecordingWriter(std::move(impl));
}

Result<std::uint16_t> RecordingWriter::add_channel(const Channel& channel) {
  if (auto ok = impl_->usable(); !ok) return pass(ok);
  if (channel.topic.empty()) {
    return fail(ErrorCode::InvalidArgument, impl_->path.string(), "a channel needs a topic");
  }
  if (channel.schema_json.size() + total_bytes(channel.metadata) > kMaxTextBytes ||
      impl_->channel_records.size() >= std::numeric_limits<std::uint16_t>::max() - 1u) {
    return fail(ErrorCode::TooLarge, channel.topic,
                "the schema or metadata is too long, or there "
                "are too many channels");
  }
  const auto schema = impl_->schema_id(channel);
  if (!schema) return schema;
  const auto id = static_cast<std::uint16_t>(impl_->channel_records.size() + 1);
  ByteWriter fields;
  fields.u16(id).u16(*schema).text(channel.topic).text("json").strings(channel.metadata);
  impl_->channel_records.push_back(mcap::record(Op::Channel, fields.bytes()));
  if (auto ok = impl_->put(impl_->channel_records.back()); !ok) return pass(ok);
  return id;
}

Result<void> RecordingWriter::Impl::acceptable(std::uint16_t channel,
                                               const Message& message) const {
  if (auto ok = usable(); !ok) return ok;
  if (channel == 0 || channel > channel_records.size()) {
    return fail(ErrorCode::InvalidArgument, path.string(), "add_channel() gave no such channel");
  }
  if (to_unix_ns(message.log_time) < 0 || to_unix_ns(message.publish_time) < 0) {
    return fail(ErrorCode::InvalidArgument, path.string(), "times before 1970 are not recorded");
  }
  if (message.data.size() > kMaxMessageBytes) {
    return fail(ErrorCode::TooLarge, path.string(), "a message may have at most 32 MiB");
  }
  return {};
}

bool RecordingWriter::Impl::chunk_is_full_for(const Message& message) const {
  Span with = chunk.span;
  with.add(to_wire(message.log_time));
  const auto longest = std::max(Duration{0}, options.chunk_duration).count();
  return with.last - with.first > static_cast<std::uint64_t>(longest) ||
         chunk.records.size() + message.data.size() > options.chunk_bytes;
}

Result<void> RecordingWriter::write(std::uint16_t channel, const Message& message) {
  Impl& out = *impl_;
  if (auto ok = out.acceptable(channel, message); !ok) return ok;
  if (out.chunk_is_full_for(message)) {
    if (auto ok = out.close_chunk(); !ok) return ok;
  }
  const std::uint64_t log_time = to_wire(message.log_time);
  out.chunk.index[channel].push_back({log_time, out.chunk.records.size()});
  ByteWriter fields;
  fields.u16(channel).u32(message.sequence).u64(log_time).u64(to_wire(message.publish_time));
  out.chunk.records += mcap::record(Op::Message, fields.raw(message.data).bytes());
  out.chunk.span.add(log_time);
  out.span.add(log_time);
  ++out.message_count;
  ++out.channel_counts[channel];
  return {};
}

Result<void> RecordingWriter::write_metadata(const std::string& name,
                                             const std::map<std::string, std::string>& values) {
  if (auto ok = impl_->usable(); !ok) return ok;
  if (name.size() + total_bytes(values) > kMaxTextBytes) {
    return fail(ErrorCode::TooLarge, name, "metadata may have at most 16 MiB");
  }
  const std::string bytes =
      mcap::record(Op::Metadata, ByteWriter().text(name).strings(values).bytes());
  ByteWriter entry;
  entry.u64(impl_->offset).u64(bytes.size()).text(name);
  impl_->metadata_indexes.push_back(mcap::record(Op::MetadataIndex, entry.bytes()));
  return impl_->put(bytes);
}

Result<void> RecordingWriter::flush() {
  if (auto ok = impl_->usable(); !ok) return ok;
  return impl_->close_chunk();
}

Result<void> RecordingWriter::sync() {
  if (auto ok = impl_->usable(); !ok) return ok;
  return impl_->sync();
}

std::uint64_t RecordingWriter::bytes() const { return impl_->offset; }
std::uint64_t RecordingWriter::unpacked_bytes() const { return impl_->unpacked; }

Result<void> RecordingWriter::close() {
  if (impl_->closed) return {};
  if (auto ok = impl_->usable(); !ok) return ok;
  impl_->closed = true;
  if (auto ok = impl_->close_chunk(); !ok) return ok;
  const std::string data_end = ByteWriter().u32(impl_->crc).bytes();
  if (auto ok = impl_->put(mcap::record(Op::DataEnd, data_end)); !ok) return ok;
  if (auto ok = impl_->write_summary(); !ok) return ok;
  if (auto ok = impl_->sync(); !ok) return ok;
  const int file = std::exchange(impl_->file, -1);
  if (::close(file) != 0) return impl_->fail_with("close");
  return {};
}

}  // namespace chorus::record
