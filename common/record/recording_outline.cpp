#include "common/record/recording_outline.h"

#include <algorithm>
#include <utility>

namespace chorus::record {
namespace {

using mcap::ByteReader;
using mcap::Op;

constexpr std::uint64_t kMaxRun = 1U << 20;  // Largest piece of messages outside chunks [bytes].

class Scan {
 public:
  Scan(const ByteSource& source, const ReadLimits& limits)
      : source_(source), limits_(limits), walk_(source, 0) {}

  Result<Outline> run() {
    if (walk_.peek(mcap::kMagic.size()) != mcap::kMagic) {
      return fail(
          ErrorCode::Malformed, "recording",
          "this is not an MCAP file of version 0; files of other kinds become recordings with "
          "chorus import");
    }
    walk_.skip(mcap::kMagic.size());
    while (step()) {
      if (out_.definitions.bytes > limits_.max_total_bytes)
        return tl::unexpected<Error>(over_total(limits_));
    }
    // What was cut off after the last chunk may have included a part of that chunk's index.
    if (out_.truncated && indexing_) out_.pieces.back().counts.reset();
    if (out_.truncated)
      add_note(out_.notes, "the end is missing; read up to the last complete chunk");
    return std::move(out_);
  }

 private:
  struct Head {
    Op op;
    std::uint64_t length;
  };

  std::optional<Head> peek_head() {
    const std::string_view bytes = walk_.peek(mcap::kRecordHead);
    ByteReader fields(bytes);
    const auto op = static_cast<Op>(fields.u8());
    const std::uint64_t length = fields.u64();
    if (!fields.ok() || length > walk_.left() - mcap::kRecordHead) return std::nullopt;
    return Head{op, length};
  }

  bool step() {
    const auto head = peek_head();
    if (!head) {
      out_.truncated = true;
      return false;
    }
    if (head->op == Op::DataEnd || head->op == Op::Footer) {
      check_end();
      return false;
    }
    indexing_ = indexing_ && head->op == Op::MessageIndex;
    const std::uint64_t begin = walk_.at();
    walk_.skip(mcap::kRecordHead);
    take(*head, begin);
    walk_.skip(begin + mcap::kRecordHead + head->length - walk_.at());
    return true;
  }

  void take(const Head& head, std::uint64_t begin) {
    switch (head.op) {
      case Op::Chunk:
        return begin_chunk(head.length);
      case Op::MessageIndex:
        return count_messages(head.length);
      case Op::Message:
        return begin_or_extend_run(begin, head.length);
      case Op::Schema:
      case Op::Channel:
      case Op::Metadata:
        return define(head);
      default:
        return;  // Unknown or irrelevant kinds are skipped, as the format requires.
    }
  }

  void begin_chunk(std::uint64_t length) {
    constexpr std::size_t kTimes = 8 + 8;
    Piece piece{walk_.at(), length, 0, 0, ++chunks_, {}};
    ByteReader fields(walk_.peek(std::min<std::uint64_t>(kTimes, length)));
    piece.first = fields.u64();
    piece.last = fields.u64();
    out_.pieces.push_back(std::move(piece));
    indexing_ = true;
  }

  void count_messages(std::uint64_t length) {
    constexpr std::uint64_t kEntry = 8 + 8;
    constexpr std::uint64_t kFields = 2 + 4;
    ByteReader fields(walk_.peek(std::min(kFields, length)));
    const std::uint16_t channel = fields.u16();
    const std::uint32_t bytes = fields.u32();
    if (!indexing_ || !fields.ok() || bytes > length - kFields) return;
    auto& counts = out_.pieces.back().counts;
    if (!counts) counts.emplace();
    (*counts)[channel] += bytes / kEntry;
  }

  void begin_or_extend_run(std::uint64_t begin, std::uint64_t length) {
    constexpr std::size_t kFields = 2 + 4 + 8;
    ByteReader fields(walk_.peek(std::min<std::uint64_t>(kFields, length)));
    (void)fields.u16();
    (void)fields.u32();
    const std::uint64_t logged = fields.u64();
    const std::uint64_t size = mcap::kRecordHead + length;
    auto& pieces = out_.pieces;
    const bool follows = !pieces.empty() && pieces.back().chunk == 0 &&
                         pieces.back().offset + pieces.back().length == begin &&
                         pieces.back().length + size <= kMaxRun;
    if (!follows) pieces.push_back({begin, 0, logged, logged, 0, {}});
    pieces.back().length += size;
    pieces.back().first = std::min(pieces.back().first, logged);
    pieces.back().last = std::max(pieces.back().last, logged);
  }

  void define(const Head& head) {
    if (head.length > limits_.max_chunk_bytes)
      return add_note(out_.notes, "a definition is too long to be read");
    const std::string content = source_.read(walk_.at(), static_cast<std::size_t>(head.length));
    std::string wrong;
    if (head.op == Op::Schema) wrong = read_schema(content, out_.definitions);
    if (head.op == Op::Channel) wrong = read_channel(content, limits_, out_.definitions);
    if (head.op == Op::Metadata) wrong = read_metadata(content);
    if (!wrong.empty()) add_note(out_.notes, std::move(wrong));
  }

  std::string read_metadata(std::string_view content) {
    ByteReader fields(content);
    const std::string_view name = fields.text();
    auto values = fields.strings();
    if (!fields.ok()) return "a metadata record is cut short";
    out_.definitions.bytes += content.size();
    out_.metadata.insert_or_assign(std::string(name), std::move(values));
    return {};
  }

  /// Summary records, a footer and the magic should follow the data section; checks only that they
  /// are there.
  void check_end() {
    for (auto head = peek_head(); head; head = peek_head()) {
      walk_.skip(mcap::kRecordHead + head->length);
      if (head->op == Op::Footer || walk_.peek(mcap::kMagic.size() + 1) == mcap::kMagic) break;
    }
    out_.truncated = walk_.peek(mcap::kMagic.size() + 1) != mcap::kMagic;
  }

  const ByteSource& source_;
  const ReadLimits& limits_;
  ByteWalk walk_;
  Outline out_;
  std::size_t chunks_ = 0;
  bool indexing_ = false;  ///< True while only message indexes have followed the last chunk.
};

}  // namespace

Result<Outline> outline_of(const ByteSource& source, const ReadLimits& limits) {
  return Scan(source, limits).run();
}

Error over_total(const ReadLimits& limits) {
  return {ErrorCode::TooLarge, "recording",
          "it unpacks to more than " + std::to_string(limits.max_total_bytes) + " bytes"};
}

void add_note(std::vector<std::string>& notes, std::string text) {
  if (std::ranges::find(notes, text) != notes.end()) return;
  if (notes.size() + 1 == kMaxNotes) text = "and more is wrong with this file";
  if (notes.size() < kMaxNotes) notes.push_back(std::move(text));
}

}  // namespace chorus::record
