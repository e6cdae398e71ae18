#include "fusion-server/publish/vrpn/request_gate.h"

#include <algorithm>

namespace chorus::publish::vrpn {

RequestGate::Verdict RequestGate::ask(const std::string& asker, SteadyTime now) {
  if (known_.contains(asker)) return Verdict::Repeated;
  const double elapsed = std::chrono::duration<double>(now - counted_).count();
  allowance_ = std::clamp(allowance_ + elapsed * limits_.per_second, 0.0, limits_.burst);
  counted_ = now;
  if (under_way_.size() >= limits_.most_under_way || allowance_ < 1.0) return Verdict::Refused;
  allowance_ -= 1.0;
  known_.insert(asker);
  under_way_.insert(asker);
  return Verdict::Connect;
}

void RequestGate::gone(const std::string& asker) {
  known_.erase(asker);
  under_way_.erase(asker);
}

}  // namespace chorus::publish::vrpn
