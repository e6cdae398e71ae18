// A made-up tracker in C++: a person who goes round in a circle, pushed to a sensor.
//
//   c++ -std=c++17 -O2 -o push_circle push_circle.cpp
//   ./push_circle 127.0.0.1:8081 [seconds] [token]
//
// To a sensor with TLS:
//
//   c++ -std=c++17 -O2 -DCHORUS_PUSH_TLS -o push_circle push_circle.cpp -lssl -lcrypto
//   CHORUS_CA=ca.crt ./push_circle wss://sensor-1.local:8081 [seconds] [token]
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <string>
#include <thread>

#include "chorus_push.h"

int main(int argc, char** argv) {
  const std::string where = argc > 1 ? argv[1] : "127.0.0.1:8081";
  const double seconds = argc > 2 ? std::atof(argv[2]) : 1e9;
  chorus::Pusher pusher(where, R"({"type":"hello","name":"C++ circle","layout":"coco_17","axes":"right down ahead","floor":[0,-1,0,1.5]})",
                        argc > 3 ? argv[3] : "");
  // COCO's order: nose, eyes, ears, shoulders, elbows, wrists, hips, knees, ankles; to the person's left and up from the floor [m].
  const double landmarks[17][2] = {{0, 1.63},   {.03, 1.67}, {-.03, 1.67}, {.07, 1.64}, {-.07, 1.64}, {.19, 1.42},
                                   {-.19, 1.42}, {.23, 1.13}, {-.23, 1.13}, {.24, .88},  {-.24, .88},  {.09, .93},
                                   {-.09, .93},  {.1, .5},    {-.1, .5},    {.1, .09},   {-.1, .09}};
  std::string told;  // each problem is told once
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < seconds * 30; ++i) {
    const std::int64_t captured = chorus::now_ns();
    const double turn = static_cast<double>(captured % 60'000'000'000) / 1e9;
    chorus::Frame frame(captured);
    frame.body(1);
    // The camera is 1.5 m high; the person faces it, so that its left is the image's right.
    for (const auto& [left, up] : landmarks) frame.point(0.5 * std::cos(turn) + left, 1.5 - up, 2.5 + 0.5 * std::sin(turn));
    pusher.push(frame);
    if (pusher.problem() != told) std::cerr << (told = pusher.problem()) << std::endl;
    std::this_thread::sleep_until(begin + std::chrono::microseconds(33'333) * (i + 1));
  }
  return pusher.problem().empty() ? 0 : 1;
}
