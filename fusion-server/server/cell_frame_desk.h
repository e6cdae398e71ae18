// /site/cells/{cell}/frame: the newest frame of another cell, or that of an instant (?at=), asked
// of it by the site's server when somebody asks us.  The answer is that to the last question: the
// newest frame is as old as that, two seconds at most, and its `captured` says so.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <utility>

#include "common/http/router.h"
#include "fusion-server/server/worker.h"

namespace chorus::server {

/// Thread-safe.  Nothing is asked of a cell unless somebody asks us; whoever asks first is told to
/// ask again in a moment.
class CellFrameDesk {
 public:
  /// The frame of a cell at an instant (empty: now), in JSON; may take half a second.
  using Ask = std::function<Result<std::string>(const std::string& cell, const std::string& at)>;
  /// Whether the site has a cell of this name.
  using Lists = std::function<bool(const std::string& cell)>;
  CellFrameDesk(std::string run, Ask ask, Lists lists = {})
      : run_(std::move(run)), ask_(std::move(ask)), lists_(std::move(lists)) {}

  /// The router keeps using this object, which must outlive the requests.
  void add_routes(http::Router& router);
  [[nodiscard]] Result<http::DocumentPtr> frame(const std::string& cell, const std::string& at);

 private:
  using Wish = std::pair<std::string, std::string>;  ///< Cell and instant.
  struct Frame {
    bool asked = false;                                      ///< The question is on its way.
    Result<http::DocumentPtr> answer = http::DocumentPtr();  ///< Null: none yet.
    std::chrono::steady_clock::time_point at{};              ///< When it came.
  };
  void fetch(const Wish& wish);
  void forget_old(std::chrono::steady_clock::time_point now);

  const std::string run_;
  const Ask ask_;
  const Lists lists_;
  std::mutex mutex_;  ///< Guards the members below.
  std::map<Wish, Frame> frames_;
  std::uint64_t version_ = 0;
  Worker worker_;  ///< The last member: its jobs use the others.
};

}  // namespace chorus::server
