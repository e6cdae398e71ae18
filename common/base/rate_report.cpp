#include "common/base/rate_report.h"

#include <utility>

namespace chorus {
namespace {

constexpr std::chrono::seconds kLineInterval{1};

}  // namespace

RateReport::RateReport(std::string event, log::Level level)
    : event_(std::move(event)), level_(level) {}

RateReport::~RateReport() {
  const std::lock_guard lock(mutex_);
  if (total_ != reported_) write_line();
}

void RateReport::hit(std::string_view detail) {
  const auto now = std::chrono::steady_clock::now();
  const std::lock_guard lock(mutex_);
  ++total_;
  detail_ = detail;
  if (reported_ != 0 && now - last_line_ < kLineInterval) return;
  last_line_ = now;
  write_line();
}

std::string RateReport::last() const {
  const std::scoped_lock lock(mutex_);
  return detail_;
}

/// Called with the lock held, so that the lines of one event stay in order.
void RateReport::write_line() {
  const std::uint64_t count = total_ - reported_;
  reported_ = total_;
  if (detail_.empty()) {
    log::event(level_, event_, {{"count", count}, {"total", total_}});
  } else {
    log::event(level_, event_, {{"count", count}, {"total", total_}, {"detail", detail_}});
  }
}

}  // namespace chorus
