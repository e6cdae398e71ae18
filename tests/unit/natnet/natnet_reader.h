// Reads NatNet payloads by the format's description; throws std::out_of_range at their end.
#pragma once

#include <cstring>
#include <string>
#include <vector>

#include <Eigen/Geometry>

namespace chorus::outlet::testing {

class NatNetReader {
 public:
  explicit NatNetReader(std::vector<char> bytes) : bytes_(std::move(bytes)) {}

  template <class Number>
  Number one() {
    Number value;
    const char* from = &bytes_.at(at_ + sizeof value - 1) - (sizeof value - 1);
    std::memcpy(&value, from, sizeof value);  // the tests run on little-endian machines only
    at_ += sizeof value;
    return value;
  }
  std::string text() {
    std::string found;
    while (bytes_.at(at_) != '\0') found += bytes_.at(at_++);
    ++at_;
    return found;
  }
  Eigen::Vector3d vector() {
    const double x = static_cast<double>(one<float>());
    const double y = static_cast<double>(one<float>());
    return {x, y, static_cast<double>(one<float>())};
  }
  [[nodiscard]] bool ended() const { return at_ == bytes_.size(); }

  struct Body {
    std::int32_t id;
    Eigen::Vector3d place;
    Eigen::Quaterniond turned;
    bool tracked;
  };
  Body body() {
    Body found{one<std::int32_t>(), vector(), {}, false};
    const Eigen::Vector3d xyz = vector();
    found.turned = Eigen::Quaterniond(static_cast<double>(one<float>()), xyz.x(), xyz.y(), xyz.z());
    one<float>();
    found.tracked = (one<std::int16_t>() & 1) != 0;
    return found;
  }
  std::vector<Body> bodies() {
    std::vector<Body> found;
    for (auto left = one<std::uint32_t>(); left > 0; --left) found.push_back(body());
    return found;
  }

 private:
  std::vector<char> bytes_;
  std::size_t at_ = 0;
};

}  // namespace chorus::outlet::testing
