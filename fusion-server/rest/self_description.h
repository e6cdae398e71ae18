// `/` of a fusion server: what it is and where everything else is; and the floor of its world.
#pragma once

#include <string>

#include "common/http/router.h"
#include "common/resource/node.h"
#include "fusion-server/rest/frame_resources.h"

namespace chorus::rest {

/// A DCAT data service and an LDP container, from which links lead to every body's joints:
/// / -> skeletons/ -> skeletons/1 -> #Head.
[[nodiscard]] resource::Node service_node(const std::string& title, bool with_viewer);

/// The same for a browser.
[[nodiscard]] std::string landing_page(const std::string& title, bool with_viewer);

/// /, /floor-plane (world: y = 0), and /viewer/ when there is a folder for it.
void add_description_routes(http::Router& router, const RestContext& context,
                            const std::string& title, const std::string& viewer_dir);

}  // namespace chorus::rest
