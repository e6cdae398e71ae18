// Internal to common/resource: writes what a frame says of its sensors, and joints of theirs.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "common/resource/frame_parts.h"
#include "common/resource/frame_shares.h"
#include "common/resource/pen.h"

namespace chorus::resource {

template <Style kStyle>
class SensorPen : public Pen {
 public:
  static constexpr bool kTurtle = kStyle == Style::Turtle;
  static constexpr std::string_view kMark = kStyle == Style::JsonLd ? "\"" : "";

  SensorPen(const FrameResource& frame, std::size_t bytes)
      : Pen(bytes), sensors_(quoted_names(frame)), share_list_(frame.sensors) {
    for (const std::string& name : sensors_) sensor_bytes_ += name.size() + kShareBytes;
  }

  /// What the names and the shares of all sensors take.
  [[nodiscard]] std::size_t sensor_bytes() const { return sensor_bytes_; }

  template <class... Text>
  void puts(const Text&... text) {
    (put(text), ...);
  }

  void put_sensors() {
    if (sensors_.empty()) return;
    put(kTurtle ? " ;\n  ch:sensor " : ",\"sensors\":[");
    put_names(~std::uint64_t{0});
    put(kTurtle ? "" : "]");
  }

  void put_contributors(std::uint64_t contributors) {
    const std::uint64_t known = sensors_.size() >= kMaxSensors
                                    ? ~std::uint64_t{0}
                                    : (std::uint64_t{1} << sensors_.size()) - 1;
    if (kTurtle ? (contributors & known) == 0 : sensors_.empty()) return;
    put(kTurtle ? " ;\n  ch:contributor " : ",\"contributors\":[");
    put_names(contributors);
    put(kTurtle ? "" : "]");
  }

  void put_shares(const JointResource& joint) {
    ShareList::Values values;
    std::string_view before = kTurtle ? " ;\n  ch:shares (" : ",\"shares\":[";
    const auto list = share_list_.of(joint.shares, joint.contributors, values);
    for (const double share : list) {
      puts(before, kMark);
      put_decimal<kShareDecimals>(share);
      put(kMark);
      before = kTurtle ? " " : ",";
    }
    if (!list.empty()) put(kTurtle ? ")" : "]");
  }

 private:
  void put_names(std::uint64_t bits) {
    std::string_view comma;
    for (std::size_t i = 0; i < std::min(sensors_.size(), kMaxSensors); ++i) {
      if ((bits >> i & 1U) == 0) continue;
      puts(comma, sensors_[i]);
      comma = kTurtle ? ", " : ",";
    }
  }

  const std::vector<std::string> sensors_;
  const ShareList share_list_;
  std::size_t sensor_bytes_ = 0;
};

}  // namespace chorus::resource
