#include "services/sensor/device/positioner/positioner.h"

#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

#include "common/base/file.h"
#include "services/sensor/device/camera/camera.h"
#include "services/sensor/device/positioner/live_tracker.h"
#include "services/sensor/device/positioner/picture_eye.h"
#include "services/sensor/device/positioner/places_file.h"
#include "services/sensor/device/positioner/positioner_settings.h"
#include "services/sensor/device/suit/suit_gloves.h"
#include "services/sensor/device/suit/suit_source.h"
#include "services/sensor/host_clock.h"

namespace chorus::positioner {
namespace {

// Of a joint within the pose: three degrees over an arm's or a leg's bones [m].
constexpr double kPoseSigma = 0.03;
constexpr double kUsualStature = 1.75;
constexpr std::uintmax_t kMostPlaceBytes = 1 << 22;
constexpr double kNearly = 0.9;

double stature_in(const PositionerSettings& settings) {
  return settings.suit.stature > 0.0 ? settings.suit.stature : kUsualStature;
}

struct PlacedCamera {
  Eigen::Isometry3d world_from_sensor;
  std::unique_ptr<http::Router> router;  ///< Its own, not served: paths of several would clash.
  std::unique_ptr<FrameSource> source;
  std::unique_ptr<PictureEye> eye;  ///< Null where the method does not look at pictures itself.
  /// Of the picture whose landmarks come next; used on the camera's thread only.
  std::shared_ptr<const positioning::PictureSight> sight;
};

struct PositionerParts {
  SensorId sensor;
  PositionerSettings settings;
  std::shared_ptr<const Clock> clock;
  std::unique_ptr<suit::SuitSource> worn;
  suit::SuitGloves gloves = {};
  std::vector<std::unique_ptr<PlacedCamera>> cameras;
};

class Positioner final : public FrameSource {
 public:
  explicit Positioner(PositionerParts parts)
      : parts_(std::move(parts)), tracker_(tracking(parts_)) {}

  [[nodiscard]] DeviceDescription describe() const override;
  [[nodiscard]] std::vector<std::string> concerns() const override;
  [[nodiscard]] std::string trouble() const override;
  [[nodiscard]] Result<void> run(std::stop_token stop, const Sink& sink) override;

 private:
  static positioning::TrackerSettings tracking(const PositionerParts& parts);
  void look(std::size_t camera, Capture capture);
  void step(const suit::SuitInstant& instant, bool anew, const Sink& sink);
  [[nodiscard]] SensorFrame frame_of(const LivePlace& place);

  PositionerParts parts_;
  mutable std::mutex mutex_;
  LiveTracker tracker_;  ///< Guarded by mutex_, like what follows.
  std::function<Result<CameraImage>()> picture_{};
  bool seen_ = false;
  std::string camera_failed_;
  std::optional<Timestamp> last_{};
  std::uint64_t sequence_ = 0;
};

positioning::TrackerSettings Positioner::tracking(const PositionerParts& parts) {
  positioning::TrackerSettings settings;
  settings.cameras = parts.cameras.size();
  settings.stature = stature_in(parts.settings);
  settings.method = parts.settings.method;
  return settings;
}

DeviceDescription Positioner::describe() const {
  DeviceDescription device;
  device.kind = "positioner";
  device.label = parts_.settings.label.empty()
                     ? "inertial suit (" + parts_.worn->label() + ") before " +
                           std::to_string(parts_.cameras.size()) + " cameras"
                     : parts_.settings.label;
  device.depth_camera = std::nullopt;
  device.nominal_rate_hz = parts_.settings.max_rate_hz;
  return device;
}

std::vector<std::string> Positioner::concerns() const {
  std::vector<std::string> all = parts_.worn->concerns();
  for (const auto& camera : parts_.cameras) {
    for (std::string& one : camera->source->concerns()) all.push_back(std::move(one));
  }
  return all;
}

std::string Positioner::trouble() const {
  if (const std::string why = parts_.worn->trouble(); !why.empty()) return why;
  for (const auto& camera : parts_.cameras) {
    if (const std::string why = camera->source->trouble(); !why.empty()) return why;
  }
  const std::lock_guard lock(mutex_);
  if (!camera_failed_.empty()) return camera_failed_;
  return seen_ ? "" : "no camera has seen anybody whose pose is the suit's";
}

/// Called on a camera's thread.
void Positioner::look(std::size_t camera, Capture capture) {
  PlacedCamera& own = *parts_.cameras[camera];
  positioning::Look look{camera, own.world_from_sensor, {}, std::exchange(own.sight, {})};
  for (const BodyFrame& body : capture.frame.bodies) look.people.push_back(body.skeleton);
  const std::lock_guard lock(mutex_);
  tracker_.picture(capture.frame.captured, std::move(look));
  if (camera != 0) return;
  const auto& place = tracker_.pictured();
  if (own.eye && place) {
    const positioning::Position& at = place->tracked.position;
    picture_ = own.eye->drawn(placed(place->pose, at.heading, at.place));
  } else {
    picture_ = std::move(capture.color);
  }
}

SensorFrame Positioner::frame_of(const LivePlace& place) {
  SensorFrame frame;
  frame.sensor = parts_.sensor;
  frame.sequence = ++sequence_;
  frame.captured = place.captured;
  frame.received = parts_.clock->now();
  frame.floor = FloorPlane{};
  const positioning::Position& at = place.tracked.position;
  Skeleton<WorldSpace> body = placed(place.pose, at.heading, at.place);
  const Covariance covariance(
      Eigen::Matrix3d(at.covariance + kPoseSigma * kPoseSigma * Eigen::Matrix3d::Identity()));
  for (Joint& joint : body.joints) {
    if (joint.seen()) joint.covariance = covariance;
  }
  frame.bodies.push_back(
      {BodyId{1}, place.captured, to_sensor(Eigen::Isometry3d::Identity(), body)});
  return frame;
}

void Positioner::step(const suit::SuitInstant& instant, bool anew, const Sink& sink) {
  suit::SuitInstant shifted = instant;
  shifted.captured += from_seconds(parts_.settings.clock_offset_s);
  Capture capture;
  {
    const std::lock_guard lock(mutex_);
    if (anew) tracker_.forget();
    const auto place = tracker_.pose(shifted);
    if (!place) return;
    seen_ = true;
    const double period = 1.0 / parts_.settings.max_rate_hz;
    if (last_ && !anew && seconds(place->captured - *last_) < kNearly * period) return;
    last_ = place->captured;
    capture.frame = frame_of(*place);
    for (BodyFrame& body : capture.frame.bodies)
      body.hands = parts_.gloves.hands(shifted, place->tracked.position.heading, body.skeleton);
    capture.begins_anew = anew;
    capture.color = std::exchange(picture_, {});
  }
  sink(std::move(capture));
}

/// The cameras run on threads of their own; the suit on this one.
Result<void> Positioner::run(std::stop_token stop, const Sink& sink) {
  std::vector<std::jthread> threads;
  for (std::size_t i = 0; i < parts_.cameras.size(); ++i) {
    threads.emplace_back([this, i](const std::stop_token& own) {
      const auto done = parts_.cameras[i]->source->run(
          own, [this, i](Capture capture) { look(i, std::move(capture)); });
      const std::lock_guard lock(mutex_);
      if (!done) camera_failed_ = to_string(done.error());
    });
  }
  return parts_.worn->run(
      stop, [&](const suit::SuitInstant& instant, bool anew) { step(instant, anew, sink); });
}

Result<std::unique_ptr<PlacedCamera>> make_placed(
    const PositionerCamera& camera, const std::map<std::string, Eigen::Isometry3d>& places,
    const PositionerSettings& settings, const sensor_service::DeviceContext& context) {
  const auto place = places.find(camera.name);
  if (place == places.end())
    return fail(ErrorCode::NotFound, "device.positioner.places",
                "has no place for the camera " + camera.name);
  if (!(place->second.translation().y() > 0.0))
    return fail(ErrorCode::InvalidArgument, "device.positioner.places",
                "the camera " + camera.name +
                    " stands below the floor, which is at y = 0; is a sign of y wrong?");
  auto out = std::make_unique<PlacedCamera>();
  out->world_from_sensor = place->second;
  out->router = std::make_unique<http::Router>();
  auto section = ConfigReader::parse(camera.section.empty() ? "{}" : camera.section,
                                     "device.positioner.cameras." + camera.name);
  if (!section) return pass(section);
  camera::PictureWatch watch;
  if (uses_pictures(settings.method)) {
    out->eye = make_eye({place->second, stature_in(settings), settings.girth, settings.background});
    watch = [one = out.get()](const camera::LookedAt& looked) {
      if (one->eye) one->sight = one->eye->see(looked);
    };
  }
  auto source = camera::make_watched_camera(*section, {context.sensor, context.time, *out->router},
                                            std::move(watch));
  if (!source) return pass(source);
  out->source = std::move(*source);
  return out;
}

}  // namespace

Result<std::unique_ptr<FrameSource>> make_positioner(ConfigReader& section,
                                                     const sensor_service::DeviceContext& context) {
  PositionerParts parts;
  parts.sensor = context.sensor;
  parts.settings = read_positioner_settings(section);
  if (parts.settings.cameras.empty())
    return fail(ErrorCode::InvalidArgument, "device.positioner.cameras",
                "names no camera; without one, the device `suit` walks by its steps");
  const auto text = read_file(parts.settings.places, kMostPlaceBytes);
  if (!text) return pass(text);
  const auto places = read_places(*text);
  if (!places) return pass(places);
  parts.clock =
      std::make_shared<sensor_service::ErringClock>(context.time.world, context.time.host);
  auto worn = suit::open_suit(parts.settings.suit, parts.clock);
  if (!worn) return pass(worn);
  parts.worn = std::move(*worn);
  auto gloves = suit::SuitGloves::open(parts.settings.suit);
  if (!gloves) return pass(gloves);
  parts.gloves = std::move(*gloves);
  for (const PositionerCamera& camera : parts.settings.cameras) {
    auto one = make_placed(camera, *places, parts.settings, context);
    if (!one) return pass(one);
    parts.cameras.push_back(std::move(*one));
  }
  return std::make_unique<Positioner>(std::move(parts));
}

}  // namespace chorus::positioner
