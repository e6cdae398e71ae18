#include "common/exporters/bvh.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/base/units.h"
#include "common/body/bones.h"
#include "common/exporters/number_text.h"

namespace chorus::exporters {
namespace {

constexpr int kLengthDigits = 6;  // decimals of centimetres: 10 nm
constexpr int kAngleDigits = 6;   // decimals of degrees

void append_vector(std::string& text, const Eigen::Vector3d& v) {
  for (Eigen::Index i = 0; i < 3; ++i) {
    text += ' ';
    append_fixed(text, v[i], kLengthDigits);
  }
}

class BvhWriter {
 public:
  BvhWriter(const SkeletonFit& fit, const BvhOptions& options) : fit_(fit), options_(options) {}

  void joint(std::size_t i, int depth) {
    const FittedJoint& each = fit_.joints[i];
    const std::string indent(static_cast<std::size_t>(depth), '\t');
    text_ += indent + (i == 0 ? "ROOT " : "JOINT ") + std::string(name_of(each.id)) + "\n";
    text_ += indent + "{\n";
    offset(indent, each.offset);
    text_ += indent +
             (i == 0 ? "\tCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n"
                     : "\tCHANNELS 3 Zrotation Xrotation Yrotation\n");
    order_.push_back(i);
    bool leaf = true;
    for (std::size_t child = i + 1; child < fit_.joints.size(); ++child) {
      if (fit_.joints[child].parent != i) continue;
      joint(child, depth + 1);
      leaf = false;
    }
    if (leaf) {
      text_ += indent + "\tEnd Site\n" + indent + "\t{\n";
      offset(indent + "\t", end_offset(each));
      text_ += indent + "\t}\n";
    }
    text_ += indent + "}\n";
  }

  std::string motion(double rate_hz) {
    text_ += "MOTION\nFrames: " + std::to_string(fit_.poses.size()) + "\nFrame Time: ";
    append_exact(text_, 1.0 / rate_hz);
    text_ += "\n";
    std::vector<std::array<double, 3>> last(fit_.joints.size());
    for (const FittedPose& pose : fit_.poses) frame(pose, last);
    return std::move(text_);
  }

 private:
  void offset(const std::string& indent, const Eigen::Vector3d& metres) {
    text_ += indent + "\tOFFSET";
    append_vector(text_, options_.units_per_metre * metres);
    text_ += "\n";
  }

  void frame(const FittedPose& pose, std::vector<std::array<double, 3>>& last) {
    const std::size_t begin = text_.size();
    append_vector(text_, options_.units_per_metre * pose.root);
    for (const std::size_t i : order_) {
      last[i] = euler_zxy(pose.turns[i], last[i]);
      for (const double angle : last[i]) {
        text_ += ' ';
        append_fixed(text_, to_deg(angle), kAngleDigits);
      }
    }
    text_.erase(begin, 1);  // the blank before the first number
    text_ += "\n";
  }

  const SkeletonFit& fit_;
  const BvhOptions& options_;
  /// The joints in the order of the hierarchy, which is also that of the channels.
  std::vector<std::size_t> order_;
  std::string text_ = "HIERARCHY\n";
};

/// `angle` plus the number of whole turns that brings it nearest to `last`.
double unwrapped(double angle, double last) {
  constexpr double kTurn = 2 * std::numbers::pi;
  return angle + kTurn * std::round((last - angle) / kTurn);
}

double distance(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]);
}

}  // namespace

std::array<double, 3> euler_zxy(const Eigen::Quaterniond& q, const std::array<double, 3>& last) {
  // R = Rz Rx Ry:  R(2,1) = sin x,  R(0,1) = -sin z cos x,  R(1,1) = cos z cos x,
  //                R(2,0) = -cos x sin y,  R(2,2) = cos x cos y.
  constexpr double kMinCosine = 1e-6;
  const Eigen::Matrix3d r = q.normalized().toRotationMatrix();
  const double x = std::asin(std::clamp(r(2, 1), -1.0, 1.0));
  if (std::hypot(r(0, 1), r(1, 1)) < kMinCosine) {
    // Rz Rx(+-90): R(0,0) = cos(z +- y), R(1,0) = sin(z +- y).
    const double sum = std::atan2(r(1, 0), r(0, 0));
    const double y = last[2];
    return {unwrapped(r(2, 1) > 0 ? sum - y : sum + y, last[0]), unwrapped(x, last[1]), y};
  }
  const double z = std::atan2(-r(0, 1), r(1, 1));
  const double y = std::atan2(-r(2, 0), r(2, 2));
  constexpr double kHalf = std::numbers::pi;
  const std::array<double, 3> one{unwrapped(z, last[0]), unwrapped(x, last[1]),
                                  unwrapped(y, last[2])};
  const std::array<double, 3> other{unwrapped(z + kHalf, last[0]), unwrapped(kHalf - x, last[1]),
                                    unwrapped(y + kHalf, last[2])};
  return distance(other, last) < distance(one, last) ? other : one;
}

std::string bvh_of(const SkeletonFit& fit, double rate_hz, const BvhOptions& options) {
  BvhWriter writer(fit, options);
  writer.joint(0, 0);
  return writer.motion(rate_hz);
}

}  // namespace chorus::exporters
