#include "services/ctl/convert/video_sights.h"

#include <cmath>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "services/sensor/device/camera/film.h"
#include "services/sensor/device/camera/lens.h"

namespace chorus::ctl {
namespace {

namespace fs = std::filesystem;
using camera::FilmPictures;
using positioning::PictureSight;
using positioning::SightCamera;

cv::Mat working_picture(const camera::Picture& picture) {
  cv::Mat out;
  const double factor = 1.0 * positioning::kSightWidth / picture.size.width;
  cv::resize(*picture.pixels, out, {}, factor, factor, cv::INTER_AREA);
  return out;
}

Result<void> learn_video(const camera::CameraSettings& settings, silhouette::Background& room) {
  auto pictures = FilmPictures::open(settings, {});
  if (!pictures) return pass(pictures);
  while (true) {
    const auto next = pictures->next();
    if (!next) return pass(next);
    if (!*next) return {};
    room.learn(working_picture((*next)->picture));
  }
}

bool shows_one_picture(const std::string& file) {
  const std::string ending = fs::path(file).extension().string();
  return ending == ".png" || ending == ".jpg" || ending == ".jpeg";
}

Result<silhouette::Background> learned_room(const VideoSights& how) {
  silhouette::Background room({.scale = positioning::kSightFieldScale, .model = how.model});
  camera::CameraSettings settings = how.settings;
  if (!how.empty_room.empty()) settings.source = how.empty_room;
  if (shows_one_picture(settings.source)) {
    const auto picture = camera::read_picture(settings.source);
    if (!picture) return pass(picture);
    room.learn(working_picture(*picture));
  } else if (const auto done = learn_video(settings, room); !done) {
    return pass(done);
  }
  return room;
}

Result<Intrinsics> lens_of(const camera::CameraSettings& settings) {
  auto pictures = FilmPictures::open(settings, {});
  if (!pictures) return pass(pictures);
  const auto first = pictures->next();
  if (!first) return pass(first);
  if (!*first)
    return fail(ErrorCode::InvalidArgument, settings.source, "no pictures can be read from it");
  const auto lens = camera::lens_for(settings, (*first)->picture.size);
  if (!lens) return pass(lens);
  return positioning::sight_lens(lens->camera);
}

/// Reads a video once more, picture after picture.
class SightReader {
 public:
  SightReader(SightCamera camera, silhouette::Background room, FilmPictures pictures)
      : camera_(std::move(camera)), room_(std::move(room)), pictures_(std::move(pictures)) {}

  std::shared_ptr<const PictureSight> sight(std::size_t frame) {
    while (next_ <= frame) {
      auto next = pictures_.next();
      if (!next || !*next) return nullptr;
      if (next_++ < frame) continue;
      auto evidence = room_.evidence(working_picture((*next)->picture));
      return evidence ? positioning::outline_sight(camera_, std::move(*evidence)) : nullptr;
    }
    return nullptr;
  }

 private:
  SightCamera camera_;
  silhouette::Background room_;
  FilmPictures pictures_;
  std::size_t next_ = 0;
};

std::shared_ptr<const PictureSight> sight_of_mask(const SightCamera& camera,
                                                  const camera::PersonMask& mask) {
  const cv::Mat cells(mask.size.height, mask.size.width, CV_8U,
                      const_cast<std::uint8_t*>(mask.cells.data()));
  const double scale = 1.0 * mask.size.width / positioning::kSightWidth;
  return positioning::outline_sight(camera, silhouette::evidence_of_mask(cells, scale));
}

}  // namespace

Result<SightOfFrame> video_sights(VideoSights how) {
  const auto lens = lens_of(how.settings);
  if (!lens) return pass(lens);
  const SightCamera camera{how.world_from_sensor, *lens, how.shape};
  if (how.masks) {
    return SightOfFrame([camera, masks = how.masks, times = std::move(how.times)](
                            std::size_t frame) -> std::shared_ptr<const PictureSight> {
      const auto found = frame < times.size() ? masks->find(times[frame]) : masks->end();
      return found == masks->end() ? nullptr : sight_of_mask(camera, found->second);
    });
  }
  auto room = learned_room(how);
  if (!room) return pass(room);
  auto pictures = FilmPictures::open(how.settings, {});
  if (!pictures) return pass(pictures);
  auto reader = std::make_shared<SightReader>(camera, std::move(*room), std::move(*pictures));
  return SightOfFrame([reader](std::size_t frame) { return reader->sight(frame); });
}

Result<std::vector<SensorFrame>> empty_frames(const camera::CameraSettings& settings,
                                              const SensorId& sensor, Timestamp start) {
  auto pictures = FilmPictures::open(settings, start);
  if (!pictures) return pass(pictures);
  std::vector<SensorFrame> out;
  while (true) {
    const auto next = pictures->next();
    if (!next) return pass(next);
    if (!*next) break;
    SensorFrame frame;
    frame.sensor = sensor;
    frame.sequence = out.size() + 1;
    frame.captured = frame.received = (*next)->captured;
    out.push_back(std::move(frame));
  }
  if (!out.empty()) return out;
  return fail(ErrorCode::InvalidArgument, settings.source,
              "no pictures can be read from the file; is it a video?");
}

}  // namespace chorus::ctl
