// What other cells told and nobody has looked at yet: a few words of each cell, the newest ones.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include "fusion-server/site/site_id.h"

namespace chorus::nats {

/// Thread-safe.  A cell that talks without end displaces only its own words.
template <class Word>
class Inbox {
 public:
  static constexpr std::size_t kCells = 64;

  /// `per_cell`: how many words of a cell may wait.
  explicit Inbox(std::size_t per_cell) : per_cell_(per_cell > 0 ? per_cell : 1) {}

  void give(const site::CellId& cell, Word word) {
    const std::scoped_lock lock(mutex_);
    const auto found = waiting_.find(cell);
    if (found == waiting_.end() && waiting_.size() == kCells) {
      ++dropped_;
      return;
    }
    std::deque<Word>& own = found == waiting_.end() ? waiting_[cell] : found->second;
    if (own.size() == per_cell_) {
      own.pop_front();
      ++dropped_;
    }
    own.push_back(std::move(word));
  }

  /// All of them, the oldest of each cell first.
  [[nodiscard]] std::vector<Word> take() {
    const std::scoped_lock lock(mutex_);
    std::vector<Word> all;
    for (auto& [cell, own] : waiting_)
      for (Word& each : own) all.push_back(std::move(each));
    waiting_.clear();
    return all;
  }

  [[nodiscard]] std::uint64_t dropped() const {
    const std::scoped_lock lock(mutex_);
    return dropped_;
  }

 private:
  const std::size_t per_cell_;
  mutable std::mutex mutex_;
  std::map<site::CellId, std::deque<Word>> waiting_;
  std::uint64_t dropped_ = 0;
};

}  // namespace chorus::nats
