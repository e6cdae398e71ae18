// Asks the routes of the fusion server without a socket.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "common/http/route_table.h"
#include "fusion-server/flow/fused_body.h"
#include "fusion-server/flow/snapshot.h"
#include "tests/support/builders.h"

namespace chorus::rest {

[[nodiscard]] inline Result<http::DocumentPtr> ask(
    const http::Router& router, const std::string& path,
    std::map<std::string, std::string, std::less<>> query = {}) {
  const auto match = router.match(path);
  if (!match) return pass(match);
  if (match->entry->live && query.empty()) return match->entry->live->current();
  http::Request request;
  request.path = path;
  request.query = std::move(query);
  const auto& getter = match->entry->live ? match->entry->by_query : match->entry->getter;
  return getter(request, match->params);
}

[[nodiscard]] inline std::string body(const Result<http::DocumentPtr>& document,
                                      std::string_view accept) {
  if (!document || !*document) return "nothing";
  const auto chosen = (*document)->choose(accept);
  return chosen ? std::string((*chosen)->body()) : to_string(chosen.error());
}

[[nodiscard]] inline std::shared_ptr<const Snapshot> snapshot(std::uint64_t sequence) {
  auto s = std::make_shared<Snapshot>();
  s->sequence = sequence;
  s->instant = testing::kStart + testing::kFrameInterval * static_cast<int>(sequence);
  s->sensors = {testing::sensor_id("s1")};
  FusedBody one;
  one.id = {7};
  one.skeleton = testing::standing_person();
  one.contributors.fill(1);
  s->bodies.push_back(one);
  return s;
}

}  // namespace chorus::rest
