// What the pictures of a video show of the outline of a person, for methods that look at pictures
// themselves.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/positioning/outline_sight.h"
#include "common/positioning/take.h"
#include "services/sensor/device/camera/camera_settings.h"
#include "services/sensor/device/camera/runner_wire.h"

namespace chorus::ctl {

/// Masks of a network, by the time of their picture.
using PersonMasks = std::map<Timestamp, camera::PersonMask>;

struct VideoSights {
  camera::CameraSettings settings;  ///< The source is the video.
  Eigen::Isometry3d world_from_sensor = Eigen::Isometry3d::Identity();
  std::vector<silhouette::ShapedBone> shape;  ///< Of the person.
  silhouette::BackgroundModel model = silhouette::BackgroundModel::Median;
  std::string empty_room =
      {};  ///< A picture or a video without the person; empty: the video itself.
  std::shared_ptr<const PersonMasks> masks = {};  ///< Instead of a background, if there are any.
  std::vector<Timestamp> times = {};              ///< Of the frames, for masks.
};

using SightOfFrame =
    std::function<std::shared_ptr<const positioning::PictureSight>(std::size_t frame)>;

/// The sights of the frames that look_through() makes of the video, in their order.  The room is
/// learned first, from all of its pictures.
[[nodiscard]] Result<SightOfFrame> video_sights(VideoSights how);

/// The frames of a video without anybody found in them, for methods without a runner.
[[nodiscard]] Result<std::vector<SensorFrame>> empty_frames(const camera::CameraSettings& settings,
                                                            const SensorId& sensor,
                                                            Timestamp start);

}  // namespace chorus::ctl
