#include "fusion-server/vrpn/request_gate.h"

#include <utility>

namespace chorus::vrpn {
namespace {

constexpr std::chrono::seconds kTidyInterval{1};

}  // namespace

RequestGate::Verdict RequestGate::ask(const Asker& asker, SteadyTime now) {
  if (known_.contains(asker)) return Verdict::Repeated;
  if (under_way_.size() >= limits_.most_under_way || !all_.has(1.0, now)) return Verdict::Refused;
  const std::string& name = name_of_source(asker.address, now);
  Source& source = sources_.at(name);
  if (source.under_way >= limits_.most_of_source || !source.allowance.take(1.0, now)) {
    return Verdict::Refused;
  }
  (void)all_.take(1.0, now);
  ++source.under_way;
  known_.insert(asker);
  under_way_.emplace(asker, name);
  return Verdict::Connect;
}

/// The key of the address's source, which is added if it is new; without room for it, the key of
/// the source that all further addresses share.
const std::string& RequestGate::name_of_source(const std::string& address, SteadyTime now) {
  if (const auto known = sources_.find(address); known != sources_.end()) return known->first;
  if (sources_.size() >= limits_.most_sources) tidy(now);
  const bool room = sources_.size() < limits_.most_sources;
  const Source fresh{net::TokenBucket(limits_.source)};
  return sources_.try_emplace(room ? address : std::string(), fresh).first->first;
}

/// Removes addresses that have their full allowance, because they count like addresses that never
/// asked.
void RequestGate::tidy(SteadyTime now) {
  if (now - tidied_ < kTidyInterval) return;  // Limits the cost of a flood.
  tidied_ = now;
  std::erase_if(sources_, [now](const auto& entry) {
    return entry.second.under_way == 0 && entry.second.allowance.full(now);
  });
}

/// Ends an attempt and returns its source; null if no attempt was under way.
RequestGate::Source* RequestGate::finished(const Asker& asker) {
  const auto found = under_way_.find(asker);
  if (found == under_way_.end()) return nullptr;
  Source& source = sources_.at(found->second);
  --source.under_way;
  under_way_.erase(found);
  return &source;
}

void RequestGate::connected(const Asker& asker) { (void)finished(asker); }

void RequestGate::failed(const Asker& asker) {
  known_.erase(asker);
  if (Source* source = finished(asker)) source->allowance.charge(limits_.failure);
}

}  // namespace chorus::vrpn
