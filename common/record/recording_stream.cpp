#include "common/record/recording_stream.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

#include "common/record/recording_outline.h"

namespace chorus::record {
namespace {

using mcap::Op;

/// A piece in memory, with its messages in log-time order.
struct Loaded {
  std::string bytes;
  std::vector<RawMessage> messages;
  std::size_t next = 0;
  /// Among messages with equal times, those of the piece with the lower number come first.
  std::size_t order = 0;

  [[nodiscard]] Timestamp due() const { return messages[next].log_time; }
};

/// The pieces in memory; on top is the one whose message is due first.
class Active {
 public:
  [[nodiscard]] bool empty() const { return heap_.empty(); }
  [[nodiscard]] Timestamp due() const { return heap_.front()->due(); }
  void push(std::unique_ptr<Loaded> piece) {
    heap_.push_back(std::move(piece));
    std::ranges::push_heap(heap_, kLaterDue);
  }
  [[nodiscard]] std::unique_ptr<Loaded> pop() {
    std::ranges::pop_heap(heap_, kLaterDue);
    auto first = std::move(heap_.back());
    heap_.pop_back();
    return first;
  }
  void clear() { heap_.clear(); }

 private:
  static constexpr auto kLaterDue = [](const auto& a, const auto& b) {
    return std::tuple(a->due(), a->order) > std::tuple(b->due(), b->order);
  };
  std::vector<std::unique_ptr<Loaded>> heap_;
};

}  // namespace

struct RecordingStream::Impl {
  Impl(std::unique_ptr<ByteSource> from, const ReadLimits& l)
      : source(std::move(from)), limits(l) {}

  static Result<std::unique_ptr<Impl>> make(std::unique_ptr<ByteSource> source,
                                            const ReadLimits& limits);
  /// Loads a piece; null when nothing in it is wanted or usable.
  std::unique_ptr<Loaded> load(std::size_t piece);
  std::string read_records(Loaded& into, bool chunk);
  std::string read_one(const RawRecord& record, Loaded& into);
  [[nodiscard]] bool may_hold(const Piece& piece, std::string_view topic) const;
  [[nodiscard]] bool unwanted(const Piece& piece) const;
  std::optional<Message> found_in(std::size_t number, std::string_view topic, bool last);
  Result<void> load_what_is_due();
  void drop_current();
  MessageView view(const RawMessage& message) const;

  std::unique_ptr<ByteSource> source;
  ReadLimits limits;
  Outline outline;
  std::vector<std::size_t> order;  ///< The pieces' indices, by first log time.
  std::size_t next_piece = 0;      ///< Index into `order`.
  Active active;
  std::uintmax_t active_bytes = 0;
  std::unique_ptr<Loaded> current;  ///< Contains the message that was returned last.
};

Result<std::unique_ptr<RecordingStream::Impl>> RecordingStream::Impl::make(
    std::unique_ptr<ByteSource> source, const ReadLimits& limits) {
  auto impl = std::make_unique<Impl>(std::move(source), limits);
  auto outline = outline_of(*impl->source, impl->limits);
  if (!outline) return pass(outline);
  impl->outline = std::move(*outline);
  impl->order.resize(impl->outline.pieces.size());
  std::iota(impl->order.begin(), impl->order.end(), std::size_t{0});
  std::ranges::stable_sort(impl->order, {},
                           [&](std::size_t i) { return impl->outline.pieces[i].first; });
  return impl;
}

/// Returns "" or what is wrong.  A chunk is used completely or not at all.
std::string RecordingStream::Impl::read_records(Loaded& into, bool chunk) {
  mcap::ByteReader records(into.bytes);
  while (!records.rest().empty()) {
    const auto record = take_record(records);
    std::string wrong = record ? read_one(*record, into) : "a record in it is cut short";
    if (!wrong.empty() && chunk) return wrong;
    if (!wrong.empty()) add_note(outline.notes, std::move(wrong));
  }
  return {};
}

std::string RecordingStream::Impl::read_one(const RawRecord& record, Loaded& into) {
  switch (record.op) {
    case Op::Schema:
      return read_schema(record.content, outline.definitions);
    case Op::Channel:
      return read_channel(record.content, limits, outline.definitions);
    case Op::Message: {
      std::optional<RawMessage> message;
      std::string wrong = read_message(record.content, outline.definitions, message);
      if (message) into.messages.push_back(*message);
      return wrong;
    }
    default:
      // Unknown kinds are skipped, because later versions may add some; zero will never be a kind.
      return record.op == Op{} ? "it holds zeros where a record should be" : std::string{};
  }
}

/// True when all messages of the piece are on channels that are known and not wanted.
bool RecordingStream::Impl::unwanted(const Piece& piece) const {
  return piece.counts && std::ranges::all_of(*piece.counts, [this](const auto& entry) {
           return outline.definitions.skipped.contains(entry.first);
         });
}

bool RecordingStream::Impl::may_hold(const Piece& piece, std::string_view topic) const {
  const auto& channels = outline.definitions.channels;
  return !piece.counts || std::ranges::any_of(*piece.counts, [&](const auto& entry) {
    const auto channel = channels.find(entry.first);
    return channel == channels.end() || channel->second.topic == topic;
  });
}

std::unique_ptr<Loaded> RecordingStream::Impl::load(std::size_t number) {
  const Piece& piece = outline.pieces[number];
  auto loaded = std::make_unique<Loaded>();
  loaded->order = number;
  loaded->bytes = source->read(piece.offset, static_cast<std::size_t>(piece.length));
  std::string wrong;
  if (loaded->bytes.size() < piece.length) wrong = "the disk does not give it";
  if (wrong.empty() && piece.chunk > 0) {
    auto unpacked = unpack_chunk(loaded->bytes, limits);
    if (unpacked) loaded->bytes = std::move(*unpacked);
    if (!unpacked) wrong = unpacked.error().message;
  }
  if (wrong.empty()) wrong = read_records(*loaded, piece.chunk > 0);
  if (!wrong.empty()) {
    const std::string what =
        piece.chunk > 0 ? "chunk " + std::to_string(piece.chunk) : "a row of messages";
    add_note(outline.notes, what + " left out: " + wrong);
    return nullptr;
  }
  std::ranges::stable_sort(loaded->messages, {}, &RawMessage::log_time);
  return loaded->messages.empty() ? nullptr : std::move(loaded);
}

Result<void> RecordingStream::Impl::load_what_is_due() {
  while (next_piece < order.size()) {
    const Piece& piece = outline.pieces[order[next_piece]];
    const bool due =
        active.empty() || piece.first <= static_cast<std::uint64_t>(to_unix_ns(active.due()));
    if (!due) return {};
    const std::size_t number = order[next_piece++];
    if (unwanted(piece)) continue;
    auto loaded = load(number);
    if (outline.definitions.bytes + active_bytes > limits.max_total_bytes)
      return tl::unexpected<Error>(over_total(limits));
    if (!loaded) continue;
    active_bytes += loaded->bytes.size();
    active.push(std::move(loaded));
  }
  return {};
}

void RecordingStream::Impl::drop_current() {
  if (!current) return;
  if (++current->next < current->messages.size()) return active.push(std::move(current));
  active_bytes -= current->bytes.size();
  current.reset();
}

MessageView RecordingStream::Impl::view(const RawMessage& message) const {
  return {outline.definitions.channels.at(message.channel).topic, message.sequence,
          message.log_time, message.publish_time, message.data};
}

/// The first or the last message of a topic within a piece.
std::optional<Message> RecordingStream::Impl::found_in(std::size_t number, std::string_view topic,
                                                       bool last) {
  if (!may_hold(outline.pieces[number], topic)) return std::nullopt;
  const auto loaded = load(number);
  if (!loaded) return std::nullopt;
  if (last) std::ranges::reverse(loaded->messages);
  for (const RawMessage& message : loaded->messages) {
    const MessageView found = view(message);
    if (found.topic == topic) return found.copy();
  }
  return std::nullopt;
}

RecordingStream::RecordingStream(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
RecordingStream::RecordingStream(RecordingStream&&) noexcept = default;
RecordingStream& RecordingStream::operator=(RecordingStream&&) noexcept = default;
RecordingStream::~RecordingStream() = default;

Result<RecordingStream> RecordingStream::open(const std::filesystem::path& path,
                                              const ReadLimits& limits) {
  auto source = open_bytes(path);
  if (!source) return pass(source);
  auto impl = Impl::make(std::move(*source), limits);
  if (impl) return RecordingStream(std::move(*impl));
  Error error = impl.error();
  error.context = path.string();
  return tl::unexpected<Error>(std::move(error));
}

Result<RecordingStream> RecordingStream::of_bytes(std::string_view bytes,
                                                  const ReadLimits& limits) {
  auto impl = Impl::make(bytes_in_memory(bytes), limits);
  if (!impl) return pass(impl);
  return RecordingStream(std::move(*impl));
}

Result<std::optional<MessageView>> RecordingStream::next() {
  Impl& in = *impl_;
  in.drop_current();
  if (auto ok = in.load_what_is_due(); !ok) return pass(ok);
  if (in.active.empty()) return std::nullopt;
  in.current = in.active.pop();
  return in.view(in.current->messages[in.current->next]);
}

void RecordingStream::rewind(std::optional<Timestamp> from) {
  Impl& in = *impl_;
  in.current.reset();
  in.active.clear();
  in.active_bytes = 0;
  in.next_piece = 0;
  if (!from) return;
  const auto instant = static_cast<std::uint64_t>(std::max<std::int64_t>(0, to_unix_ns(*from)));
  while (in.next_piece < in.order.size() &&
         in.outline.pieces[in.order[in.next_piece]].last < instant) {
    ++in.next_piece;
  }
}

std::optional<Message> RecordingStream::first_of(std::string_view topic) {
  for (const std::size_t number : impl_->order) {
    if (auto found = impl_->found_in(number, topic, false)) return found;
  }
  return std::nullopt;
}

std::optional<Message> RecordingStream::last_of(std::string_view topic) {
  std::vector<std::size_t> latest_first(impl_->order);
  std::ranges::stable_sort(latest_first, std::ranges::greater{},
                           [&](std::size_t i) { return impl_->outline.pieces[i].last; });
  for (const std::size_t number : latest_first) {
    if (auto found = impl_->found_in(number, topic, true)) return found;
  }
  return std::nullopt;
}

void RecordingStream::each_of(std::string_view topic,
                              const std::function<bool(const MessageView&)>& take) {
  for (const std::size_t number : impl_->order) {
    if (!impl_->may_hold(impl_->outline.pieces[number], topic)) continue;
    const auto loaded = impl_->load(number);
    if (!loaded) continue;
    for (const RawMessage& message : loaded->messages) {
      const MessageView found = impl_->view(message);
      if (found.topic == topic && !take(found)) return;
    }
  }
}

std::optional<std::uint64_t> RecordingStream::count(std::string_view topic) const {
  std::uint64_t sum = 0;
  for (const Piece& piece : impl_->outline.pieces) {
    if (!piece.counts) return std::nullopt;
    for (const auto& [id, messages] : *piece.counts) {
      const auto channel = impl_->outline.definitions.channels.find(id);
      if (channel == impl_->outline.definitions.channels.end()) return std::nullopt;
      if (channel->second.topic == topic) sum += messages;
    }
  }
  return sum;
}

std::vector<Channel> RecordingStream::channels() const {
  std::vector<Channel> all;
  for (const auto& [id, channel] : impl_->outline.definitions.channels) all.push_back(channel);
  return all;
}

const std::map<std::string, std::map<std::string, std::string>>& RecordingStream::metadata() const {
  return impl_->outline.metadata;
}

bool RecordingStream::truncated() const { return impl_->outline.truncated; }
const std::vector<std::string>& RecordingStream::notes() const { return impl_->outline.notes; }

}  // namespace chorus::record
