#include "common/motion/stature.h"

#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace chorus::motion {
namespace {

using Id = JointId;

struct Limb {
  Id from;
  Id to;
  double share;  ///< Of the body's height.
};
constexpr std::array kLegs{
    Limb{Id::HipLeft, Id::KneeLeft, 0.245}, Limb{Id::KneeLeft, Id::AnkleLeft, 0.246},
    Limb{Id::HipRight, Id::KneeRight, 0.245}, Limb{Id::KneeRight, Id::AnkleRight, 0.246}};
constexpr std::array kArms{
    Limb{Id::ShoulderLeft, Id::ElbowLeft, 0.186}, Limb{Id::ElbowLeft, Id::WristLeft, 0.146},
    Limb{Id::ShoulderRight, Id::ElbowRight, 0.186}, Limb{Id::ElbowRight, Id::WristRight, 0.146}};
constexpr std::array kTrunk{Limb{Id::SpineBase, Id::Head, 0.39}};

template <class Space, std::size_t count>
std::optional<double> height_by(const Skeleton<Space>& body, const std::array<Limb, count>& limbs) {
  double length = 0.0;
  double share = 0.0;
  for (const Limb& limb : limbs) {
    if (!body[limb.from].seen() || !body[limb.to].seen()) continue;
    length += (body[limb.to].position - body[limb.from].position).norm();
    share += limb.share;
  }
  return share > 0.0 ? std::optional(length / share) : std::nullopt;
}

}  // namespace

template <class Space>
std::optional<double> stature_of(const Skeleton<Space>& body) {
  if (const auto height = height_by(body, kLegs)) return height;
  if (const auto height = height_by(body, kArms)) return height;
  return height_by(body, kTrunk);
}

template std::optional<double> stature_of(const Skeleton<WorldSpace>&);
template std::optional<double> stature_of(const Skeleton<SensorSpace>&);

UnitGuess fitting_unit(double stature, double metres) {
  constexpr std::array<std::pair<std::string_view, double>, 5> kUnits{
      {{"cm", 0.01}, {"m", 1.0}, {"mm", 0.001}, {"in", 0.0254}, {"0.05644", 0.0254 / 0.45}}};
  constexpr double kUsual = 1.7;    // [m]
  constexpr double kTallest = 2.2;  // more is rather a short person in another unit [m]
  const double in_units = stature / metres;
  const auto off = [&](double unit) { return std::abs(std::log(in_units * unit / kUsual)); };
  const std::pair<std::string_view, double>* best = nullptr;
  for (const auto& each : kUnits) {
    const double height = in_units * each.second;
    if (!(height >= kShortestPerson && height <= kTallest)) continue;
    if (best == nullptr || off(each.second) < off(best->second)) best = &each;
  }
  if (best != nullptr) return {std::string(best->first), best->second};
  const double factor = in_units > 0.0 ? kUsual / in_units : 1.0;
  return {fmt::format("{:.3g}", factor), factor, false};
}

}  // namespace chorus::motion
