// Eight real cameras with Vicon truth (tests/bench/camera/totalcapture_views.py makes the folders),
// and a suit that stands in for a real one.
#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include <fmt/format.h>

#include "common/base/units.h"
#include "common/importers/formats.h"
#include "common/positioning/take.h"
#include "common/suit/walk.h"
#include "tests/bench/positioner/position_errors.h"
#include "tests/bench/positioner/positioner_cases.h"
#include "tests/bench/positioner/suit_stand_in.h"

namespace chorus::bench {
namespace {

namespace fs = std::filesystem;
using positioning::CameraTake;

constexpr double kRate = 30.0;  // [Hz]
constexpr double kStature = 1.78;

fs::path views_folder() {
  const char* stated = std::getenv("CHORUS_EIGHT_VIEWS");
  return stated != nullptr ? stated : "../shared/data/totalcapture_views";
}

struct ViconTake {
  std::string name;
  std::vector<CameraTake> cameras;
  std::vector<Skeleton<WorldSpace>> bodies;
  std::vector<Eigen::Vector3d> roots;
};

Result<ViconTake> read_take(const fs::path& path) {
  importers::ImportOptions options;
  options.rays = true;
  const auto set = importers::import_files(importers::FileFormat::Pose2Sim, {path}, options);
  if (!set) return pass(set);
  ViconTake take;
  take.name = path.filename().string();
  std::size_t shortest = set->truth.size();
  for (const auto& recording : set->recordings) {
    take.cameras.push_back(
        {recording.sensor, set->world_from_sensor.at(recording.sensor), recording.frames});
    shortest = std::min(shortest, recording.frames.size());
  }
  for (std::size_t i = 0; i < shortest; ++i) {
    take.bodies.push_back(set->truth[i].skeleton);
    take.roots.push_back(set->truth[i].skeleton[JointId::SpineBase].position);
  }
  return take;
}

std::vector<FoundPlace> placed_places(const positioning::TakeResult& result, std::size_t count,
                                      bool smooth) {
  std::vector<FoundPlace> out(count);
  for (const positioning::Placed& one : result.placed) {
    const auto i = static_cast<std::size_t>(std::lround(seconds(one.time) * kRate));
    if (i >= count) continue;
    const positioning::Position& at = smooth ? one.smooth : one.online.position;
    out[i] = {at.place, at.covariance};
  }
  return out;
}

/// Each picture by itself.
std::vector<FoundPlace> pictures_alone(const ViconTake& take,
                                       const std::vector<CameraTake>& cameras,
                                       const suit::SuitTake& suit) {
  std::vector<FoundPlace> out(take.roots.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    std::vector<positioning::SeenRays> rays;
    for (const CameraTake& camera : cameras) {
      if (!camera.frames[i].bodies.empty())
        rays.push_back({camera.world_from_sensor, camera.frames[i].bodies.front().skeleton});
    }
    const auto fit = positioning::fit_landmarks(rays, suit.poses[i], {0.0, 0.15});
    if (fit) out[i] = {fit->place, fit->covariance.topLeftCorner<3, 3>()};
  }
  return out;
}

/// The suit alone, from the true beginning.
std::vector<FoundPlace> walked_places(const ViconTake& take, const suit::SuitTake& suit) {
  suit::Walk walk(kStature);
  std::vector<FoundPlace> out;
  Eigen::Vector3d begin = take.roots.front();
  begin.y() = 0.0;
  for (const suit::SuitPose& pose : suit.poses) {
    const suit::Walked& walked = walk.next(pose);
    out.push_back({begin + walked.place, walked.covariance});
  }
  return out;
}

struct Scored {
  PlaceScores online, offline, alone, walked;
  double clock = 0.0;
  double depth = 0.0;
  std::vector<double> pieces_along, pieces_across;
};

/// NEES of pieces as long as the four views' take: how far a take of 1.7 s may be from 1.
void add_pieces(const std::vector<FoundPlace>& places, const std::vector<Eigen::Vector3d>& roots,
                const Eigen::Vector3d& eye, Scored& out) {
  constexpr std::size_t kPiece = 51;  // Instants: 1.7 s.
  for (std::size_t i = 0; i + kPiece <= roots.size(); i += kPiece) {
    const auto at = static_cast<std::ptrdiff_t>(i), end = static_cast<std::ptrdiff_t>(i + kPiece);
    const PlaceScores piece = scores_of({places.begin() + at, places.begin() + end},
                                        {roots.begin() + at, roots.begin() + end}, eye);
    out.pieces_along.push_back(piece.nees_along);
    out.pieces_across.push_back(piece.nees_across);
  }
}

Result<Scored> score(const ViconTake& take, const std::vector<CameraTake>& cameras,
                     const suit::SuitTake& suit) {
  positioning::TakeSettings settings;
  settings.clocks.start = importers::kDefaultStart;
  settings.rate_hz = kRate;
  settings.clocks.offset_s = 0.0;
  settings.tracker.stature = kStature;
  const auto result = positioning::place_take(cameras, suit, settings);
  if (!result) return pass(result);
  const Eigen::Vector3d eye = cameras.front().world_from_sensor.translation();
  const std::size_t count = take.roots.size();
  Scored out;
  out.online = scores_of(placed_places(*result, count, false), take.roots, eye);
  add_pieces(placed_places(*result, count, false), take.roots, eye, out);
  out.offline = scores_of(placed_places(*result, count, true), take.roots, eye);
  out.alone = scores_of(pictures_alone(take, cameras, suit), take.roots, eye);
  out.walked = scores_of(walked_places(take, suit), take.roots, eye);
  out.depth = result->depth.front().first;
  settings.clocks.offset_s.reset();
  out.clock = positioning::fit_clocks(cameras, suit, settings.clocks).cameras.back().offset;
  return out;
}

double middle(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? kNoRatio : values[values.size() / 2];
}

template <class Member>
std::vector<double> each(const std::vector<Scored>& all, Member member) {
  std::vector<double> out;
  for (const Scored& one : all) out.push_back(member(one));
  return out;
}

void add_piece_rows(Report& report, const std::string& name, const char* axis,
                    const std::vector<Scored>& all, std::vector<double> Scored::*pieces) {
  std::vector<double> values;
  for (const Scored& one : all)
    values.insert(values.end(), (one.*pieces).begin(), (one.*pieces).end());
  std::sort(values.begin(), values.end());
  if (values.empty()) return;
  for (const int percent : {10, 50, 90})
    report.row(name, fmt::format("nees_{}_of_1.7s_{}_percent", axis, percent),
               values[(values.size() - 1) * static_cast<std::size_t>(percent) / 100], "1");
}

void add_rows(Report& report, const std::string& name, const std::vector<Scored>& all) {
  const auto row = [&](const char* metric, const char* unit, double scale, auto member,
                       const char* baseline = "", double beside = kNoRatio) {
    const double value = scale * middle(each(all, member));
    report.row(name, metric, value, unit, baseline, value / beside);
  };
  const double alone = 1000 * middle(each(all, [](const Scored& s) { return s.alone.rms; }));
  const double walked = 1000 * middle(each(all, [](const Scored& s) { return s.walked.rms; }));
  row(
      "online_rms_mm", "mm", 1000, [](const Scored& s) { return s.online.rms; }, "pictures", alone);
  row("online_median_mm", "mm", 1000, [](const Scored& s) { return s.online.median; });
  row("online_along_mm", "mm", 1000, [](const Scored& s) { return s.online.rms_along; });
  row("online_across_mm", "mm", 1000, [](const Scored& s) { return s.online.rms_across; });
  row(
      "offline_rms_mm", "mm", 1000, [](const Scored& s) { return s.offline.rms; }, "suit", walked);
  row("offline_median_mm", "mm", 1000, [](const Scored& s) { return s.offline.median; });
  row("pictures_rms_mm", "mm", 1000, [](const Scored& s) { return s.alone.rms; });
  row("suit_rms_mm", "mm", 1000, [](const Scored& s) { return s.walked.rms; });
  row("answered_percent", "%", 100, [](const Scored& s) { return s.online.answered; });
  row("online_nees_along", "1", 1, [](const Scored& s) { return s.online.nees_along; });
  row("online_nees_across", "1", 1, [](const Scored& s) { return s.online.nees_across; });
  row("offline_nees_along", "1", 1, [](const Scored& s) { return s.offline.nees_along; });
  row("offline_nees_across", "1", 1, [](const Scored& s) { return s.offline.nees_across; });
  row("suit_nees", "1", 1, [](const Scored& s) { return s.walked.nees_across; });
  row("clock_ms", "ms", 1000, [](const Scored& s) { return s.clock; });
  row("depth_error_percent", "%", 100, [](const Scored& s) { return s.depth; });
  add_piece_rows(report, name, "along", all, &Scored::pieces_along);
  add_piece_rows(report, name, "across", all, &Scored::pieces_across);
  const auto online = each(all, [](const Scored& s) { return s.online.rms; });
  report.row(name, "worst_online_rms_mm", 1000 * *std::max_element(online.begin(), online.end()),
             "mm");
}

Result<std::vector<ViconTake>> takes() {
  std::vector<ViconTake> out;
  for (const char* name : {"S1-freestyle2", "S2-freestyle1"}) {
    if (!fs::exists(views_folder() / name)) continue;
    auto take = read_take(views_folder() / name);
    if (!take) return pass(take);
    out.push_back(std::move(*take));
  }
  return out;
}

constexpr const char* kNoTakes =
    "eight-views: left out; the takes are not there (CHORUS_EIGHT_VIEWS, "
    "tests/bench/camera/totalcapture_views.py)";

struct Variant {
  const char* name;
  SuitErrors errors;
};

}  // namespace

Result<void> eight_views_alone(Report& report) {
  const auto all = takes();
  if (!all) return pass(all);
  if (all->empty()) report.note(kNoTakes);
  for (const ViconTake& take : *all) {
    for (const Variant& variant : {Variant{"", {}}, Variant{"-size+2%", {.size = 1.02}},
                                   Variant{"-heading-20deg", {.heading = deg(20.0)}}}) {
      const suit::SuitTake suit = suit_of(take.bodies, kRate, variant.errors);
      std::vector<Scored> scored;
      for (const CameraTake& camera : take.cameras) {
        const auto one = score(take, {camera}, suit);
        if (!one) return pass(one);
        scored.push_back(*one);
      }
      add_rows(report, "eight-views-vicon-" + take.name + variant.name, scored);
      if (report.quick()) break;
    }
  }
  return {};
}

Result<void> eight_views_pairs(Report& report) {
  const auto all = takes();
  if (!all) return pass(all);
  if (all->empty()) report.note(kNoTakes);
  for (const ViconTake& take : *all) {
    const suit::SuitTake suit = suit_of(take.bodies, kRate, {});
    std::vector<Scored> scored;
    for (std::size_t i = 0; i < take.cameras.size(); ++i) {
      for (std::size_t j = i + 1; j < take.cameras.size(); ++j) {
        const auto one = score(take, {take.cameras[i], take.cameras[j]}, suit);
        if (!one) return pass(one);
        scored.push_back(*one);
      }
    }
    add_rows(report, "two-of-eight-" + take.name, scored);
  }
  return {};
}

}  // namespace chorus::bench
