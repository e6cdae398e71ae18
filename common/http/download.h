// An answer's file on its way to the client, one of the few that may be at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "common/http/counters.h"
#include "common/http/file_body.h"

namespace chorus::http {

class Download {
 public:
  /// `open`: counts the files that are on their way, of all clients.
  explicit Download(AtomicCounters::Count& open) : open_(open) {}

  /// Begins with the first byte; false, and nothing else, if `most` files are on their way already.
  [[nodiscard]] bool begin(std::size_t most) {
    if (open_.load(std::memory_order_relaxed) >= most) return false;
    count(open_);
    sent_ = 0;
    return under_way_ = true;
  }
  void end() {
    if (std::exchange(under_way_, false)) uncount(open_);
  }

  [[nodiscard]] bool complete(const FileBody& file) const { return sent_ >= file.size(); }
  /// Reads the next piece; false if the file has become too short.
  [[nodiscard]] bool read_next(const FileBody& file) {
    if (!file.read(sent_, piece_)) return false;
    sent_ += piece_.size();
    return true;
  }
  [[nodiscard]] std::string_view piece() const { return piece_; }

 private:
  AtomicCounters::Count& open_;
  bool under_way_ = false;
  std::uint64_t sent_ = 0;
  std::string piece_;
};

}  // namespace chorus::http
