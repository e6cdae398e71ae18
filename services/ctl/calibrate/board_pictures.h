// Looks for a calibration board in photos, videos and cameras.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "common/calibration/board.h"
#include "common/calibration/view.h"

namespace chorus::ctl {

struct BoardSearch {
  /// Photos, folders of photos, videos, and cameras as chorus-sensor names them (/dev/video0).
  std::vector<std::string> sources;
  calibration::Board board;
  double seconds = 60.0;  ///< How long a camera or a stream is recorded.
  /// Called with the share of the work that is done, [0, 1], and with what has been found.
  std::function<void(double share, std::string_view remark)> progress = {};
};

struct BoardViews {
  std::vector<calibration::View> views;
  calibration::PictureSize size;
  std::size_t pictures = 0;        ///< Number of pictures examined, all of the same size.
  std::vector<std::string> notes;  ///< What was left out and why.
};

/// Examines every photo, and four pictures a second of a video or camera.  Fails when a folder has
/// no photos, when no picture can be read, or when the only source fails.  A damaged photo is
/// left out with a note, and so are pictures of another size than most of those with the board.
[[nodiscard]] Result<BoardViews> look_for_board(const BoardSearch& search);

}  // namespace chorus::ctl
