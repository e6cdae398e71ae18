// Azure Kinect (or an Orbbec Femto with Orbbec's K4A wrapper) with its body tracking SDK.  Not run here: see README.md.
//
//   c++ -std=c++17 -O2 -I.. -o azure_kinect azure_kinect.cpp -lk4a -lk4abt
//   ./azure_kinect 127.0.0.1:8081 [token]
#include <k4a/k4a.h>
#include <k4abt.h>

#include <iostream>

#include "chorus_push.h"

namespace {

/// UTC of the SDK's stamp [ns]; the SDK stamps an image by the computer's monotonic clock when it arrives.
std::int64_t utc_of(std::uint64_t monotonic_ns) {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return chorus::now_ns() - std::chrono::duration_cast<std::chrono::nanoseconds>(now).count() +
         static_cast<std::int64_t>(monotonic_ns);
}

std::int64_t captured_of(k4a_capture_t capture) {
  k4a_image_t depth = k4a_capture_get_depth_image(capture);
  const std::int64_t captured = depth != nullptr ? utc_of(k4a_image_get_system_timestamp_nsec(depth)) : chorus::now_ns();
  if (depth != nullptr) k4a_image_release(depth);
  return captured;
}

void add_body(chorus::Frame& frame, k4abt_frame_t tracked, std::uint32_t index) {
  k4abt_skeleton_t skeleton;
  if (k4abt_frame_get_body_skeleton(tracked, index, &skeleton) != K4A_RESULT_SUCCEEDED) return;
  frame.body(k4abt_frame_get_body_id(tracked, index));
  for (const k4abt_joint_t& joint : skeleton.joints) {
    const double confidence = joint.confidence_level >= K4ABT_JOINT_CONFIDENCE_MEDIUM ? 1.0
                              : joint.confidence_level == K4ABT_JOINT_CONFIDENCE_LOW  ? 0.5
                                                                                      : 0.0;
    frame.point(joint.position.xyz.x / 1000.0, joint.position.xyz.y / 1000.0, joint.position.xyz.z / 1000.0, confidence);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::string where = argc > 1 ? argv[1] : "127.0.0.1:8081";
  k4a_device_t device = nullptr;
  k4a_device_configuration_t cameras = K4A_DEVICE_CONFIG_INIT_DISABLE_ALL;
  cameras.depth_mode = K4A_DEPTH_MODE_NFOV_UNBINNED;
  cameras.camera_fps = K4A_FRAMES_PER_SECOND_30;
  k4a_calibration_t calibration;
  k4abt_tracker_t tracker = nullptr;
  if (k4a_device_open(0, &device) != K4A_RESULT_SUCCEEDED || k4a_device_start_cameras(device, &cameras) != K4A_RESULT_SUCCEEDED ||
      k4a_device_get_calibration(device, cameras.depth_mode, cameras.color_resolution, &calibration) != K4A_RESULT_SUCCEEDED ||
      k4abt_tracker_create(&calibration, K4ABT_TRACKER_CONFIG_DEFAULT, &tracker) != K4A_RESULT_SUCCEEDED) {
    std::cerr << "the camera or its body tracking does not start\n";
    return 1;
  }
  chorus::Pusher pusher(where, R"({"type":"hello","name":"Azure Kinect","layout":"azure_kinect_32","axes":"right down ahead"})",
                        argc > 2 ? argv[2] : "");
  k4a_capture_t capture = nullptr;
  while (k4a_device_get_capture(device, &capture, K4A_WAIT_INFINITE) == K4A_WAIT_RESULT_SUCCEEDED) {
    chorus::Frame frame(captured_of(capture));
    const bool queued = k4abt_tracker_enqueue_capture(tracker, capture, K4A_WAIT_INFINITE) == K4A_WAIT_RESULT_SUCCEEDED;
    k4a_capture_release(capture);
    k4abt_frame_t tracked = nullptr;
    if (!queued || k4abt_tracker_pop_result(tracker, &tracked, K4A_WAIT_INFINITE) != K4A_WAIT_RESULT_SUCCEEDED) break;
    for (std::uint32_t i = 0; i < k4abt_frame_get_num_bodies(tracked); ++i) add_body(frame, tracked, i);
    k4abt_frame_release(tracked);
    if (!pusher.push(frame)) std::cerr << pusher.problem() << "\n";
  }
}
