// What all conversations of a server share.
#pragma once

#include "common/http/counters.h"
#include "common/http/responder.h"
#include "common/net/address_allowance.h"

namespace chorus::http {

struct ConversationContext {
  const ServerConfig& config;
  const Responder& responder;
  AtomicCounters& counters;
  const bool& stopping;  ///< While the server stops, each answer is the last one of its connection.
  net::AddressAllowance* allowance = nullptr;  ///< Of requests; null: as many as anybody likes.
};

}  // namespace chorus::http
