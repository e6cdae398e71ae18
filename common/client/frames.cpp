#include "common/client/frames.h"

#include <string>
#include <utility>

namespace chorus::client {
namespace {

Result<Document> read_frame_document(std::string_view text, resource::Format format,
                                     const SensorId& expected) {
  auto frame = resource::read_frame(text, format);
  if (!frame) return pass(frame);
  if (frame->space == resource::SpaceKind::Sensor && frame->source != expected.str())
    return not_called("frame", frame->source, expected);
  return resource::document_of_value(
      std::make_shared<const resource::FrameResource>(std::move(*frame)));
}

}  // namespace

tl::unexpected<Error> not_called(std::string path, const std::string& source,
                                 const SensorId& expected) {
  return fail(ErrorCode::Conflict, std::move(path),
              "the service calls itself \"" + source + "\", the config calls it \"" +
                  expected.str() + "\"; make both the same");
}

const KindOf<resource::FrameResource> kFrames{
    {"frame", "frames/", true, resource::Format::Turtle, read_frame_document}};

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
