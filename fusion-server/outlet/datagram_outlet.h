// An outlet that only encodes frames and sends the datagrams to its targets.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "fusion-server/outlet/outlet.h"

namespace chorus::outlet {

using Datagrams = std::vector<std::vector<char>>;
/// Called for each frame in order, always on the same thread.
using DatagramEncoder = std::function<Datagrams(const TrackerFrame&)>;

/// What one set of targets receives.
struct DatagramStream {
  std::vector<std::string> targets;
  DatagramEncoder encode;
  Datagrams last_words = {};  ///< Sent when the outlet ends.
};

/// `name` must outlive the outlet; errors are those of DatagramSender::open().
[[nodiscard]] Result<std::unique_ptr<Outlet>> open_datagram_outlet(
    std::string_view name, std::vector<DatagramStream> streams);

}  // namespace chorus::outlet
