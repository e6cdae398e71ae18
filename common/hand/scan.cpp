#include "common/hand/scan.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "common/base/median.h"
#include "common/hand/anthropometry.h"
#include "common/hand/fingers.h"
#include "common/hand/joints.h"
#include "common/hand/outline.h"
#include "common/hand/paper.h"
#include "common/hand/segment.h"

namespace chorus::hand {
namespace {

constexpr double kLeastScore = 0.5;  // of a hand that the network sees
// A second hand that the network is this sure of is one.
constexpr double kSecondScore = 0.9;
constexpr double kSideSure = 0.7;
// An edge that rises over more than this share of the palm's radius: 2.4 mm.  Of 93 sharp pictures
// of people it is at most 0.046, of blurred drawings 0.078 and more.
constexpr double kBlurred = 0.06;
constexpr double kSharp = 5.0;  // No picture is blurred whose edges rise in this [px].

Result<const SeenHand*> the_one(const std::vector<SeenHand>& seen) {
  const SeenHand* best = nullptr;
  std::size_t sure = 0;
  for (const SeenHand& each : seen) {
    if (each.score >= kLeastScore && (best == nullptr || each.score > best->score)) best = &each;
    if (each.score >= kSecondScore) ++sure;
  }
  if (sure > 1)
    return fail(ErrorCode::Conflict, "hand",
                "there are two hands in the picture; scan one at a time");
  return best;
}

/// A left hand whose palm is seen has its thumb first when followed clockwise; so has a right one's
/// back.
void set_side(HandShape& out, const Split& split, const SeenHand* seen,
              const ScanOptions& options) {
  if (seen != nullptr && seen->side_score >= kSideSure) {
    out.side = seen->side;
    out.side_seen = true;
    out.back_seen = (seen->side == Side::Left) != split.thumb_first;
    return;
  }
  out.back_seen = options.back;
  out.side = split.thumb_first != options.back ? Side::Left : Side::Right;
  out.notes.push_back(fmt::format("taken for a {} hand, because the {} is assumed to be seen",
                                  name_of(out.side), options.back ? "back" : "palm"));
}

Result<HandShape> hand_by_mask(const cv::Mat& mask, const SeenHand* seen,
                               const ScanOptions& options) {
  const Pixel inside =
      seen != nullptr ? Pixel(0.5 * (seen->joints[0] + seen->joints[9])) : Pixel(0, 0);
  auto outline = outline_of(mask, seen != nullptr ? &inside : nullptr);
  if (!outline) return pass(outline);
  const cv::Mat fill = filled(*outline);
  const auto split =
      seen != nullptr ? split_by_joints(*outline, fill, *seen) : split_by_outline(*outline, fill);
  if (!split) return pass(split);
  HandShape out;
  out.fingers = split->fingers;
  out.origin = seen != nullptr ? Origin::Both : Origin::Contour;
  out.joints =
      seen != nullptr ? joints_seen(out.fingers, fill, *seen) : joints_usual(*outline, out.fingers);
  const Wrist wrist = wrist_of(*outline, fill, out.fingers);
  out.wrist_seen = wrist.seen;
  if (wrist.seen && seen == nullptr) out.joints[0] = wrist.place;
  set_side(out, *split, seen, options);
  out.outline = std::move(*outline);
  return out;
}

void add_notes(HandShape& hand) {
  std::string touching;
  for (std::size_t f = 0; f < kFingers; ++f) {
    if (hand.fingers[f].touching)
      touching += (touching.empty() ? "" : ", ") + std::string(kFingerNames[f]);
  }
  if (!touching.empty())
    hand.notes.push_back(touching + ": touch each other, so that their widths are not known");
  if (!hand.wrist_seen)
    hand.notes.emplace_back("the wrist is not in the picture: its place is estimated");
  for (auto& each : implausible_parts(hand.joints)) hand.notes.push_back(std::move(each));
}

Result<HandShape> checked(Result<HandShape> hand, const cv::Mat& bgr) {
  if (!hand) return hand;
  const double width = edge_width(bgr, hand->outline);
  if (width > std::max(kSharp, kBlurred * hand->outline.palm_radius))
    return fail(ErrorCode::InvalidArgument, "picture",
                fmt::format("is blurred: the hand's edge is {:.0f} % of the palm's half width wide",
                            100.0 * width / hand->outline.palm_radius));
  add_notes(*hand);
  return hand;
}

}  // namespace

double edge_width(const cv::Mat& bgr, const Outline& outline) {
  constexpr int kReach = 24;  // [px] on each side
  constexpr int kBase = 3;    // Steps between compared pixels, so that grain is no edge.
  cv::Mat lab;
  cv::cvtColor(bgr, lab, cv::COLOR_BGR2Lab);
  std::vector<double> widths;
  const std::size_t n = outline.points.size();
  const std::size_t stride = std::max<std::size_t>(1, n / 200);
  for (std::size_t i = 0; i < n; i += stride) {
    const Pixel tangent = outline.points[(i + 5) % n] - outline.points[(i + n - 5) % n];
    if (tangent.norm() < 1.0) continue;
    const Pixel normal = Pixel(-tangent.y(), tangent.x()).normalized();
    std::vector<cv::Vec3b> across;
    for (int k = -kReach; k <= kReach; ++k) {
      const Pixel at = outline.points[i] + k * normal;
      const int x = cvRound(at.x()), y = cvRound(at.y());
      if (x >= 0 && y >= 0 && x < lab.cols && y < lab.rows)
        across.push_back(lab.at<cv::Vec3b>(y, x));
    }
    double steepest = 0.0;
    for (std::size_t k = kBase; k < across.size(); ++k)
      steepest = std::max(steepest, cv::norm(across[k], across[k - kBase]) / kBase);
    if (steepest > 0.0) widths.push_back(cv::norm(across.front(), across.back()) / steepest);
  }
  return widths.empty() ? 0.0 : median(std::move(widths));
}

Result<HandShape> hand_in(const cv::Mat& bgr, const std::vector<SeenHand>& seen,
                          const ScanOptions& options) {
  if (options.paper) return paper_shape(bgr);
  const auto one = the_one(seen);
  if (!one) return pass(one);
  std::optional<Error> why;
  for (const SeenHand* eyes : {*one, static_cast<const SeenHand*>(nullptr)}) {
    for (const cv::Mat& mask : masks(bgr, eyes)) {
      auto hand = hand_by_mask(mask, eyes, options);
      if (hand) return checked(std::move(hand), bgr);
      // What can be mended says more than that nothing was found.
      if (!why ||
          (why->code == ErrorCode::NotFound && hand.error().code == ErrorCode::InvalidArgument))
        why = hand.error();
    }
    if (eyes == nullptr) break;
  }
  return tl::unexpected<Error>(*why);
}

}  // namespace chorus::hand
