// The MVN stream of a suit: any bytes, as datagrams and as a stream, give only poses that a suit
// can send.
#include <cstdint>
#include <cstdlib>

#include "common/sensor/limits.h"
#include "common/suit/mxtp_decoder.h"
#include "common/suit/walk.h"

namespace {

using namespace chorus;
using namespace chorus::suit;

void require(bool holds) {
  if (!holds) std::abort();
}

void check(const MxtpPose& pose, Walk& walk) {
  require(pose.name.size() <= 100);
  for (const Joint& joint : pose.body.joints) {
    if (joint.seen()) require(joint.position.cwiseAbs().maxCoeff() < 2.0 * kMaxCoordinate);
  }
  const Walked& walked = walk.next(pose_of(pose.body, std::chrono::milliseconds(pose.time_ms)));
  require(walked.place.allFinite() && walked.covariance.allFinite());
}

}  // namespace

/// The first byte chooses: one stream, or datagrams with two bytes for the length of each.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  if (size < 1) return 0;
  MxtpDecoder decoder;
  Walk walk;
  const auto take = [&](std::span<const char> datagram) {
    const auto pose = decoder.take(datagram);
    if (pose && *pose) check(**pose, walk);
  };
  std::span<const char> left(reinterpret_cast<const char*>(bytes + 1), size - 1);
  if ((bytes[0] & 1) != 0) {
    MxtpStream stream;
    while (!left.empty()) {
      const std::size_t piece = std::min<std::size_t>(left.size(), 1000);
      if (!stream.add(left.first(piece))) return 0;
      left = left.subspan(piece);
      for (auto next = stream.next(); next && *next; next = stream.next()) take(**next);
    }
    return 0;
  }
  while (left.size() >= 2) {
    const std::size_t length = std::min<std::size_t>(
        static_cast<std::uint8_t>(left[0]) * 256U + static_cast<std::uint8_t>(left[1]),
        left.size() - 2);
    take(left.subspan(2, length));
    left = left.subspan(2 + length);
  }
  return 0;
}
