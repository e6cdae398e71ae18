// A tracker frame in VRPN: which trackers there are, and their reports.
//
// Body0 has the joints as sensors 0..24 (the numbers of the Kinect v2 SDK).  Body0_Head and so on
// have only sensor 0, for clients that can read only sensor 0; so have things in hands, under their
// own names.  World axes, metres, quaternions x y
// z w; each frame has one time stamp, the time of its poses.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fusion-server/outlet/tracker_frame.h"

namespace chorus::vrpn {

/// The ids that we give to types; VRPN defines their names.
enum class ReportType : std::int32_t { Pong, PosQuat, Velocity };

/// The trackers that we announce; a tracker's index is its sender id.
class Trackers {
 public:
  /// `slots`: number of bodies; `each_joint`: adds one tracker per joint to that of each body;
  /// `props`: names of things in hands.
  Trackers(std::size_t slots, bool each_joint, const std::vector<std::string>& props = {});

  [[nodiscard]] std::size_t size() const { return names_.size(); }
  [[nodiscard]] std::optional<std::size_t> index_of(std::string_view name) const;
  [[nodiscard]] std::size_t body(std::size_t slot) const { return slot; }
  /// The tracker of a joint; none if joints have no trackers of their own.
  [[nodiscard]] std::optional<std::size_t> joint(std::size_t slot, std::size_t joint) const;

  /// The tracker of a thing in hands; none: it was not announced.
  [[nodiscard]] std::optional<std::size_t> prop(std::size_t index) const;

  /// The messages that describe all trackers and types to a client.
  [[nodiscard]] std::string descriptions() const;

 private:
  std::size_t slots_;
  bool each_joint_;
  std::size_t first_prop_ = 0;
  std::vector<std::string> names_;
};

/// One message in Reports::bytes.
struct Report {
  std::size_t tracker = 0;
  std::size_t begin = 0;
  std::size_t size = 0;
};

/// A frame's messages, encoded once for all clients; their sequence numbers are zero as yet.
struct Reports {
  std::string bytes;
  std::vector<Report> messages;
};

/// Pose and velocity of every joint; a joint that is not tracked is not sent.
[[nodiscard]] Reports encode(const outlet::TrackerFrame& frame, const Trackers& trackers);

}  // namespace chorus::vrpn
