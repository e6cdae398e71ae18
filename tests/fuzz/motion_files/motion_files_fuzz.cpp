// Reads any bytes as C3D, BVH, HTR or MVNX: no crash, no endless loop, no NaN or infinity.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "common/motion/bvh.h"
#include "common/motion/c3d.h"
#include "common/motion/htr.h"
#include "common/motion/mvnx.h"

namespace {

void check(const chorus::motion::Motion& motion) {
  for (const auto& body : motion.frames) {
    for (const auto& joint : body.joints) {
      if (joint.state != chorus::JointState::NotTracked && !joint.position.allFinite())
        __builtin_trap();
    }
  }
}

void read_c3d(std::string_view bytes) {
  const auto c3d = chorus::motion::parse_c3d(bytes, "fuzz");
  if (!c3d) return;
  for (const auto& frame : c3d->frames) {
    if (frame.size() != c3d->labels.size()) __builtin_trap();
  }
  const auto motion = chorus::motion::motion_from_markers(*c3d);
  if (!motion) return;
  for (const auto& subject : motion->subjects) check(subject.motion);
}

void read_bvh(std::string_view bytes) {
  const auto bvh = chorus::motion::parse_bvh(bytes, "fuzz");
  if (!bvh) return;
  const auto motion = chorus::motion::motion_from_bvh(*bvh);
  if (motion) check(*motion);
}

void read_htr(std::string_view bytes) {
  const auto htr = chorus::motion::parse_htr(bytes, "fuzz");
  if (!htr) return;
  const auto motion = chorus::motion::motion_from_bvh(*htr);
  if (motion) check(*motion);
}

void read_mvnx(std::string_view bytes) {
  const auto mvnx = chorus::motion::parse_mvnx(bytes, "fuzz");
  if (!mvnx) return;
  const auto motion = chorus::motion::motion_from_mvnx(*mvnx);
  if (motion) check(*motion);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size);
  // A valid file's first bytes tell its format; all readers must refuse everything else.
  if (text.starts_with("HIERARCHY")) {
    read_bvh(text);
  } else if (text.starts_with('[')) {
    read_htr(text);
  } else if (text.starts_with('<')) {
    read_mvnx(text);
  } else {
    read_c3d(text);
  }
  return 0;
}
