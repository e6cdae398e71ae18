// Datagrams of an MVN stream, written from the format's table and not by our encoder.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

namespace chorus::suit::testing {

using Bytes = std::vector<char>;

inline void add(Bytes& out, std::uint32_t value, int width) {
  for (int i = width - 1; i >= 0; --i) out.push_back(static_cast<char>((value >> (8 * i)) & 0xFFU));
}
inline void add(Bytes& out, double value) {
  add(out, std::bit_cast<std::uint32_t>(static_cast<float>(value)), 4);
}
inline void add(Bytes& out, std::string_view text) {
  add(out, static_cast<std::uint32_t>(text.size()), 4);
  out.insert(out.end(), text.begin(), text.end());
}

struct Head {
  std::string_view magic = "MXTP02";
  std::uint32_t sample = 1;
  std::uint32_t counter = 0x80;
  std::uint32_t items = 23;
  std::uint32_t time_ms = 1000;
  std::uint32_t character = 0;
};

inline Bytes datagram(const Head& head, const Bytes& payload) {
  Bytes out(head.magic.begin(), head.magic.end());
  add(out, head.sample, 4);
  add(out, head.counter, 1);
  add(out, head.items, 1);
  add(out, head.time_ms, 4);
  add(out, head.character, 1);
  for (int i = 0; i < 5; ++i) add(out, 0, 1);
  add(out, static_cast<std::uint32_t>(payload.size()), 2);
  out.insert(out.end(), payload.begin(), payload.end());
  return out;
}

/// Origins of the segments of a person of 1.75 m in T-pose, z up, x ahead, y left [m].
inline const std::array<Eigen::Vector3d, 23>& t_pose() {
  static const std::array<Eigen::Vector3d, 23> places{{
      {0, 0, 0.95},     {0, 0, 1.05},    {0, 0, 1.15},      {0, 0, 1.25},       {0, 0, 1.35},
      {0, 0, 1.48},     {0, 0, 1.58},    {0, -0.05, 1.42},  {0, -0.2, 1.42},    {0, -0.5, 1.42},
      {0, -0.75, 1.42}, {0, 0.05, 1.42}, {0, 0.2, 1.42},    {0, 0.5, 1.42},     {0, 0.75, 1.42},
      {0, -0.1, 0.93},  {0, -0.1, 0.5},  {0, -0.1, 0.08},   {0.17, -0.1, 0.02}, {0, 0.1, 0.93},
      {0, 0.1, 0.5},    {0, 0.1, 0.08},  {0.17, 0.1, 0.02},
  }};
  return places;
}

/// Items of type 02 for the segments `first` to `last` (ids), without rotation.
inline Bytes quaternion_items(std::uint32_t first = 1, std::uint32_t last = 23) {
  Bytes out;
  for (std::uint32_t id = first; id <= last; ++id) {
    add(out, id, 4);
    for (int axis = 0; axis < 3; ++axis) add(out, t_pose().at(id - 1)[axis]);
    for (const double part : {1.0, 0.0, 0.0, 0.0}) add(out, part);
  }
  return out;
}

/// Items of type 01: centimetres, y up, x to the left, z ahead.
inline Bytes euler_items() {
  Bytes out;
  for (std::uint32_t id = 1; id <= 23; ++id) {
    const Eigen::Vector3d& place = t_pose().at(id - 1);
    add(out, id, 4);
    for (const double value : {place.y(), place.z(), place.x()}) add(out, 100.0 * value);
    for (int angle = 0; angle < 3; ++angle) add(out, 0.0);
  }
  return out;
}

}  // namespace chorus::suit::testing
