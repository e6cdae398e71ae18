// What the cells of a site saw of one walk, from recordings or from running fusion servers.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

#include "common/base/result.h"
#include "fusion-server/site/places.h"

namespace chorus::ctl {

struct NamedCell {
  site::CellId name;
  std::string source;  ///< An address, or a file.
};

/// "hall-a=http://10.0.0.5:8080/" or "hall-a=a.mcap".
[[nodiscard]] Result<NamedCell> read_named_cell(std::string_view text);

/// "a:1.5,-2=b:0,3": a mark on the floor, x and z in the world of each cell [m].
[[nodiscard]] Result<site::CellMark> read_cell_mark(std::string_view text);

[[nodiscard]] bool is_live(const std::string& source);

/// Unavailable at once if a live cell's server does not answer at all.
[[nodiscard]] Result<void> answers(const NamedCell& cell);

/// Reads the source to its end, or listens to an address for `listen`.
[[nodiscard]] Result<site::CellWalk> walk_of(const NamedCell& cell,
                                             std::chrono::milliseconds listen);

}  // namespace chorus::ctl
