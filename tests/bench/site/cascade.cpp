#include "tests/bench/site/cascade.h"

#include <fmt/format.h>

namespace chorus::bench {
namespace {

Skeleton<WorldSpace> in_hall(const site::Person& person, const Eigen::Isometry3d& site_from_cell) {
  Skeleton<WorldSpace> body;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    if (!person.joints[i]) continue;
    body.joints[i].position = site_from_cell * *person.joints[i];
    body.joints[i].state = JointState::Tracked;
  }
  return body;
}

SensorView view_of(const HallCell& cell, const site::Person& person) {
  SensorView view;
  view.sensor = cell.id;
  view.body = BodyId{person.body.value};
  view.eye = cell.stated.site_from_cell * Eigen::Vector3d(0, 2.0, 0);
  view.place_covariance = cell.stated.covariance;
  view.skeleton = in_hall(person, cell.stated.site_from_cell);
  return view;
}

Eigen::Vector2d floor_place(const Eigen::Vector3d& x) { return {x.x(), x.z()}; }

/// Who the bodies are in truth.
std::map<std::pair<site::CellId, std::uint64_t>, const HallWord*> truth_of(const Hall& hall) {
  std::map<std::pair<site::CellId, std::uint64_t>, const HallWord*> all;
  for (const HallWord& word : hall.words())
    all[{hall.cells()[word.cell].id, word.body.value}] = &word;
  return all;
}

}  // namespace

HallAnswer Cascade::at(const Hall& hall) {
  associate::Scene scene;
  scene.instant = hall.clock(0) - hall.cells()[0].clock_ahead;
  for (std::size_t c = 0; c < hall.cells().size(); ++c) {
    for (const site::Person& person : hall.told(c).people)
      scene.views.push_back(view_of(hall.cells()[c], person));
  }
  associate::Grouping grouping = associate::group(std::move(scene), tracks_, {});
  tracks_ = std::move(grouping.tracks);
  const auto truth = truth_of(hall);
  HallAnswer answer;
  std::map<const HallWord*, std::uint64_t> given;
  for (const ::chorus::Person& person : grouping.people) {
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    for (const SensorView& view : person.views) {
      middle += floor_place(view.skeleton[JointId::SpineBase].position) /
                static_cast<double>(person.views.size());
      given[truth.at({view.sensor, view.body.value})] = person.id.value;
    }
    if (!person.views.empty()) answer.people.push_back({person.id.value, middle});
  }
  for (const auto& [key, word] : truth) {
    const auto id = given.find(word);
    answer.seen.push_back(
        {word->cell, word->person, id == given.end() ? "" : std::to_string(id->second), false});
  }
  return answer;
}

HallAnswer cells_alone(const Hall& hall) {
  HallAnswer answer;
  for (const HallWord& word : hall.words())
    answer.seen.push_back(
        {word.cell, word.person, fmt::format("{}:{}", word.cell, word.body.value), false});
  for (std::size_t c = 0; c < hall.cells().size(); ++c) {
    for (const site::Person& person : hall.told(c).people) {
      constexpr std::uint64_t kCellDigit = 1'000'000;
      answer.people.push_back({c * kCellDigit + person.body.value,
                               floor_place(hall.cells()[c].stated.site_from_cell * person.place)});
    }
  }
  return answer;
}

HallAnswer OverSite::at(Hall& hall) {
  HallAnswer answer;
  for (const HallWord& word : hall.words()) {
    const std::string id = word.id ? word.id->str() : "";
    answer.seen.push_back({word.cell, word.person, id, word.doubtful});
  }
  for (const site::SitePerson& person : hall.site(0).everybody(hall.clock(0))) {
    const auto number = numbers_.try_emplace(person.id.str(), numbers_.size() + 1).first->second;
    answer.people.push_back({number, floor_place(person.place)});
  }
  return answer;
}

}  // namespace chorus::bench
