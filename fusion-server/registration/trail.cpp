#include "fusion-server/registration/trail.h"

#include <map>
#include <set>

#include "common/base/units.h"
#include "common/body/bones.h"

namespace chorus::registration {
namespace {

using enum JointId;

// Per-axis sigma of a tracked joint: coloured noise plus view-dependent bias (after Otto,
// Figs. 7 and 8).  Only the ratios matter.
constexpr std::array kNeckSlots{Slot{Neck, Neck, mm(9)}};
constexpr std::array kCoreSlots{
    Slot{Neck, Neck, mm(9)},
    Slot{SpineShoulder, SpineShoulder, mm(10)},
    Slot{Head, Head, mm(15)},
    Slot{SpineMid, SpineMid, mm(14)},
    Slot{ShoulderLeft, ShoulderRight, mm(12)},
    Slot{HipLeft, HipRight, mm(14)},
    Slot{ElbowLeft, ElbowRight, mm(20)},
    Slot{WristLeft, WristRight, mm(26)},
};

constexpr double limb_sigma(JointId id) {
  switch (id) {
    case Neck:
      return mm(9);
    case Head:
      return mm(15);
    case SpineShoulder:
      return mm(10);
    case SpineMid:
    case SpineBase:
      return mm(14);
    case ShoulderLeft:
    case ShoulderRight:
      return mm(16);
    case HipLeft:
    case HipRight:
      return mm(18);
    case ElbowLeft:
    case ElbowRight:
      return mm(22);
    default:
      return mm(30);
  }
}

constexpr std::array<Slot, kJointCount> all_slots() {
  std::array<Slot, kJointCount> slots{};
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const auto id = static_cast<JointId>(i);
    slots[i] = {id, id, limb_sigma(id)};
  }
  return slots;
}
constexpr std::array<Slot, kJointCount> kAllSlots = all_slots();

constexpr double kStandsStill = mm(30);                    // a person sways more than that
constexpr Duration kLongEnough = std::chrono::seconds(1);  // ... within this time

/// When and where a body was seen.
struct Stay {
  Timestamp first;
  Timestamp last;
  Eigen::AlignedBox3d necks;  ///< Around all its necks [m].

  [[nodiscard]] bool still() const {
    return last - first >= kLongEnough && !necks.isEmpty() &&
           necks.diagonal().norm() < kStandsStill;
  }
};

/// Bodies that do not move for as long as they are seen: furniture taken for a person, or somebody
/// who stands by.
std::set<BodyId> statues_of(const WalkTrack& walk) {
  std::map<BodyId, Stay> stays;
  for (const SensorFrame& frame : walk.frames) {
    for (const BodyFrame& body : frame.bodies) {
      Stay& stay = stays.try_emplace(body.id, frame.captured, frame.captured).first->second;
      stay.last = frame.captured;
      const Joint& neck = body.skeleton[Neck];
      if (neck.seen()) stay.necks.extend(neck.position);
    }
  }
  std::set<BodyId> statues;
  for (const auto& [id, stay] : stays) {
    if (stay.still()) statues.insert(id);
  }
  return statues;
}

/// The only body of the frame that is not a statue; none if there are several.
const BodyFrame* sole_body(const SensorFrame& frame, const std::set<BodyId>& statues) {
  const BodyFrame* sole = nullptr;
  for (const BodyFrame& body : frame.bodies) {
    if (statues.contains(body.id)) continue;
    if (sole != nullptr) return nullptr;
    sole = &body;
  }
  return sole;
}

bool usable(const Joint& joint) { return joint.state == JointState::Tracked && joint.seen(); }

TrailFrame reduce(const BodyFrame& body, Timestamp captured, std::span<const Slot> slots) {
  TrailFrame frame;
  frame.captured = captured;
  frame.body = body.id;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const Joint& first = body.skeleton[slots[i].first];
    const Joint& second = body.skeleton[slots[i].second];
    if (!usable(first) || !usable(second)) continue;
    frame.points[i] = 0.5 * (first.position + second.position);
    frame.seen |= 1U << i;
  }
  return frame;
}

constexpr double kStep = mm(12);

/// Distance between the middles of the slots that both frames have [m].
double moved_between(const TrailFrame& a, const TrailFrame& b) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int slots = 0;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    if (!a.has(i) || !b.has(i)) continue;
    sum += b.points[i] - a.points[i];
    ++slots;
  }
  return slots > 0 ? sum.norm() / slots : kStep;
}

void mark_rests(std::vector<TrailFrame>& frames) {
  const TrailFrame* last = nullptr;
  for (TrailFrame& frame : frames) {
    frame.moved =
        last == nullptr || last->body != frame.body || moved_between(*last, frame) >= kStep;
    if (frame.moved) last = &frame;
  }
}

}  // namespace

std::span<const Slot> slots_of(JointChoice choice) {
  switch (choice) {
    case JointChoice::Neck:
      return kNeckSlots;
    case JointChoice::Core:
      return kCoreSlots;
    case JointChoice::All:
      return kAllSlots;
  }
  return kNeckSlots;
}

Trail trail_of(const WalkTrack& walk, JointChoice choice) {
  Trail trail;
  trail.sensor = walk.sensor;
  const std::set<BodyId> statues = statues_of(walk);
  trail.stood = !statues.empty();
  for (const SensorFrame& frame : walk.frames) {
    const BodyFrame* body = sole_body(frame, statues);
    if (!body) continue;
    if (!trail.frames.empty() && frame.captured <= trail.frames.back().captured) continue;
    TrailFrame reduced = reduce(*body, frame.captured, slots_of(choice));
    if (reduced.seen != 0) trail.frames.push_back(std::move(reduced));
  }
  mark_rests(trail.frames);
  return trail;
}

std::string why_empty(const Trail& trail) {
  return "sensor " + trail.sensor.str() +
         (trail.stood ? " saw nobody who moved, only somebody or something that stood still: walk"
                      : " saw nobody alone during the walk");
}

Eigen::Vector3d middle_of(const Trail& trail) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0.0;
  for (const TrailFrame& frame : trail.frames) {
    if (!frame.has(0)) continue;
    sum += frame.points[0];
    count += 1.0;
  }
  return count > 0 ? Eigen::Vector3d(sum / count) : sum;
}

}  // namespace chorus::registration
