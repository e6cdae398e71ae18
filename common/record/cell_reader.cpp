#include "common/record/cell_reader.h"

#include <utility>

#include "common/record/cell_sorting.h"

namespace chorus::record {
namespace {

namespace fs = std::filesystem;

/// Collects the items of a cell in memory, up to a limit.
class Collected {
 public:
  explicit Collected(std::uintmax_t most) : most_(most) {}

  Result<void> take(SessionItem item) {
    if (auto* frame = std::get_if<SensorFrame>(&item)) {
      bytes_ += sizeof(SensorFrame) + frame->bodies.size() * sizeof(BodyFrame);
      frames_[frame->sensor].push_back(std::move(*frame));
    } else if (auto* fused = std::get_if<resource::FrameResource>(&item)) {
      bytes_ += sizeof(*fused) + fused->bodies.size() * sizeof(resource::BodyResource);
      fused_.push_back(std::move(*fused));
    } else if (auto* text = std::get_if<std::string>(&item)) {
      bytes_ += text->size();
      registrations_.push_back(std::move(*text));
    } else {
      take_inertial(std::move(item));
    }
    if (bytes_ <= most_) return {};
    return fail(ErrorCode::TooLarge, "recording",
                "its frames take more than " + std::to_string(most_) + " bytes");
  }

  CellRecording into(CellRecording cell) {
    for (FrameRecording& recording : cell.sensors)
      recording.frames = std::move(frames_[recording.sensor]);
    cell.fused = std::move(fused_);
    cell.registrations = std::move(registrations_);
    cell.inertial = std::move(inertial_);
    return cell;
  }

 private:
  void take_inertial(SessionItem item) {
    if (auto* instant = std::get_if<inertial::InertialFrame>(&item)) {
      bytes_ += sizeof(*instant) + instant->readings.size() * sizeof(inertial::InertialReading);
      inertial_[instant->source].instants.push_back(std::move(*instant));
      return;
    }
    auto& calibration = std::get<inertial::InertialCalibration>(item);
    const auto source = SensorId::parse(calibration.source);
    if (source) inertial_[*source].calibrations.push_back(std::move(calibration));
  }

  std::uintmax_t most_;
  std::uintmax_t bytes_ = 0;
  std::map<SensorId, std::vector<SensorFrame>> frames_;
  std::vector<resource::FrameResource> fused_;
  std::vector<std::string> registrations_;
  std::map<SensorId, InertialRecording> inertial_;
};

}  // namespace

Result<CellRecording> read_cell(const std::vector<fs::path>& files, const CellQuery& query) {
  CellStream stream(files, query);
  Collected collected(query.limits.max_total_bytes);
  for (auto item = stream.next(); true; item = stream.next()) {
    if (!item) return pass(item);
    if (!*item) return collected.into(stream.finish());
    if (auto ok = collected.take(std::move(**item)); !ok) return pass(ok);
  }
}

Result<CellRecording> cell_of(const Recording& recording, const fs::path& name,
                              const CellQuery& query) {
  Sorting sorting(query);
  Collected collected(query.limits.max_total_bytes);
  const auto collect_ready = [&]() -> Result<void> {
    while (auto item = sorting.ready()) {
      if (auto ok = collected.take(std::move(*item)); !ok) return ok;
    }
    return {};
  };
  sorting.begin_file(name, recording.channels, recording.metadata);
  for (const Message& one : recording.messages) {
    const auto ok =
        sorting.take({one.topic, one.sequence, one.log_time, one.publish_time, one.data})
            .and_then(collect_ready);
    if (!ok) return pass(ok);
  }
  if (auto ok = sorting.end_file({}, recording.notes); !ok) return pass(ok);
  sorting.end();
  if (auto ok = collect_ready(); !ok) return pass(ok);
  return collected.into(sorting.finish());
}

Result<CellRecording> read_cell(const fs::path& path, const CellQuery& query) {
  const auto files = recording_files(path);
  if (!files) return pass(files);
  return read_cell(*files, query);
}

std::vector<std::string> notes_of(const CellRecording& cell) {
  std::vector<std::string> notes = cell.damage;
  for (const auto& recording : cell.sensors) {
    const auto left_out = recording.notes.find("left_out");
    if (left_out != recording.notes.end())
      notes.push_back(recording.sensor.str() + ": left out " + left_out->second);
  }
  return notes;
}

}  // namespace chorus::record
