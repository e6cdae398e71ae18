#include "services/sensor/advance.h"

namespace chorus::sensor_service {
namespace {

// A capture time that goes back by more than this means that the host's clock was set; by less,
// that the device repeats itself.  The fusion server has the same limit.
constexpr Duration kMaxRepeat = std::chrono::seconds(1);

}  // namespace

std::string Advance::objection(std::uint64_t sequence, Timestamp captured) const {
  if (!latest_) return {};
  const Duration behind = latest_->captured - captured;
  const bool goes_on_from_there =  // The clock was set back.
      behind > Duration::zero() && refused_ && captured > *refused_;
  if (behind >= Duration::zero() && behind <= kMaxRepeat && !goes_on_from_there) {
    return "its capture time does not advance";
  }
  if (sequence <= latest_->sequence) return "its sequence number does not advance";
  return {};
}

std::uint64_t Advance::take(std::uint64_t sequence, Timestamp captured) {
  const std::uint64_t missing = latest_ ? sequence - latest_->sequence - 1 : 0;
  latest_ = Stamp{sequence, captured};
  refused_.reset();
  return missing;
}

}  // namespace chorus::sensor_service
