// `/` of a fusion server, and the floor of the world.
#pragma once

#include <string>

#include "common/http/router.h"
#include "common/service/self_description.h"

namespace chorus::rest {

/// `judged`: there is an /evaluation.
[[nodiscard]] service::Self self_of(const std::string& title, bool with_viewer,
                                    bool judged = false);

/// Adds /, /floor-plane (world: y = 0), and /viewer/ if there is a folder for it.
void add_description_routes(http::Router& router, const service::Serving& serving,
                            const service::Self& self, const std::string& viewer_dir);

}  // namespace chorus::rest
