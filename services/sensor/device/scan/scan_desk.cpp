#include "services/sensor/device/scan/scan_desk.h"

#include <exception>
#include <utility>

namespace chorus::scan {

std::optional<Result<PhotoAnswer>> Ticket::answer() {
  const std::lock_guard lock(mutex_);
  return std::exchange(answer_, std::nullopt);
}

ScanDesk::ScanDesk(ScanPhoto scan)
    : scan_(std::move(scan)), worker_([this](const std::stop_token& stop) { work(stop); }) {}

Result<std::shared_ptr<Ticket>> ScanDesk::take(Photo photo) {
  auto ticket = std::make_shared<Ticket>();
  ticket->photo_ = std::move(photo);
  {
    const std::lock_guard lock(mutex_);
    std::erase_if(waiting_, [](const auto& one) { return one.expired(); });
    if (waiting_.size() >= kMostWaiting)
      return fail(ErrorCode::Unavailable, "scan",
                  "other photos are waiting; send this one again in a few seconds");
    waiting_.push_back(ticket);
  }
  come_.notify_one();
  return ticket;
}

/// Waits for a photo whose sender is still there; null when the desk closes.
std::shared_ptr<Ticket> ScanDesk::next(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (come_.wait(lock, stop, [&] { return !waiting_.empty(); })) {
    auto ticket = waiting_.front().lock();
    waiting_.pop_front();
    if (ticket) return ticket;
  }
  return nullptr;
}

void ScanDesk::work(const std::stop_token& stop) {
  while (const auto ticket = next(stop)) {
    if (stop.stop_requested()) return;
    auto answer = [&]() -> Result<PhotoAnswer> {
      try {
        return scan_(ticket->photo_);
      } catch (const std::exception& error) {
        return fail(ErrorCode::Internal, "scan", error.what());
      }
    }();
    const std::lock_guard lock(ticket->mutex_);
    ticket->answer_ = std::move(answer);
  }
}

}  // namespace chorus::scan
