#include "services/ctl/evaluate/recorded_quality.h"

#include "fusion-server/wire/registration_file.h"
#include "fusion-server/wire/registration_nodes.h"

namespace chorus::ctl {
namespace {

/// The frame with what the walk told of the sensor's clock and scale.
SensorFrame corrected(SensorFrame frame, const Registration& registration) {
  move_in_time(frame, walked_correction(registration, frame.sensor, frame.clock_sigma));
  const auto place = registration.sensors.find(frame.sensor);
  if (place == registration.sensors.end() || place->second.scale == 1.0) return frame;
  for (BodyFrame& body : frame.bodies)
    for (Joint& joint : body.skeleton.joints)
      if (joint.seen()) joint.position *= place->second.scale;
  return frame;
}

}  // namespace

void RecordedQuality::take(const record::SessionItem& item) {
  if (const auto* frame = std::get_if<SensorFrame>(&item)) return take(*frame);
  if (const auto* fused = std::get_if<resource::FrameResource>(&item)) return take(*fused);
  const auto* text = std::get_if<std::string>(&item);
  if (text == nullptr) return;  // what worn sensors say is judged by chorus evaluate
  if (const auto registration = wire::read_registration(*text)) take(*registration);
}

void RecordedQuality::take(const SensorFrame& frame) {
  sensors_.add(corrected(frame, registration_));
}

void RecordedQuality::take(const resource::FrameResource& fused) {
  ++fused_frames_;
  fused_.add(fused);
  sensors_.add(fused);
}

void RecordedQuality::take(const Registration& registration) {
  registration_ = registration;
  registered_ = true;
  std::map<SensorId, Eigen::Isometry3d> places;
  for (const auto& [id, sensor] : registration.sensors) places[id] = sensor.world_from_sensor;
  sensors_.place(std::move(places));
}

quality::RecordingQuality RecordedQuality::finish() {
  quality::RecordingQuality out;
  out.fused = fused_.finish();
  out.sensors = sensors_.finish();
  out.views = sensors_.view_errors();
  if (registered_) out.verdict = wire::name_of(registration_.verdict);
  return out;
}

}  // namespace chorus::ctl
