#include "common/importers/landmarks.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "common/importers/json_values.h"
#include "common/importers/uniform_clock.h"

namespace chorus::importers {
namespace {

constexpr double kMaxPixel = 1e5;
constexpr double kMaxSeconds = 7 * 24 * 3600.0;
constexpr int kMaxHz = 1000;

struct Share {
  std::size_t landmark = 0;
  double weight = 0.0;
};

struct JointRecipe {
  JointId joint;
  std::array<Share, 4> shares;  ///< Weights sum to one; unused shares weigh nothing.
};

// MediaPipe numbers: 7/8 ears, 11/12 shoulders, 13/14 elbows, 15/16 wrists, 17/18 little finger and
// 19/20 index knuckles, 21/22 thumbs, 23/24 hips, 25/26 knees, 27/28 ankles, 31/32 toes.
// clang-format off
constexpr std::array<JointRecipe, kJointCount> kRecipes{{
    {JointId::SpineBase,     {{{23, 0.5}, {24, 0.5}}}},
    {JointId::SpineMid,      {{{23, 0.25}, {24, 0.25}, {11, 0.25}, {12, 0.25}}}},
    {JointId::Neck,          {{{11, 1.0 / 3}, {12, 1.0 / 3}, {7, 1.0 / 6}, {8, 1.0 / 6}}}},
    {JointId::Head,          {{{7, 0.5}, {8, 0.5}}}},
    {JointId::ShoulderLeft,  {{{11, 1.0}}}},
    {JointId::ElbowLeft,     {{{13, 1.0}}}},
    {JointId::WristLeft,     {{{15, 1.0}}}},
    {JointId::HandLeft,      {{{15, 0.5}, {17, 0.25}, {19, 0.25}}}},
    {JointId::ShoulderRight, {{{12, 1.0}}}},
    {JointId::ElbowRight,    {{{14, 1.0}}}},
    {JointId::WristRight,    {{{16, 1.0}}}},
    {JointId::HandRight,     {{{16, 0.5}, {18, 0.25}, {20, 0.25}}}},
    {JointId::HipLeft,       {{{23, 1.0}}}},
    {JointId::KneeLeft,      {{{25, 1.0}}}},
    {JointId::AnkleLeft,     {{{27, 1.0}}}},
    {JointId::FootLeft,      {{{31, 1.0}}}},
    {JointId::HipRight,      {{{24, 1.0}}}},
    {JointId::KneeRight,     {{{26, 1.0}}}},
    {JointId::AnkleRight,    {{{28, 1.0}}}},
    {JointId::FootRight,     {{{32, 1.0}}}},
    {JointId::SpineShoulder, {{{11, 0.5}, {12, 0.5}}}},
    {JointId::HandTipLeft,   {{{17, 0.5}, {19, 0.5}}}},
    {JointId::ThumbLeft,     {{{21, 1.0}}}},
    {JointId::HandTipRight,  {{{18, 0.5}, {20, 0.5}}}},
    {JointId::ThumbRight,    {{{22, 1.0}}}},
}};
// clang-format on

Joint joint_of(const JointRecipe& recipe, const Landmarks& landmarks) {
  Joint joint;
  joint.state = JointState::Tracked;
  for (const Share& share : recipe.shares) {
    if (share.weight == 0.0) continue;
    const Landmark& landmark = landmarks[share.landmark];
    const JointState state =
        landmark.position.allFinite() ? landmark.state : JointState::NotTracked;
    joint.state = std::min(joint.state, state);
    joint.position += share.weight * landmark.position;
  }
  if (joint.state == JointState::NotTracked) joint.position.setZero();
  return joint;
}

/// `rows` arrays of three numbers each, 33 of them.
Result<void> read_triples(const nlohmann::json& array, double bound, const std::string& at,
                          std::array<std::array<double, 3>, kLandmarkCount>& out) {
  if (!array.is_array() || array.size() != kLandmarkCount)
    return fail(ErrorCode::Malformed, at, fmt::format("must hold {} landmarks.", kLandmarkCount));
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    const auto read = read_numbers(array[i], out[i], bound, fmt::format("{}[{}]", at, i));
    if (!read) return pass(read);
  }
  return {};
}

Result<LandmarkSight> read_sight(const nlohmann::json& image, const nlohmann::json& world,
                                 const std::string& at) {
  std::array<std::array<double, 3>, kLandmarkCount> seen{};
  std::array<std::array<double, 3>, kLandmarkCount> metres{};
  if (const auto read = read_triples(image, kMaxPixel, at + ".image", seen); !read)
    return pass(read);
  if (const auto read = read_triples(world, kMaxCoordinate, at + ".world", metres); !read)
    return pass(read);
  LandmarkSight sight;
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    sight.pixel[i] = {seen[i][0], seen[i][1]};
    sight.visibility[i] = seen[i][2];
    sight.in_body[i] = {metres[i][0], metres[i][1], metres[i][2]};
  }
  return sight;
}

/// t_s is rounded to microseconds in the files; where it means a whole frame, that instant is
/// exact.
Duration frame_time(double t_s, int hz) {
  constexpr double kRounding = 2e-6;
  const double index = std::round(t_s * hz);
  if (std::abs(t_s - index / hz) > kRounding) return from_seconds(t_s);
  return uniform_instant(Timestamp{}, static_cast<std::size_t>(index), hz) - Timestamp{};
}

Result<LandmarkFrame> read_landmark_frame(const nlohmann::json& frame, int hz,
                                          const std::string& at) {
  const auto time = member(frame, "t_s", at);
  if (!time) return pass(time);
  if (!(*time)->is_number() || !((*time)->get<double>() >= 0.0) ||
      (*time)->get<double>() > kMaxSeconds)
    return fail(ErrorCode::Malformed, at, "\"t_s\" must be seconds since the start, 0 or more.");
  LandmarkFrame out{frame_time((*time)->get<double>(), hz), std::nullopt};
  const auto image = member(frame, "image", at);
  if (!image) return pass(image);
  if ((*image)->is_null() || (*image)->empty()) return out;
  const auto world = member(frame, "world", at);
  if (!world) return pass(world);
  const auto sight = read_sight(**image, **world, at);
  if (!sight) return pass(sight);
  out.sight = *sight;
  return out;
}

Result<int> read_rate(const nlohmann::json& document, const std::string& at) {
  const auto fps = member(document, "fps", at);
  if (!fps) return pass(fps);
  if (!(*fps)->is_number_integer() || *(*fps) < 1 || *(*fps) > kMaxHz)
    return fail(ErrorCode::Malformed, at, fmt::format("\"fps\" must be 1 to {}.", kMaxHz));
  return (*fps)->get<int>();
}

}  // namespace

Result<LandmarkView> read_landmark_view(const std::filesystem::path& file,
                                        const ImportLimits& limits) {
  const std::string at = file.string();
  const auto document = read_json(file, limits.max_json_bytes);
  if (!document) return pass(document);
  const auto camera = member(*document, "camera", at);
  if (!camera) return pass(camera);
  const auto hz = read_rate(*document, at);
  if (!hz) return pass(hz);
  const auto frames = member(*document, "frames", at);
  if (!frames) return pass(frames);
  if (!(*camera)->is_string() || !(*frames)->is_array() || (*frames)->empty())
    return fail(ErrorCode::Malformed, at, "needs \"camera\", a name, and \"frames\", an array.");
  LandmarkView view{(*camera)->get<std::string>(), {}};
  for (std::size_t i = 0; i < (*frames)->size(); ++i) {
    const auto frame =
        read_landmark_frame((**frames)[i], *hz, fmt::format("{}: frames[{}]", at, i));
    if (!frame) return pass(frame);
    if (!view.frames.empty() && frame->at <= view.frames.back().at)
      return fail(ErrorCode::Malformed, fmt::format("{}: frames[{}]", at, i),
                  "\"t_s\" must grow from frame to frame.");
    view.frames.push_back(*frame);
  }
  return view;
}

std::array<Joint, kJointCount> joints_of(const Landmarks& landmarks) {
  std::array<Joint, kJointCount> joints;
  for (const JointRecipe& recipe : kRecipes)
    joints[index_of(recipe.joint)] = joint_of(recipe, landmarks);
  return joints;
}

}  // namespace chorus::importers
