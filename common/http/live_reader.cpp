#include "common/http/live_reader.h"

#include <utility>

#include "common/base/parse.h"
#include "common/http/uri.h"

namespace chorus::http {
namespace {

constexpr double kSlowest = 0.1;     // [Hz]
constexpr double kFastest = 1000.0;  // [Hz]; no output is faster.

Result<Duration> interval_of(const std::string& text) {
  const auto rate = parse_number<double>(text);
  if (rate && *rate >= kSlowest && *rate <= kFastest) return from_seconds(1.0 / *rate);
  return fail(ErrorCode::InvalidArgument, "max_rate",
              "a number from 0.1 to 1000 [Hz], such as max_rate=15");
}

/// A message and what its characters belong to.
struct Message {
  DocumentPtr document = {};
  std::string text = {};
  std::string_view view = {};
};

std::shared_ptr<const std::string_view> view_of(const std::shared_ptr<Message>& message) {
  return {message, &message->view};
}

}  // namespace

Result<LiveWish> live_wish_of(const RequestHead& head) {
  LiveWish wish;
  if (!head.query.empty()) {
    auto query = decode_query(head.query);
    if (!query) return pass(query);
    for (const char* key : {"profile", "form"}) {
      if (const auto found = query->find(key); found != query->end()) wish.form = found->second;
    }
    if (const auto after = query->find("after"); after != query->end())
      wish.last_id = after->second;
    if (const auto rate = query->find("max_rate"); rate != query->end()) {
      const auto interval = interval_of(rate->second);
      if (!interval) return pass(interval);
      wish.interval = *interval;
    }
  }
  if (!head.last_event_id.empty()) wish.last_id = std::string(head.last_event_id);
  return wish;
}

LiveReader::LiveReader(const Router::Entry& entry, LiveWish wish)
    : entry_(&entry), wish_(std::move(wish)) {
  last_event_ = parse_number<std::uint64_t>(wish_.last_id).value_or(0);
  if (entry.log || wish_.last_id.empty()) return;
  // A reader that reconnects and already has the newest version waits for the next one.
  const auto current = entry.live->current();
  if (current && current->options().version == wish_.last_id) shown_ = current;
}

/// The newest version, unless the reader has it or has to wait for it.
DocumentPtr LiveReader::next(SteadyTime now, DocumentPtr newest) {
  held_ = now < not_before_;
  if (held_) return nullptr;
  if (!newest) newest = entry_->live->current();
  if (!newest || newest == shown_) return nullptr;
  shown_ = newest;
  const auto interval = std::chrono::duration_cast<SteadyTime::duration>(wish_.interval);
  // From when it was due, so that versions that come a little late do not lower the rate.
  not_before_ = (now - not_before_ < interval ? not_before_ : now) + interval;
  return newest;
}

std::optional<LoggedEvents::One> LiveReader::next_logged() {
  auto next = entry_->log->after(last_event_);
  if (next) last_event_ = next->id;
  return next;
}

std::shared_ptr<const std::string> LiveReader::event(std::string_view media_type, Coding coding,
                                                     SteadyTime now, DocumentPtr newest) {
  if (!entry_->log) {
    const DocumentPtr document = next(now, std::move(newest));
    return document ? document->event(media_type, wish_.form, coding) : nullptr;
  }
  const auto next = next_logged();
  if (!next) return nullptr;
  const std::string text = "id: " + std::to_string(next->id) + "\ndata: " + next->json + "\n\n";
  return std::make_shared<const std::string>(coding == Coding::Gzip ? gzip_piece(text) : text);
}

std::shared_ptr<const std::string_view> LiveReader::message(SteadyTime now, DocumentPtr newest) {
  constexpr std::string_view kJson = "application/json";
  if (entry_->log) {
    auto next = next_logged();
    if (!next) return nullptr;
    const auto kept = std::make_shared<Message>();
    kept->text = std::move(next->json);
    kept->view = kept->text;
    return view_of(kept);
  }
  const auto kept = std::make_shared<Message>();
  kept->document = next(now, std::move(newest));
  if (!kept->document) return nullptr;
  const auto chosen = kept->document->choose(kJson, wish_.form);
  if (!chosen) return nullptr;  // This version cannot be had in JSON: nothing is sent.
  kept->view = (*chosen)->body();
  return view_of(kept);
}

bool LiveReader::has_more() const { return entry_->log && entry_->log->after(last_event_); }

std::optional<SteadyTime> LiveReader::held_until() const {
  return held_ ? std::optional(not_before_) : std::nullopt;
}

}  // namespace chorus::http
