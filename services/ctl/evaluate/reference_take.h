// `chorus evaluate --reference`: optical markers or joints beside the tracker, in its time and
// world.
#pragma once

#include <string>
#include <vector>

#include "common/comparison/comparison.h"
#include "common/evaluation/place_error.h"
#include "common/evaluation/time_shift.h"
#include "common/evaluation/wearing.h"

namespace chorus::ctl {

struct ReferenceFile {
  std::string file;    ///< C3D, TRC, BVH or MVNX, or fused frames of another tracker.
  std::string joints;  ///< Which points make which joint (--reference-joints); "" by their names.
  std::string out;     ///< Folder for a template of that file, where names are not known.
  std::string unit;    ///< Of its lengths ("mm", a number of metres); "": as the file says.
};

/// The person whom the tracker saw, as the reference has them.
struct ReferenceTake {
  evaluation::TrackedBody body;  ///< In the tracker's time [s] and world.
  evaluation::BodyTrack places;  ///< The same person's joints, in the same time and world.
  evaluation::TimeShift shift;   ///< Added to the reference's times; its times begin at 0.
  std::size_t joints = 0;        ///< That both show.
  double rms = 0.0;              ///< Distance of these joints after both worlds are one [m].
  std::vector<std::string> notes;
};

/// Finds the shift from how fast bones turn, and the transform from the joints of both.  Of several
/// people of the reference, the one who moves as the tracker's does.  Refused, with what to change:
/// what cannot be read, names that are not known, fewer than three joints that both show, no time
/// in common, another motion, and bones of another length (a wrong unit).
[[nodiscard]] Result<ReferenceTake> read_reference(const ReferenceFile& source,
                                                   const comparison::Track& tracked);

/// The limbs of one person.
[[nodiscard]] evaluation::TrackedBody limbs_of(const comparison::Track& track);
/// The same track as the evaluation takes it.
[[nodiscard]] evaluation::BodyTrack places_of(const comparison::Track& track);

}  // namespace chorus::ctl
