#include "common/net/capacity.h"

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

}  // namespace chorus::net
