// Kinect v2 with the Kinect for Windows SDK 2.0, on Windows.  Not run here: see README.md.
//
//   cl /std:c++17 /EHsc /I.. /I"%KINECTSDK20_DIR%inc" kinect_v2.cpp "%KINECTSDK20_DIR%lib\x64\Kinect20.lib" ws2_32.lib
//   kinect_v2 SENSOR_HOST:8081 [token]
#define NOMINMAX
#include "chorus_push.h"

#include <Kinect.h>
#include <windows.h>

#include <iostream>
#include <string>
#include <thread>

namespace {

/// The hello, with the floor once that is known: its normal points up, and w is the camera's height [m].
std::string hello_with(const Vector4& floor) {
  std::string hello = R"({"type":"hello","name":"Kinect v2","layout":"kinect_v2_25","axes":"left up ahead")";
  if (floor.y > 0.5f && floor.w > 0.0f)
    hello += ",\"floor\":[" + std::to_string(floor.x) + "," + std::to_string(floor.y) + "," + std::to_string(floor.z) + "," +
             std::to_string(floor.w) + "]";
  return hello + "}";
}

void add_body(chorus::Frame& frame, IBody* body) {
  BOOLEAN tracked = FALSE;
  UINT64 id = 0;
  Joint joints[JointType_Count];
  if (FAILED(body->get_IsTracked(&tracked)) || tracked == FALSE || FAILED(body->get_TrackingId(&id)) ||
      FAILED(body->GetJoints(JointType_Count, joints)))
    return;
  frame.body(id);
  for (const Joint& joint : joints)  // TrackingState counts 0, 1, 2: NotTracked, Inferred, Tracked
    frame.point(joint.Position.X, joint.Position.Y, joint.Position.Z, joint.TrackingState / 2.0);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string where = argc > 1 ? argv[1] : "127.0.0.1:8081";
  IKinectSensor* sensor = nullptr;
  IBodyFrameSource* source = nullptr;
  IBodyFrameReader* reader = nullptr;
  if (FAILED(GetDefaultKinectSensor(&sensor)) || FAILED(sensor->Open()) || FAILED(sensor->get_BodyFrameSource(&source)) ||
      FAILED(source->OpenReader(&reader))) {
    std::cerr << "the Kinect does not start\n";
    return 1;
  }
  chorus::Pusher* pusher = nullptr;
  for (;;) {
    IBodyFrame* news = nullptr;
    if (FAILED(reader->AcquireLatestFrame(&news))) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
      continue;
    }
    chorus::Frame frame(chorus::now_ns());  // time of arrival; the exposure was some 60 ms earlier
    Vector4 floor{};
    news->get_FloorClipPlane(&floor);
    if (pusher == nullptr) pusher = new chorus::Pusher(where, hello_with(floor), argc > 2 ? argv[2] : "");
    IBody* bodies[BODY_COUNT] = {};
    if (SUCCEEDED(news->GetAndRefreshBodyData(BODY_COUNT, bodies))) {
      for (IBody* body : bodies) {
        if (body == nullptr) continue;
        add_body(frame, body);
        body->Release();
      }
    }
    news->Release();
    if (!pusher->push(frame)) std::cerr << pusher->problem() << "\n";
  }
}
