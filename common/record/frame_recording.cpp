#include "common/record/frame_recording.h"

#include <array>
#include <charconv>
#include <cmath>
#include <system_error>
#include <utility>

#include "common/base/parse.h"
#include "common/record/cell_reader.h"
#include "common/record/floor_message.h"
#include "common/record/frame_schema.h"
#include "common/resource/frame_resource.h"
#include "proto/embedded.h"

namespace chorus::record {

namespace {

using Strings = std::map<std::string, std::string>;

constexpr std::string_view kFrameTopic = "/frame";
constexpr std::string_view kFloorTopic = "/floor-plane";
constexpr std::string_view kNotePrefix = "note.";
constexpr std::array<const char*, 5> kDistortion{"k1", "k2", "p1", "p2", "k3"};
constexpr int kMaxImage = 1 << 20;  // [pixels per side]

std::string text_of(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

std::optional<double> number_at(const Strings& values, const std::string& key) {
  const auto found = values.find(key);
  if (found == values.end()) return std::nullopt;
  const auto value = parse_number<double>(found->second);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::string text_at(const Strings& values, const std::string& key) {
  const auto found = values.find(key);
  return found == values.end() ? std::string{} : found->second;
}

std::optional<Intrinsics> intrinsics_of(const Strings& values) {
  const auto width = number_at(values, "width");
  const auto height = number_at(values, "height");
  const auto fx = number_at(values, "fx");
  const auto fy = number_at(values, "fy");
  const auto cx = number_at(values, "cx");
  const auto cy = number_at(values, "cy");
  if (!width || !height || !fx || !fy || !cx || !cy) return std::nullopt;
  if (*width < 1 || *width > kMaxImage || *height < 1 || *height > kMaxImage) {
    return std::nullopt;
  }
  Intrinsics camera{static_cast<int>(*width), static_cast<int>(*height), *fx, *fy, *cx, *cy, {}};
  for (std::size_t i = 0; i < kDistortion.size(); ++i) {
    camera.distortion[i] = number_at(values, kDistortion[i]).value_or(0.0);
  }
  if (text_at(values, "lens") == "fisheye") camera.model = LensModel::Fisheye;
  return camera;
}

std::optional<FloorPlane> floor_of(const Strings& values) {
  const auto x = number_at(values, "floor_normal_x");
  const auto y = number_at(values, "floor_normal_y");
  const auto z = number_at(values, "floor_normal_z");
  const auto d = number_at(values, "floor_offset");
  if (!x || !y || !z || !d) return std::nullopt;
  const auto plane = make_plane(*x, *y, *z, *d);
  return plane ? std::optional(*plane) : std::nullopt;
}

struct Channels {
  std::uint16_t frame = 0;
  std::uint16_t floor = 0;
};

Result<void> write_frames(RecordingWriter& writer, const Channels& channels,
                          const FrameRecording& recording) {
  const FloorPlane* floor = recording.floor ? &*recording.floor : nullptr;
  for (const SensorFrame& frame : recording.frames) {
    Message message{std::string(kFrameTopic),
                    static_cast<std::uint32_t>(frame.sequence),
                    frame.captured,
                    frame.captured,
                    {}};
    if (frame.floor && (floor == nullptr || *floor != *frame.floor)) {
      floor = &*frame.floor;
      message.data = floor_json(*floor);
      if (auto ok = writer.write(channels.floor, message); !ok) return ok;
    }
    message.data = resource::write(resource::to_resource(frame), resource::Format::Json);
    if (auto ok = writer.write(channels.frame, message); !ok) return ok;
  }
  return {};
}

Result<void> check_order(const std::vector<SensorFrame>& frames, const std::string& where) {
  for (std::size_t i = 1; i < frames.size(); ++i) {
    if (frames[i].captured > frames[i - 1].captured) continue;
    const bool repeats = frames[i].captured == frames[i - 1].captured;
    return fail(ErrorCode::Malformed, where,
                "frame " + std::to_string(i) + " of " + std::to_string(frames.size()) +
                    (repeats ? " repeats the capture time " : " goes back in time to ") +
                    to_iso8601(frames[i].captured));
  }
  return {};
}

Result<void> write_whole(const std::filesystem::path& path, const FrameRecording& recording) {
  auto writer = RecordingWriter::create(path);
  if (!writer) return pass(writer);
  if (auto ok = writer->write_metadata(std::string(kMetadataName), metadata_of(recording)); !ok) {
    return ok;
  }
  const auto frame = writer->add_channel({std::string(kFrameTopic),
                                          std::string(kFrameSchemaName),
                                          std::string(proto::frame_schema()),
                                          {}});
  if (!frame) return pass(frame);
  const auto floor = writer->add_channel(
      {std::string(kFloorTopic), std::string(kFloorSchemaName), std::string(kFloorSchema), {}});
  if (!floor) return pass(floor);
  if (auto ok = write_frames(*writer, {*frame, *floor}, recording); !ok) return ok;
  return writer->close();
}

}  // namespace

Strings metadata_of(const FrameRecording& recording) {
  Strings values{{"sensor", recording.sensor.str()}, {"device", recording.device}};
  if (const auto& camera = recording.intrinsics) {
    values["width"] = std::to_string(camera->width);
    values["height"] = std::to_string(camera->height);
    values["fx"] = text_of(camera->fx);
    values["fy"] = text_of(camera->fy);
    values["cx"] = text_of(camera->cx);
    values["cy"] = text_of(camera->cy);
    for (std::size_t i = 0; i < kDistortion.size(); ++i) {
      values[kDistortion[i]] = text_of(camera->distortion[i]);
    }
    if (camera->model == LensModel::Fisheye) values["lens"] = "fisheye";
  }
  if (const auto& floor = recording.floor) {
    values["floor_normal_x"] = text_of(floor->normal.x());
    values["floor_normal_y"] = text_of(floor->normal.y());
    values["floor_normal_z"] = text_of(floor->normal.z());
    values["floor_offset"] = text_of(floor->offset);
  }
  for (const auto& [name, note] : recording.notes) values[std::string(kNotePrefix) + name] = note;
  return values;
}

void read_metadata(const Strings& values, FrameRecording& out) {
  if (const auto id = SensorId::parse(text_at(values, "sensor"))) out.sensor = *id;
  out.device = text_at(values, "device");
  out.intrinsics = intrinsics_of(values);
  out.floor = floor_of(values);
  for (const auto& [key, value] : values) {
    if (key.starts_with(kNotePrefix)) out.notes[key.substr(kNotePrefix.size())] = value;
  }
}

Result<void> write_frame_recording(const std::filesystem::path& path,
                                   const FrameRecording& recording) {
  if (auto ok = check_order(recording.frames, path.string()); !ok) return ok;
  std::filesystem::path partial = path;
  partial += ".partial";
  std::error_code error;
  std::filesystem::remove(partial, error);
  auto ok = write_whole(partial, recording);
  if (ok) {
    std::filesystem::rename(partial, path, error);
    if (error) ok = fail(ErrorCode::Io, path.string(), error.message());
  }
  if (!ok) std::filesystem::remove(partial, error);
  return ok;
}

Result<FrameRecording> read_frame_recording(const std::filesystem::path& path,
                                            const ReadLimits& limits, const SensorId& which) {
  auto cell = read_cell(path, {.limits = limits, .only = which, .strict = true});
  if (!cell) return pass(cell);
  auto& sensors = cell->sensors;
  const bool any = which.str().empty() || cell->cell.empty();
  for (FrameRecording& one : sensors) {
    // A recording of one sensor may be read under any sensor name.
    if (one.sensor == which || (any && sensors.size() == 1)) return std::move(one);
  }
  std::string there;
  for (const SensorId& sensor : cell->cell) there += (there.empty() ? "" : ", ") + sensor.str();
  return fail(ErrorCode::NotFound, path.string(),
              there.empty() ? "it holds no frames of a sensor"
                            : "it holds the sensors " + there + "; name one of them, not \"" +
                                  which.str() + "\"");
}

}  // namespace chorus::record
