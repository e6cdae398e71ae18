#include "services/sensor/device/replay/replay_tape.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "common/base/median.h"
#include "common/record/cell_outline.h"
#include "common/record/cell_stream.h"

namespace chorus::sensor_service {
namespace {

constexpr std::size_t kSampleFrames = 300;  // Ten seconds suffice to find the usual step.

Duration median_step(const std::vector<Timestamp>& captured) {
  std::vector<Duration> steps;
  for (std::size_t i = 1; i < captured.size(); ++i) steps.push_back(captured[i] - captured[i - 1]);
  if (steps.empty()) return std::chrono::seconds(1);
  return median(std::move(steps));
}

tl::unexpected<Error> no_frames() {
  return fail(ErrorCode::InvalidArgument, "recording", "it holds no frames to replay");
}

class MemoryTape final : public ReplayTape {
 public:
  explicit MemoryTape(record::FrameRecording recording)
      : about_(std::move(recording)), frames_(std::move(about_.frames)) {
    about_.frames.clear();
  }

  [[nodiscard]] const record::FrameRecording& about() const override { return about_; }
  [[nodiscard]] TapeSpan span() const override {
    std::vector<Timestamp> captured;
    for (const SensorFrame& frame : frames_) captured.push_back(frame.captured);
    return {captured.front(), captured.back(), captured.size(), median_step(captured)};
  }
  [[nodiscard]] Result<std::optional<SensorFrame>> next() override {
    if (next_ == frames_.size()) return std::nullopt;
    return frames_[next_++];
  }
  void rewind() override { next_ = 0; }

 private:
  record::FrameRecording about_;
  std::vector<SensorFrame> frames_;
  std::size_t next_ = 0;
};

class FileTape final : public ReplayTape {
 public:
  FileTape(record::SensorStay stay, std::vector<std::string> damage)
      : stay_(std::move(stay)), stream_(fresh()), leave_out_(stay_.left_over) {
    for (std::size_t i = 0; i < damage.size(); ++i)
      stay_.about.notes["damage." + std::to_string(i + 1)] = std::move(damage[i]);
  }

  /// Reads the first frames, or all frames if the file does not state their number.
  Result<void> measure() {
    std::vector<Timestamp> captured;
    std::uint64_t frames = 0;
    while (!stay_.frames || captured.size() < kSampleFrames) {
      const auto frame = next();
      if (!frame) return pass(frame);
      if (!*frame) break;
      ++frames;
      if (captured.size() < kSampleFrames) captured.push_back((*frame)->captured);
    }
    if (captured.empty()) return no_frames();
    span_ = {captured.front(), std::max(stay_.last, captured.back()), stay_.frames.value_or(frames),
             median_step(captured)};
    rewind();
    return {};
  }

  [[nodiscard]] const record::FrameRecording& about() const override { return stay_.about; }
  [[nodiscard]] TapeSpan span() const override { return span_; }
  [[nodiscard]] Result<std::optional<SensorFrame>> next() override {
    for (auto item = stream_.next(); true; item = stream_.next()) {
      if (!item) return pass(item);
      if (!*item) return std::nullopt;
      auto* frame = std::get_if<SensorFrame>(&**item);
      if (frame == nullptr || frame->sensor != stay_.about.sensor) continue;
      if (!std::exchange(leave_out_, false)) return std::move(*frame);
    }
  }
  void rewind() override {
    stream_ = fresh();
    leave_out_ = stay_.left_over;
  }

 private:
  [[nodiscard]] record::CellStream fresh() const {
    record::CellQuery query;
    query.only = stay_.about.sensor;
    return record::CellStream(stay_.files, query);
  }

  record::SensorStay stay_;
  record::CellStream stream_;
  bool leave_out_ = false;  ///< Whether the next frame was left over from before the recording.
  TapeSpan span_;
};

/// The stream of the sensor `which`; a recording of one sensor is played under any name.
Result<record::SensorStay> chosen(std::vector<record::SensorStay> stays, const SensorId& which,
                                  const std::string& path) {
  std::string there;
  for (record::SensorStay& stay : stays) {
    const bool alone = stays.size() == 1 && !stay.cell;
    if (stay.about.sensor == which || alone) return std::move(stay);
    there += (there.empty() ? "" : ", ") + stay.about.sensor.str();
  }
  return fail(ErrorCode::NotFound, path,
              there.empty() ? "it holds no frames of a sensor"
                            : "it holds the sensors " + there + "; name one of them, not \"" +
                                  which.str() + "\"");
}

}  // namespace

Result<std::unique_ptr<ReplayTape>> tape_of(record::FrameRecording recording) {
  if (recording.frames.empty()) return no_frames();
  return std::unique_ptr<ReplayTape>(std::make_unique<MemoryTape>(std::move(recording)));
}

Result<std::unique_ptr<ReplayTape>> open_tape(const std::filesystem::path& path,
                                              const SensorId& which) {
  const auto files = record::recording_files(path);
  if (!files) return pass(files);
  const auto lines = record::cell_lines(*files);
  if (!lines) return pass(lines);
  auto stays = record::sensor_stays(*lines);
  if (!stays) return pass(stays);
  auto stay = chosen(std::move(*stays), which, path.string());
  if (!stay) return pass(stay);
  std::vector<std::string> damage;
  for (const auto& line : *lines)
    damage.insert(damage.end(), line.damage.begin(), line.damage.end());
  auto tape = std::make_unique<FileTape>(std::move(*stay), std::move(damage));
  if (auto ok = tape->measure(); !ok) return pass(ok);
  return std::unique_ptr<ReplayTape>(std::move(tape));
}

}  // namespace chorus::sensor_service
