#include "services/sensor/device/camera/hand_finder.h"

namespace chorus::camera {
namespace {

constexpr Duration kHandsReadyWithin = std::chrono::seconds(60);
constexpr Duration kHandsWithin = std::chrono::seconds(30);

}  // namespace

Result<HandFinder> HandFinder::start(const std::vector<std::string>& command) {
  auto process = RunnerProcess::start(command);
  if (!process) return pass(process);
  const auto line = (*process)->read_line(kHandsReadyWithin, {});
  if (!line) return pass(line);
  auto about = read_hand_hello(*line);
  if (!about) return pass(about);
  return HandFinder(std::move(*process), std::move(*about));
}

Result<std::vector<hand::SeenHand>> HandFinder::look(const Picture& picture) {
  // Runners want rising times; these pictures were taken at any.
  const Timestamp taken{std::chrono::seconds(++sequence_)};
  const Question question{sequence_, taken, sent_size(picture.size, about_.max_side)};
  const std::string bytes = image_header(question) + rgb_bytes(picture, question.size);
  if (const auto ok = process_->send(bytes, kHandsWithin, {}); !ok) return pass(ok);
  const auto line = process_->read_line(kHandsWithin, {});
  if (!line) return pass(line);
  auto hands = read_hand_answer(*line, question);
  if (!hands) return hands;
  const double x = 1.0 * picture.size.width / question.size.width;
  const double y = 1.0 * picture.size.height / question.size.height;
  for (hand::SeenHand& each : *hands) {
    for (hand::Pixel& joint : each.joints) joint = {joint.x() * x, joint.y() * y};
  }
  return hands;
}

}  // namespace chorus::camera
