// What other cells told and nobody has looked at yet: a few messages of each cell, the newest ones.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include "common/time/timestamp.h"
#include "fusion-server/site/cell_people.h"

namespace chorus::nats {

struct HeardPeople {
  site::CellPeople people;
  Timestamp came;  ///< By our clock.
};

/// Thread-safe.  A cell that talks without end displaces only its own messages.
class Inbox {
 public:
  static constexpr std::size_t kPerCell = 4;
  static constexpr std::size_t kCells = 64;

  void give(HeardPeople heard) {
    const std::scoped_lock lock(mutex_);
    const auto found = waiting_.find(heard.people.cell);
    if (found == waiting_.end() && waiting_.size() == kCells) {
      ++dropped_;
      return;
    }
    std::deque<HeardPeople>& own =
        found == waiting_.end() ? waiting_[heard.people.cell] : found->second;
    if (own.size() == kPerCell) {
      own.pop_front();
      ++dropped_;
    }
    own.push_back(std::move(heard));
  }

  /// All of them, the oldest of each cell first.
  [[nodiscard]] std::vector<HeardPeople> take() {
    const std::scoped_lock lock(mutex_);
    std::vector<HeardPeople> all;
    for (auto& [cell, own] : waiting_)
      for (HeardPeople& each : own) all.push_back(std::move(each));
    waiting_.clear();
    return all;
  }

  [[nodiscard]] std::uint64_t dropped() const {
    const std::scoped_lock lock(mutex_);
    return dropped_;
  }

 private:
  mutable std::mutex mutex_;
  std::map<site::CellId, std::deque<HeardPeople>> waiting_;
  std::uint64_t dropped_ = 0;
};

}  // namespace chorus::nats
