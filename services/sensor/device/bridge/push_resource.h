// `/push` takes frames by WebSocket or POST; GET shows which pusher pushes and what is wrong.
#pragma once

#include <memory>

#include "common/http/router.h"
#include "services/sensor/device/bridge/push_desk.h"

namespace chorus::bridge {

/// Adds `/push`; the router keeps the desk alive.
void add_push_routes(http::Router& router, const std::shared_ptr<PushDesk>& desk);

}  // namespace chorus::bridge
