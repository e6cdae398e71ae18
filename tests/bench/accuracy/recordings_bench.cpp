// chorus-bench recordings: real Kinect recordings that may not be distributed with the project,
// read from ../shared/data (or $CHORUS_SHARED/data); skipped, with a note, where that is absent.
//
// The posture weights were learned from two of these recordings; nothing else is tuned on any of
// them.
#include <array>
#include <cstdlib>

#include <fmt/format.h>

#include "tests/bench/accuracy/recordings.h"

namespace chorus::bench {
namespace {

namespace fs = std::filesystem;

fs::path shared_folder() {
  const char* given = std::getenv("CHORUS_SHARED");
  return fs::path(given != nullptr ? given : "../shared") / "data";
}

struct Part {
  const char* folder;
  Result<void> (*run)(Report&, const fs::path&);
};
constexpr std::array kParts{Part{"keraal_kinect2_optical", compare_with_keraal},
                            Part{"nw_ucla_3kinect", close_nw_ucla_chains},
                            Part{"ntu_rgbd_kinect2", refuse_ntu_poses},
                            Part{"kinect2_labanotation", time_labanotation},
                            Part{"kinect2_labanotation", side_labanotation},
                            Part{"keraal_kinect2_optical", side_keraal},
                            Part{"ntu_rgbd_kinect2", side_ntu},
                            Part{"nw_ucla_3kinect", side_nw_ucla},
                            Part{"nw_ucla_3kinect", toes_nw_ucla}};

}  // namespace

Result<void> run_recordings(Report& report) {
  const fs::path data = shared_folder();
  for (const Part& part : kParts) {
    const fs::path folder = data / part.folder;
    if (!fs::is_directory(folder)) {
      report.note(fmt::format("left out: {} is not here", part.folder));
      continue;
    }
    if (auto done = part.run(report, folder); !done) return done;
  }
  report.note(
      "sides-*: share of the frames whose left and right are right after the pipeline of one "
      "sensor; "
      "weights of posture were learned from Labanotation and KERAAL, not from NTU and NW-UCLA.");
  report.note(
      "Real recordings; nothing else in Chorus was tuned on them.  KERAAL's targets sit on the "
      "skin, "
      "some centimetres from joint centres: the first row says so, the second takes each "
      "target's mean place off.  NW-UCLA has no clocks and trimmed clips.");
  return {};
}

}  // namespace chorus::bench
