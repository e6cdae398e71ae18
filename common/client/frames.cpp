#include "common/client/frames.h"

#include <string>
#include <utility>

namespace chorus::client {
namespace {

Result<Document> read_frame_document(std::string_view text, resource::Format format,
                                     const SensorId& expected) {
  auto frame = resource::read_frame(text, format);
  if (!frame) return pass(frame);
  if (frame->space == resource::SpaceKind::Sensor && frame->source != expected.str()) {
    return fail(ErrorCode::Conflict, "frame",
                "the service calls itself \"" + frame->source + "\", the config calls it \"" +
                    expected.str() + "\"; make both the same");
  }
  const auto value = std::make_shared<const resource::FrameResource>(std::move(*frame));
  return Document{value->sequence, value->captured, value};
}

}  // namespace

const KindOf<resource::FrameResource> kFrames{{"frame", "frames/", true, read_frame_document}};

SensorFrame place_in_time(const Arrived<resource::FrameResource>& arrived) {
  SensorFrame placed =
      resource::to_sensor_frame(*arrived.document, arrived.source, arrived.received);
  move_in_time(placed, correction(arrived.clock));
  placed.clock_sigma = clock_sigma(arrived.clock);
  const bool world = arrived.document->space == resource::SpaceKind::World;
  placed.floor = world ? FloorPlane{} : arrived.floor;
  return placed;
}

}  // namespace chorus::client
