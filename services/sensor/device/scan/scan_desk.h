// Scans photos one after the other on a thread of its own: one takes a second, and whoever sent it
// must not hold up the server.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

#include "common/base/result.h"

namespace chorus::scan {

/// A photo of a hand, as a page sends it.
struct Photo {
  std::string bytes;       ///< JPEG or PNG.
  std::string scale = "";  ///< "a4", "card", or nothing: the file's density, if any.
  bool back = false;       ///< The back of the hand is seen, where no network tells.
};

struct PhotoAnswer {
  std::string bvh;
  std::string htr;
  std::string report;  ///< JSON, as of `chorus scan --json`.
  std::string jpeg;    ///< The photo with what was found.
};

using ScanPhoto = std::function<Result<PhotoAnswer>(const Photo&)>;

/// Somebody's place in the queue; dropping it gives up the photo.
class Ticket {
 public:
  /// The answer, once; none while it is not there.
  [[nodiscard]] std::optional<Result<PhotoAnswer>> answer();

 private:
  friend class ScanDesk;
  std::mutex mutex_;
  Photo photo_;
  std::optional<Result<PhotoAnswer>> answer_;
};

class ScanDesk {
 public:
  /// So many photos may wait; each is some megabytes.
  static constexpr std::size_t kMostWaiting = 4;

  explicit ScanDesk(ScanPhoto scan);

  /// Unavailable when too many are waiting.
  [[nodiscard]] Result<std::shared_ptr<Ticket>> take(Photo photo);

 private:
  void work(const std::stop_token& stop);
  [[nodiscard]] std::shared_ptr<Ticket> next(const std::stop_token& stop);

  ScanPhoto scan_;
  std::mutex mutex_;
  std::condition_variable_any come_;
  std::deque<std::weak_ptr<Ticket>> waiting_;
  std::jthread worker_;  ///< Last, so that it ends before what it uses.
};

}  // namespace chorus::scan
