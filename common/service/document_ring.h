// Keeps the recent documents of one kind, for /frames/{seq} and /frame?at=TIME.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include "common/base/duration.h"
#include "common/base/result.h"
#include "common/resource/document.h"

namespace chorus::service {

using resource::Document;

/// How far back /frames/{seq} and ?at= reach.
struct DocumentHistory {
  Duration span = std::chrono::seconds(3);
  std::size_t most = 10'000;  ///< Largest number of documents, whatever their rate.

  bool operator==(const DocumentHistory&) const = default;
};

/// What is kept: names for paths and messages.
struct RingKind {
  std::string_view path = "frame";    ///< The latest one, below `/`.
  std::string_view kept = "frames/";  ///< Those kept here, by sequence.
  std::string_view what = "frame";    ///< For people.
  /// The value at an instant between two of this kind; null: nothing is interpolated, and ?at= of
  /// such an instant is the document before it.
  std::shared_ptr<const void> (*between)(const void* before, const void* after,
                                         Timestamp instant) = nullptr;
};

/// Thread-safe.  Documents must be pushed in order of sequence and capture time.  A capture time
/// that does not advance (because the clock was set back) empties the ring first.
class DocumentRing {
 public:
  DocumentRing(const DocumentHistory& history, const RingKind& kind)
      : history_(history), kind_(kind) {}

  void push(Document document);

  /// Adds a better document for an instant that is kept here: /frame?at= shows it from now on, but
  /// /frames/{seq} stays as it was.
  void amend(Document document);
  /// How many documents amend() has replaced.
  [[nodiscard]] std::uint64_t amendments() const;

  /// The document with this number, which comes from a path.  Gone when the number is below those
  /// of all that are kept; NotFound when it is not a number, not published yet, or that of one that
  /// was lost or left out.
  [[nodiscard]] Result<Document> find(std::string_view sequence) const;

  /// The document at an instant (an xsd:dateTime, or nanoseconds since the epoch as an integer),
  /// which is a document's own within a microsecond.  NotFound after the newest one, Gone before
  /// the oldest, InvalidArgument if `time` is no instant.
  [[nodiscard]] Result<Document> at(const std::string& time) const;

  /// Without a value before the first one.
  [[nodiscard]] Document newest() const;

 private:
  struct Kept {
    Document first;   ///< As published.
    Document better;  ///< The same document, or the one that has replaced it.
  };

  [[nodiscard]] std::string latest() const { return "/" + std::string(kind_.path); }

  const DocumentHistory history_;
  const RingKind kind_;
  mutable std::mutex mutex_;
  std::deque<Kept> documents_;
  std::uint64_t amendments_ = 0;
};

}  // namespace chorus::service
