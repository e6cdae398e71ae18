#include "common/record/cell_writer.h"

#include <array>
#include <utility>

#include <nlohmann/json.hpp>

#include "common/record/floor_message.h"
#include "common/record/frame_schema.h"
#include "common/resource/inertial_calibration_resource.h"
#include "proto/embedded.h"

namespace chorus::record {
namespace {

struct SchemaRow {
  std::string_view name;
  std::string_view text;
};

/// Compares the applied shift, and whether the clock offset is known; its estimate and uncertainty
/// change all the time.
bool same(const ClockModel& a, const ClockModel& b) {
  return a.applied == b.applied && a.uncertainty.has_value() == b.uncertainty.has_value();
}

std::string clock_json(const SensorId& sensor, const ClockModel& clock) {
  const auto text = [](Duration d) { return std::to_string(d.count()); };
  nlohmann::json json{{"sensor", sensor.str()}, {"appliedNanoseconds", text(clock.applied)}};
  if (clock.uncertainty) {
    json["oursMinusTheirsNanoseconds"] = text(clock.ours_minus_theirs);
    json["uncertaintyNanoseconds"] = text(*clock.uncertainty);
  }
  return json.dump();
}

}  // namespace

std::string_view schema_text(std::string_view name) {
  const std::array kSchemas{SchemaRow{kFrameSchemaName, proto::frame_schema()},
                            SchemaRow{kFloorSchemaName, kFloorSchema},
                            SchemaRow{kClockSchemaName, kClockSchema},
                            SchemaRow{kRegistrationSchemaName, kRegistrationSchema},
                            SchemaRow{kOrientationsSchemaName, kOrientationsSchema},
                            SchemaRow{kCalibrationSchemaName, kCalibrationSchema},
                            SchemaRow{kMarkSchemaName, kMarkSchema},
                            SchemaRow{kSceneSchemaName, scene_schema()},
                            SchemaRow{kTransformsSchemaName, transforms_schema()}};
  for (const SchemaRow& row : kSchemas) {
    if (row.name == name) return row.text;
  }
  return {};
}

Result<CellWriter> CellWriter::create(const std::filesystem::path& path, const CellHead& head) {
  auto writer = RecordingWriter::create(path);
  if (!writer) return pass(writer);
  if (auto ok = writer->write_metadata(std::string(kMetadataName), head.metadata); !ok) {
    return pass(ok);
  }
  return CellWriter(std::move(*writer), head.single_sensor);
}

Result<void> CellWriter::put(const std::string& topic, std::string_view schema,
                             const Stamps& stamps, std::string text) {
  auto channel = channels_.find(topic);
  if (channel == channels_.end()) {
    const auto added =
        writer_.add_channel({topic, std::string(schema), std::string(schema_text(schema)), {}});
    if (!added) return pass(added);
    channel = channels_.emplace(topic, *added).first;
  }
  return writer_.write(channel->second, {{},
                                         static_cast<std::uint32_t>(stamps.sequence),
                                         stamps.logged,
                                         stamps.published,
                                         std::move(text)});
}

/// Writes the floor and the clock, if they have changed, before the frame, which does not contain
/// them.
Result<void> CellWriter::write_state(const RawFrame& raw, const std::string& prefix,
                                     const Stamps& stamps) {
  Stream& stream = streams_[raw.sensor];
  if (raw.floor && stream.floor != raw.floor) {
    if (auto ok = put(prefix + "floor-plane", kFloorSchemaName, stamps, floor_json(*raw.floor));
        !ok)
      return ok;
    stream.floor = raw.floor;
  }
  return write_clock(raw.sensor, raw.clock, prefix, stamps);
}

Result<void> CellWriter::write_clock(const SensorId& source, const ClockModel& clock,
                                     const std::string& prefix, const Stamps& stamps) {
  const auto before = clocks_.find(prefix);
  if (single_sensor_ || (before != clocks_.end() && same(before->second, clock))) return {};
  if (auto ok = put(prefix + "clock", kClockSchemaName, stamps, clock_json(source, clock)); !ok)
    return ok;
  clocks_[prefix] = clock;
  return {};
}

Result<void> CellWriter::write(const RawFrame& raw) {
  const std::string prefix = single_sensor_ ? "/" : "/sensors/" + raw.sensor.str() + "/";
  const Timestamp captured = raw.frame->captured;
  const Stamps stamps{single_sensor_ ? captured : raw.received, captured, raw.frame->sequence};
  if (auto ok = write_state(raw, prefix, stamps); !ok) return ok;
  if (auto ok = put(prefix + "frame", kFrameSchemaName, stamps,
                    resource::write(*raw.frame, resource::Format::Json));
      !ok)
    return ok;
  return put(prefix + "scene", kSceneSchemaName, stamps,
             scene_update(*raw.frame, raw.sensor.str()));
}

Result<void> CellWriter::write(const RawOrientations& raw) {
  const std::string prefix = "/inertial/" + raw.source.str() + "/";
  const Timestamp captured = raw.orientations->captured;
  const Stamps stamps{single_sensor_ ? captured : raw.received, captured,
                      raw.orientations->sequence};
  if (auto ok = write_clock(raw.source, raw.clock, prefix, stamps); !ok) return ok;
  return put(prefix + "orientations", kOrientationsSchemaName, stamps,
             resource::write(*raw.orientations, resource::Format::Json));
}

Result<void> CellWriter::write(const CalibrationChanged& changed) {
  return put("/inertial/" + changed.source.str() + "/calibration", kCalibrationSchemaName,
             {changed.at, changed.calibration.made, 0},
             resource::write(changed.calibration, resource::Format::Json));
}

Result<void> CellWriter::write(const FusedFrame& fused) {
  const resource::FrameResource frame = fused.frame();
  const Stamps stamps{fused.published, fused.instant, frame.sequence};
  if (auto ok =
          put("/frame", kFrameSchemaName, stamps, resource::write(frame, resource::Format::Json));
      !ok)
    return ok;
  return put("/scene", kSceneSchemaName, stamps, scene_update(frame, kWorldFrame));
}

Result<void> CellWriter::write(const PlacesChanged& places) {
  const Stamps stamps{places.at, places.at, 0};
  if (auto ok = put("/registration", kRegistrationSchemaName, stamps, places.registration); !ok)
    return ok;
  return put("/transforms", kTransformsSchemaName, stamps,
             frame_transforms(places.at, places.places));
}

Result<void> CellWriter::write(const Marked& mark) {
  return put(std::string(kMarksTopic), kMarkSchemaName, {mark.at, mark.at, 0}, mark_json(mark));
}

}  // namespace chorus::record
