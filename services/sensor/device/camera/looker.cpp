#include "services/sensor/device/camera/looker.h"

#include <utility>

namespace chorus::camera {
namespace {

constexpr Duration kReadyWithin = std::chrono::seconds(60);
constexpr Duration kAnswerWithin = std::chrono::seconds(10);

}  // namespace

Result<Looker> Looker::start(const CameraSettings& settings,
                             const std::vector<std::string>& command, const std::stop_token& stop) {
  auto process = RunnerProcess::start(command);
  if (!process) return pass(process);
  const auto line = (*process)->read_line(kReadyWithin, stop);
  if (!line) return pass(line);
  auto about = read_runner_hello(*line);
  if (!about) return pass(about);
  return Looker(settings, std::move(*process), std::move(*about));
}

Result<Found> Looker::look(const Picture& picture, Timestamp captured, std::uint64_t sequence,
                           const std::stop_token& stop) {
  const auto lens = lens_for(*settings_, picture.size);
  if (!lens) return pass(lens);
  const Question question{sequence, captured, sent_size(picture.size, about_.max_side), masks_};
  const std::string bytes = image_header(question) + rgb_bytes(picture, question.size);
  if (const auto ok = process_->send(bytes, kAnswerWithin, stop); !ok) return pass(ok);
  const auto line = process_->read_line(kAnswerWithin, stop);
  if (!line) return pass(line);
  bridge::Hello hello = about_.hello;
  hello.camera = sent_camera(lens->camera, question.size);
  hello.focal_sigma = lens->focal_sigma;
  auto frame = read_runner_answer(*line, question, hello);
  if (!frame) return pass(frame);
  auto mask = masks_ ? read_runner_mask(*line)
                     : Result<std::optional<PersonMask>>(std::optional<PersonMask>());
  if (!mask) return pass(mask);
  PlacingErrors errors;
  errors.focal = lens->focal_sigma;
  if (settings_->depth_from_size) placer_.place(frame->bodies, frame->shapes, errors);
  return Found{std::move(frame->bodies),
               *lens,
               question.size,
               hello.floor ? hello.floor : settings_->floor,
               frame->outside_picture,
               std::move(*mask)};
}

}  // namespace chorus::camera
