// Frames of our cell for whoever asks over NATS: one of a past instant, or all for a while.
#pragma once

#include <deque>
#include <memory>
#include <mutex>
#include <string>

#include "fusion-server/flow/snapshot.h"
#include "fusion-server/nats/broker.h"

namespace chorus::nats {

/// Thread-safe.
class FrameDesk {
 public:
  /// How long frames are published after somebody wanted them, how far back they are kept, and how
  /// many at most, whatever the clock does: ten seconds of 33 a second, and some.
  static constexpr std::chrono::seconds kWanted{5};
  static constexpr Duration kKept = std::chrono::seconds(10);
  static constexpr std::size_t kMostKept = 400;

  /// Call it before show() and answer(); the broker must outlive them.
  void open(Broker& broker, std::string subject);
  /// Keeps the snapshot; publishes it as JSON while frames are wanted.
  void show(const std::shared_ptr<const Snapshot>& snapshot, Timestamp now);
  void want();
  /// {"at": "NANOSECONDS"}: the answer is the frame of that instant, or the last one before, as
  /// /frame?at= has it in JSON; {"error": "..."} if there is none.  Without a time: the newest.
  void answer(const Message& message);

  /// What answer() sends.
  [[nodiscard]] std::string frame_at(std::string_view request);

 private:
  struct Kept {
    std::shared_ptr<const Snapshot> snapshot;
    std::shared_ptr<const std::string> text;  ///< Null: nobody has asked for it yet.
  };
  /// The frame as JSON, written once however often it is asked for.
  [[nodiscard]] std::shared_ptr<const std::string> text_of(const Kept& kept);

  std::mutex mutex_;
  Broker* broker_ = nullptr;  ///< These are guarded by mutex_.
  std::string subject_;
  std::deque<Kept> kept_;
  SteadyTime wanted_{};
  bool ever_wanted_ = false;
};

/// What frame_at() is asked for an instant (empty: the newest).
[[nodiscard]] std::string frame_question(const std::string& at);
/// What a cell answered to CellLink::ask_frame(), unchanged, if it is a frame; errors as
/// ask_frame()'s.
[[nodiscard]] Result<std::string> frame_answered(const std::string& cell, std::string answer);

}  // namespace chorus::nats
