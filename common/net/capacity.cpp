#include "common/net/capacity.h"

#include <algorithm>
#include <map>

namespace chorus::net {
namespace {

std::string full(std::size_t limit, const std::string& of, std::string_view key) {
  return "there are " + std::to_string(limit) + " already" + of + ", as many as " +
         std::string(key) + " allows";
}

}  // namespace

std::string objection(const Capacity& capacity, const ClientCount& count,
                      std::string_view address) {
  if (count.all >= capacity.all) return full(capacity.all, "", capacity.all_key);
  if (count.of_address < capacity.of_address) return {};
  return full(capacity.of_address, " of " + std::string(address), capacity.of_address_key);
}

std::optional<std::size_t> who_makes_room(const Capacity& capacity, std::span<const Occupant> all,
                                          std::string_view newcomer, SteadyTime now) {
  std::map<std::string_view, std::size_t> of_address;
  for (const Occupant& one : all) ++of_address[one.address];
  const bool address_full = of_address[newcomer] >= capacity.of_address;
  if (!address_full && all.size() < capacity.all) return std::nullopt;
  std::size_t most = 0;
  for (const auto& [address, count] : of_address) most = std::max(most, count);
  std::optional<std::size_t> chosen;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Occupant& one = all[i];
    const bool theirs = address_full ? one.address == newcomer : of_address[one.address] == most;
    const bool idle = !one.stays && (!one.greeted || now - one.heard >= kIdle);
    if (!theirs || !idle) continue;
    const auto rank = [](const Occupant& o) { return std::pair(o.greeted, o.heard); };
    if (!chosen || rank(one) < rank(all[*chosen])) chosen = i;
  }
  return chosen;
}

}  // namespace chorus::net
