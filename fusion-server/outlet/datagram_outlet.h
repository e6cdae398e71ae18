// An outlet that encodes each frame and sends the datagrams to its targets, and nothing else.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "fusion-server/outlet/outlet.h"

namespace chorus::outlet {

/// Called with each frame in turn, always on the same thread.
using DatagramEncoder = std::function<std::vector<std::vector<char>>(const TrackerFrame&)>;

/// `name` outlives the outlet; what is wrong with a target is named as DatagramSender does.
[[nodiscard]] Result<std::unique_ptr<Outlet>> open_datagram_outlet(
    std::string_view name, const std::vector<std::string>& targets, DatagramEncoder encode);

}  // namespace chorus::outlet
