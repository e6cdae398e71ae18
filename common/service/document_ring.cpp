#include "common/service/document_ring.h"

#include <algorithm>
#include <utility>

#include "common/base/parse.h"

namespace chorus::service {
namespace {

/// Who computes with seconds since 1970 as doubles cannot name an instant better than to 0.24 us.
constexpr Duration kSameInstant = std::chrono::microseconds(1);

/// What to say about a number with a point, as programs write seconds; empty if it is none.
std::string instant_in_seconds(const std::string& text) {
  const auto value = parse_number<double>(text);
  if (!value) return {};
  return "looks like seconds since 1970; give nanoseconds, a whole number: " +
         std::to_string(static_cast<long long>(std::clamp(*value, -9e9, 9e9) * 1e9));
}

Result<Timestamp> parse_instant(const std::string& text, const std::string& where) {
  const auto ns = parse_number<std::int64_t>(text);
  const std::string hint = ns ? "" : instant_in_seconds(text);
  // No frame is of the first days of 1970; small numbers are seconds or milliseconds.
  constexpr std::int64_t kLeast = 1'000'000'000'000'000;
  if (ns && *ns > -kLeast && *ns < kLeast)
    return fail(ErrorCode::InvalidArgument, where,
                "is in nanoseconds since 1970, which would be in that year; in seconds or "
                "milliseconds? Multiply by 1000000000 or 1000000");
  if (ns) return from_unix_ns(*ns);
  auto parsed = parse_iso8601(text);
  if (parsed) return parsed;
  if (!hint.empty()) return fail(ErrorCode::InvalidArgument, where, hint);
  return fail(ErrorCode::InvalidArgument, where,
              "give the instant as UTC, 2026-11-21T07:30:00.25Z, or in nanoseconds since 1970");
}

}  // namespace

void DocumentRing::push(Document document) {
  const std::scoped_lock lock(mutex_);
  if (!documents_.empty() && document.captured <= documents_.back().first.captured)
    documents_.clear();
  const Timestamp oldest = document.captured - history_.span;
  documents_.push_back({document, document});
  while (documents_.size() > history_.most || documents_.front().first.captured <= oldest) {
    documents_.pop_front();
  }
}

void DocumentRing::amend(Document document) {
  const std::scoped_lock lock(mutex_);
  const auto it = std::lower_bound(
      documents_.begin(), documents_.end(), document.captured,
      [](const Kept& kept, Timestamp wanted) { return kept.first.captured < wanted; });
  if (it == documents_.end() || it->first.captured != document.captured) return;
  it->better = std::move(document);
  ++amendments_;
}

std::uint64_t DocumentRing::amendments() const {
  const std::scoped_lock lock(mutex_);
  return amendments_;
}

Result<Document> DocumentRing::find(std::string_view sequence) const {
  const std::string where = "/" + std::string(kind_.kept) + std::string(sequence);
  const std::string what(kind_.what);
  const auto wanted = parse_name_number(sequence);
  if (!wanted) {
    return fail(ErrorCode::NotFound, where, "a " + what + " is named by its sequence number");
  }
  const std::scoped_lock lock(mutex_);
  const auto it = std::lower_bound(
      documents_.begin(), documents_.end(), *wanted,
      [](const Kept& kept, std::uint64_t number) { return kept.first.sequence < number; });
  if (it == documents_.end()) {
    return fail(ErrorCode::NotFound, where,
                "there is no such " + what + " yet; " + latest() + " is the latest one");
  }
  if (it->first.sequence == *wanted) return it->first;
  if (it != documents_.begin()) {
    return fail(ErrorCode::NotFound, where,
                "no " + what + " has this number; it was lost or left out");
  }
  return fail(
      ErrorCode::Gone, where,
      "the oldest " + what + " still here is " + std::to_string(documents_.front().first.sequence));
}

Result<Document> DocumentRing::at(const std::string& time) const {
  const std::string where = latest() + "?at=" + time;
  const auto instant = parse_instant(time, where);
  if (!instant) return pass(instant);
  const std::scoped_lock lock(mutex_);
  const auto after = std::lower_bound(
      documents_.begin(), documents_.end(), *instant - kSameInstant,
      [](const Kept& kept, Timestamp wanted) { return kept.first.captured < wanted; });
  if (after == documents_.end()) {
    return fail(ErrorCode::NotFound, where,
                "there is no " + std::string(kind_.what) + " of this instant yet");
  }
  if (after->first.captured <= *instant + kSameInstant) return after->better;
  if (after == documents_.begin()) {
    return fail(
        ErrorCode::Gone, where,
        "the oldest instant still here is " + to_iso8601(documents_.front().first.captured));
  }
  const Document& before = std::prev(after)->better;
  if (kind_.between == nullptr) return before;
  return Document{before.sequence, *instant,
                  kind_.between(before.value.get(), after->better.value.get(), *instant)};
}

Document DocumentRing::newest() const {
  const std::scoped_lock lock(mutex_);
  return documents_.empty() ? Document{} : documents_.back().first;
}

}  // namespace chorus::service
