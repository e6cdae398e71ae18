// Reads any lines as what a runner says: the first as its hello, the others as its answers to one
// image, with and without depth from people's size.  Each is read, or refused with a message, and
// what is read may be published.
#include <cstddef>
#include <cstdint>

#include "common/sensor/body_placer.h"
#include "services/sensor/device/camera/runner_wire.h"
#include "tests/fuzz/frame_checks.h"

namespace {

using namespace chorus;
using namespace chorus::camera;
using fuzz::require;

const Question kQuestion{42, from_unix_ns(1'795'246'200'250'000'000), {256, 144}};
constexpr const char* kUsualHello =
    R"({"type": "hello", "version": 1, "name": "n", "layout": "mediapipe_33"})";
constexpr double kFocalSigma = 0.1;

/// Checks the bodies as they were read, as rays, and again after they were placed as the device
/// does it.
void check_answer(bridge::PushedFrame frame) {
  fuzz::check_bodies(frame.bodies, kQuestion.captured);
  PlacingErrors errors;
  errors.focal = kFocalSigma;
  BodyPlacer placer;
  placer.place(frame.bodies, frame.shapes, errors);
  fuzz::check_bodies(frame.bodies, kQuestion.captured);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  std::string_view text(reinterpret_cast<const char*>(bytes), size);
  auto about = read_runner_hello(fuzz::next_line(text));
  if (!about) {
    require(!to_string(about.error()).empty());
    about = read_runner_hello(kUsualHello);
  }
  require(about.has_value() && about->max_side > 0);
  bridge::Hello hello = about->hello;
  hello.camera = sent_camera(Intrinsics{1280, 720, 1000, 1000, 640, 360, {0.04, -0.1, 0, 0, 0}},
                             kQuestion.size);
  hello.focal_sigma = kFocalSigma;
  while (!text.empty()) {
    const std::string_view line = fuzz::next_line(text);
    auto frame = read_runner_answer(line, kQuestion, hello);
    if (frame)
      check_answer(std::move(*frame));
    else
      require(!to_string(frame.error()).empty());
  }
  return 0;
}
