#include "services/ctl/convert/import_output.h"

#include <iostream>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "common/record/frame_recording.h"
#include "common/record/frame_schema.h"
#include "common/record/fused_frames.h"
#include "common/record/recording_stream.h"
#include "common/resource/frame_resource.h"
#include "fusion-server/server/registration_store.h"
#include "fusion-server/wire/registration_file.h"
#include "services/ctl/line/text_file.h"

namespace chorus::ctl {
namespace {

namespace fs = std::filesystem;

/// Published extrinsics as a registration that is valid: the first sensor is the master.
Registration registration_of(const importers::ImportedSet& set) {
  Registration registration;
  registration.version = 1;
  registration.verdict = Verdict::Good;
  registration.solved = set.recordings.front().frames.front().captured;
  registration.master = set.recordings.front().sensor;
  for (const auto& [sensor, world_from_sensor] : set.world_from_sensor) {
    Extrinsics& place = registration.sensors[sensor];
    place.world_from_sensor = world_from_sensor;
    place.chain = {sensor};
  }
  return registration;
}

resource::BodyResource truth_body(const importers::TruthFrame& truth, Timestamp captured) {
  resource::BodyResource body;
  body.id = truth.person;
  body.captured = captured;
  for (std::size_t j = 0; j < kJointCount; ++j)
    body.joints[j] = {truth.skeleton.joints[j], std::nullopt, 0};
  return body;
}

/// Writes the true poses at the capture times of the first recording.
Result<void> write_truth(const fs::path& file, const importers::ImportedSet& set) {
  const auto& frames = set.recordings.front().frames;
  std::string text;
  for (auto truth = set.truth.begin(); truth != set.truth.end();) {
    if (truth->index >= frames.size()) break;
    resource::FrameResource frame;
    frame.sequence = truth->index + 1;
    frame.captured = frames[truth->index].captured;
    frame.source = "truth";
    frame.space = resource::SpaceKind::World;
    for (; truth != set.truth.end() && truth->index + 1 == frame.sequence; ++truth)
      frame.bodies.push_back(truth_body(*truth, frame.captured));
    text += record::frame_line(frame);
  }
  return write_text(file.string(), text);
}

/// True unless the file is known to be an import: one that cannot be read may be a recording whose
/// head is damaged, and can perhaps be salvaged.
bool may_be_recorded(const fs::path& file) {
  std::error_code unknown;
  if (!fs::exists(file, unknown)) return false;
  const auto recording = record::RecordingStream::open(file);
  if (!recording) return true;
  const auto& metadata = recording->metadata();
  const auto found = metadata.find(std::string(record::kMetadataName));
  return found != metadata.end() && found->second.contains("recording");
}

/// Refuses to overwrite a recording; an import may be replaced, because it can be repeated.
Result<void> spare_recording(const fs::path& file) {
  if (!may_be_recorded(file)) return {};
  return fail(ErrorCode::Conflict, file.string(),
              "was recorded, not imported, or cannot be read, and is never overwritten. Name "
              "another --out or --sensor.");
}

Result<void> spare_recordings(const fs::path& folder, const importers::ImportedSet& set) {
  for (const auto& recording : set.recordings) {
    const auto ok = spare_recording(folder / (recording.sensor.str() + ".mcap"));
    if (!ok) return ok;
  }
  return {};
}

/// Refuses to replace extrinsics that also place sensors which are not imported here: these would
/// have no place any more.
Result<void> spare_places(const fs::path& file, const importers::ImportedSet& set) {
  std::error_code unknown;
  if (set.world_from_sensor.empty() || !fs::exists(file, unknown)) return {};
  const auto there = server::load_registration_file(file.string());
  std::string others;
  for (const auto& [sensor, place] : there ? there->sensors : decltype(there->sensors){}) {
    if (!set.world_from_sensor.contains(sensor))
      others += (others.empty() ? "" : ", ") + sensor.str();
  }
  if (there && others.empty()) return {};
  return fail(ErrorCode::Conflict, file.string(),
              there ? "says where " + others + " stand, and would be replaced. Name another --out."
                    : "is there, and is no registration. Name another --out.");
}

}  // namespace

Result<std::vector<fs::path>> write_set(const fs::path& folder, const importers::ImportedSet& set) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) return fail(ErrorCode::Io, folder.string(), failed.message());
  if (auto ok = spare_recordings(folder, set); !ok) return pass(ok);
  if (auto ok = spare_places(folder / "registration.json", set); !ok) return pass(ok);
  std::vector<fs::path> written;
  for (const auto& recording : set.recordings) {
    written.push_back(folder / (recording.sensor.str() + ".mcap"));
    const auto done = record::write_frame_recording(written.back(), recording);
    if (!done) return pass(done);
  }
  if (!set.world_from_sensor.empty()) {
    written.push_back(folder / "registration.json");
    const auto done =
        write_text(written.back().string(), wire::write_registration(registration_of(set)));
    if (!done) return pass(done);
  }
  if (!set.truth.empty()) {
    written.push_back(folder / "truth.ndjson");
    if (const auto done = write_truth(written.back(), set); !done) return pass(done);
  }
  return written;
}

Result<void> make_room_for(const fs::path& file) {
  std::error_code failed;
  fs::create_directories(file.parent_path(), failed);
  if (failed) return fail(ErrorCode::Io, file.parent_path().string(), failed.message());
  if (auto ok = spare_recording(file); !ok) return ok;
  fs::remove(file, failed);
  return {};
}

void warn_of_strangers(const fs::path& folder, const std::vector<fs::path>& written) {
  const std::set<fs::path> ours(written.begin(), written.end());
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (entry.path().extension() == ".mcap" && ours.count(entry.path()) == 0)
      std::cerr << fmt::format("note: {} was there before and is not part of this import.\n",
                               entry.path().string());
  }
}

}  // namespace chorus::ctl
