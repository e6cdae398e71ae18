// trackd / CAVELib shared memory: the blocks of the tracker and of the controller.
//
// Native byte order, 4-byte packed.  Layout according to the readers of VR Juggler and CalVR:
//   tracker     28 bytes: u32 version 1, count, offset 28, size 40, time s, time us, command
//   sensor      40 bytes: f32 x y z, azimuth elevation roll [deg]; u32 time s, us;
//               i32 calibrated, frame
//   controller  32 bytes: u32 version 1, button offset, valuator offset, counts, time s, us,
//               command; then i32 buttons, f32 valuators (all zero: bodies have no buttons)
// Right-handed, +y up, R = Ry(azimuth) Rx(elevation) Rz(roll); in feet, as CAVELib programs expect.
// Sensor 25 * slot + n: n = 0 the head, 1 the right hand (the wand), 2 the left hand, then all
// other joints in our order.  Things in hands are the last sensors, in the order of the
// configuration.  A sensor that nobody sees keeps its pose, is not calibrated, and does
// not move.
#pragma once

#include <span>
#include <vector>

#include "fusion-server/outlet/tracker_frame.h"

namespace chorus::trackd {

inline constexpr std::size_t kHeaderBytes = 28;
inline constexpr std::size_t kSensorBytes = 40;
inline constexpr std::size_t kButtons = 20;  ///< As many as readers expect.
inline constexpr std::size_t kValuators = 20;

enum class LengthUnit { Feet, Metres };

/// Number of the joint's sensor within its body, 0 to 24.
[[nodiscard]] std::size_t sensor_of(JointId joint);

/// The whole tracker block before any person has been seen.
[[nodiscard]] std::vector<char> tracker_block(std::size_t sensors);
[[nodiscard]] std::vector<char> controller_block();

/// Writes into a block made by tracker_block(), whose last `things` sensors are those of things in
/// hands; leaves out bodies' sensors beyond the others.  The header's
/// time stays unchanged: call write_stamp() afterwards, so that a reader that sees a new time sees
/// new sensors.
void write_sensors(const outlet::TrackerFrame& frame, LengthUnit unit, std::span<char> block,
                   std::size_t things = 0);
void write_stamp(Timestamp instant, std::span<char> block);

}  // namespace chorus::trackd
