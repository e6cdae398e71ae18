#include "tests/bench/camera/four_views.h"

#include <cstdlib>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/base/units.h"
#include "fusion-server/pipeline/offline.h"
#include "services/sensor/device/camera/film.h"
#include "tests/judge/statistics.h"

namespace chorus::bench {
namespace {

using importers::ImportedSet;

/// Joints for which every network has a landmark of its own, so that networks can be compared.
constexpr std::array kLimbs{JointId::ShoulderLeft, JointId::ShoulderRight, JointId::ElbowLeft,
                            JointId::ElbowRight,   JointId::WristLeft,     JointId::WristRight,
                            JointId::HipLeft,      JointId::HipRight,      JointId::KneeLeft,
                            JointId::KneeRight,    JointId::AnkleLeft,     JointId::AnkleRight};

Result<ImportedSet> published() {
  importers::ImportOptions options;
  options.rays = true;
  return importers::import_files(importers::FileFormat::Pose2Sim, {kFourViews}, options);
}

using Tracks = std::vector<registration::WalkTrack>;

/// The lens and the video of a camera, as the demo configures them.
Result<camera::CameraSettings> settings_of(const std::string& id) {
  std::ifstream file(fmt::format("{}/{}.json", kFourVideos, id));
  const auto all = nlohmann::json::parse(file, nullptr, false, true);
  if (all.is_discarded()) return fail(ErrorCode::NotFound, id, "its configuration cannot be read");
  const auto& stated = all.at("device").at("camera");
  camera::CameraSettings settings;
  settings.source = stated.at("source");
  settings.loop = false;
  settings.max_rate_hz = kTruthHz;
  const auto& lens = stated.at("intrinsics");
  Intrinsics intrinsics;
  intrinsics.width = lens.at("width");
  intrinsics.height = lens.at("height");
  intrinsics.fx = lens.at("fx");
  intrinsics.fy = lens.at("fy");
  intrinsics.cx = lens.at("cx");
  intrinsics.cy = lens.at("cy");
  intrinsics.distortion = lens.at("distortion").get<std::array<double, 5>>();
  settings.intrinsics = intrinsics;
  return settings;
}

}  // namespace

std::vector<std::string> runner_of(const std::string& model) {
  return {"node", "services/pose-runner/runner.mjs", "--model", model};
}

Result<Agreement> fused(const Tracks& tracks, const ImportedSet& set) {
  pipeline::OfflineConfig config;  // as shipped
  config.rate_hz = kTruthHz;
  const auto result = pipeline::fuse_offline(tracks, published_places(set), config);
  if (!result) return pass(result);
  Agreement agreement;
  std::vector<bool> answered(set.truth.size(), false);
  for (const Snapshot& snapshot : result->snapshots) {
    const double at = seconds(snapshot.instant - importers::kDefaultStart) * kTruthHz;
    const auto index = static_cast<std::size_t>(std::max(0.0, std::round(at)));
    if (index >= set.truth.size() || snapshot.bodies.empty()) continue;
    agreement.add(snapshot.bodies.front().skeleton, set.truth[index].skeleton);
    answered[index] = true;
  }
  for (std::size_t i = 0; i < answered.size(); ++i) {
    if (!answered[i]) agreement.missed(set.truth[i].skeleton);
  }
  return agreement;
}

Answers::Answers() : folder_("/tmp/chorus-answers-XXXXXX") {
  if (mkdtemp(folder_.data()) == nullptr) folder_.clear();
}

Answers::~Answers() {
  std::error_code failed;
  if (!folder_.empty()) std::filesystem::remove_all(folder_, failed);
}

std::vector<std::string> Answers::runner_of(const std::string& model,
                                            const std::string& camera) const {
  return {"node", "tests/bench/camera/recalling_runner.mjs",
          fmt::format("{}/{}-{}.jsonl", folder_, model, camera), "--model", model};
}

Result<Tracks> looked_at(const std::string& model, const ImportedSet& set, const Answers& answers) {
  Tracks tracks;
  for (const auto& recording : set.recordings) {
    auto settings = settings_of(recording.sensor.str());
    if (!settings) return pass(settings);
    auto film = camera::look_through({std::move(*settings),
                                      answers.runner_of(model, recording.sensor.str()),
                                      recording.sensor, importers::kDefaultStart});
    if (!film) return pass(film);
    tracks.push_back({recording.sensor, std::move(film->frames)});
  }
  return tracks;
}

Registration published_places(const ImportedSet& set) {
  Registration registration;
  registration.version = 1;
  registration.verdict = Verdict::Good;
  registration.master = set.recordings.front().sensor;
  for (const auto& [sensor, place] : set.world_from_sensor)
    registration.sensors[sensor].world_from_sensor = place;
  return registration;
}

void Agreement::missed(const Skeleton<WorldSpace>& published) {
  asked += static_cast<double>(std::ranges::count_if(published.joints, &Joint::seen));
}

void Agreement::add(const Skeleton<WorldSpace>& fused, const Skeleton<WorldSpace>& published) {
  missed(published);
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if (!fused.joints[j].seen() || !published.joints[j].seen()) continue;
    const double error = (fused.joints[j].position - published.joints[j].position).norm();
    errors.push_back(error);
    if (std::ranges::find(kLimbs, static_cast<JointId>(j)) != kLimbs.end()) limbs.push_back(error);
  }
}

void Agreement::report(Report& report, const std::string& name) const {
  report.row(name, "limb_median_mm", to_mm(percentile(limbs, 0.5)), "mm");
  report.row(name, "joint_median_mm", to_mm(percentile(errors, 0.5)), "mm");
  report.row(name, "joint_p90_mm", to_mm(percentile(errors, 0.9)), "mm");
  report.row(name, "missing_percent",
             100.0 * (1.0 - static_cast<double>(errors.size()) / std::max(1.0, asked)), "%");
}

Result<void> four_views(Report& report) {
  const auto set = published();
  if (!set) return pass(set);
  Tracks tracks;
  for (const auto& recording : set->recordings)
    tracks.push_back({recording.sensor, recording.frames});
  const auto landmarks = fused(tracks, *set);
  if (!landmarks) return pass(landmarks);
  landmarks->report(report, "four-views-landmarks");
  constexpr double kTarget = 0.040;  // [m]
  report.condition("four-views-landmarks: joints within 40 mm of the published triangulation",
                   percentile(landmarks->errors, 0.5) <= kTarget);
  if (report.quick()) return {};
  const Answers answers;
  for (const char* model : {"movenet", "blazepose-lite", "blazepose-full"}) {
    const auto looked = looked_at(model, *set, answers);
    if (!looked) return pass(looked);
    const auto agreement = fused(*looked, *set);
    if (!agreement) return pass(agreement);
    agreement->report(report, fmt::format("four-views-pixels-{}", model));
  }
  report.note(
      "four-views: every picture of the videos (30 Hz), offline; joints beside the published "
      "linear triangulation of MediaPipe's landmarks, "
      "which "
      "is good to a few centimetres itself.  Target for pixels: 40 mm.  limb: the twelve joints "
      "that "
      "all networks have a landmark of their own for.");
  return {};
}

}  // namespace chorus::bench
