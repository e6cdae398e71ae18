// Drawn hands, of which everything is known.
#include <cmath>

#include <fmt/format.h>

#include "common/hand/drawing.h"
#include "common/synthetic/draw.h"
#include "tests/bench/hand/hand_cases.h"
#include "tests/bench/hand/hand_methods.h"
#include "tests/support/hands/hand_scene.h"

namespace chorus::bench {
namespace {

using testing::DrawnHand;
using testing::HandScene;
using testing::Thing;

constexpr std::uint64_t kDrawnHands = 150;
constexpr std::uint64_t kDrawnThings = 25;  // Of each kind.
constexpr std::uint64_t kQuickDraws = 2;
constexpr std::uint64_t kOnSheet = 24;
constexpr double kSameFinger = 12.0;  // A tip nearer to the true one than this is that finger's.

/// What scanners make of hands: grounds, rings, sleeves, JPEG, grain.
HandScene varied_scene(std::uint64_t seed, Thing thing = Thing::Hand) {
  synthetic::Draw draw({seed, 81});
  HandScene out;
  out.seed = seed;
  out.thing = thing;
  out.dark_ground = draw.uniform() < 0.5;
  out.ring = draw.uniform() < 0.2;
  out.sleeve = draw.uniform() < 0.3;
  out.jpeg = draw.uniform() < 0.5;
  out.grain = draw.uniform(0.3, 2.0);
  return out;
}

struct ScanScores {
  std::size_t shown = 0, answered = 0, fingers = 0, sides = 0;
  std::vector<double> tips;     // [mm], of hands with right fingers
  std::vector<double> lengths;  // relative error of each finger, from web to tip
};

/// Whether the fingers are right.
bool judge(const hand::HandShape& found, const DrawnHand& drawn, ScanScores& scores) {
  ++scores.answered;
  std::array<double, hand::kFingers> off{};
  bool right = true;
  for (std::size_t f = 0; f < hand::kFingers; ++f) {
    off[f] =
        (found.fingers[f].tip - drawn.joints[hand::hand_joint(f, 3)]).norm() / drawn.pixels_per_mm;
    right = right && off[f] < kSameFinger;
  }
  if (found.side == drawn.side) ++scores.sides;
  if (!right) return false;
  ++scores.fingers;
  for (std::size_t f = 0; f < hand::kFingers; ++f) {
    scores.tips.push_back(off[f]);
    scores.lengths.push_back(std::abs(found.fingers[f].length() / drawn.free[f] - 1.0));
  }
  return true;
}

void add_rows(Report& report, HandMethod method, const ScanScores& scores) {
  const std::string name = fmt::format("synthetic ({})", name_of(method));
  const auto percent = [&](std::size_t count) {
    return 100.0 * static_cast<double>(count) / static_cast<double>(scores.shown);
  };
  report.row(name, "answered_percent", percent(scores.answered), "%");
  report.row(name, "right_fingers_percent", percent(scores.fingers), "%");
  report.row(name, "right_side_percent", percent(scores.sides), "%");
  report.row(name, "tip_median_mm", share_quantile(scores.tips, 0.5), "mm");
  report.row(name, "tip_p95_mm", share_quantile(scores.tips, 0.95), "mm");
  report.row(name, "length_median_percent", 100.0 * share_quantile(scores.lengths, 0.5), "%");
  report.row(name, "length_p95_percent", 100.0 * share_quantile(scores.lengths, 0.95), "%");
}

bool left_out(HandMethod method, const HandEyes& eyes) {
  return method == HandMethod::Both && !eyes.there();
}

struct Refusal {
  Thing thing;
  const char* name;
  const char* reason;  ///< A word of the right reason.
};
constexpr std::array kRefusals{Refusal{Thing::Foot, "foot", "foot"},
                               Refusal{Thing::Fist, "fist", "fist"},
                               Refusal{Thing::Mitten, "mitten", "apart"},
                               Refusal{Thing::TwoHands, "two-hands", "two hands"},
                               Refusal{Thing::ClosedFingers, "closed-fingers", "apart"},
                               Refusal{Thing::HiddenThumb, "hidden-thumb", "thumb"},
                               Refusal{Thing::Cut, "cut-finger", "cut by the frame"},
                               Refusal{Thing::Blurred, "blurred", "blurred"},
                               Refusal{Thing::Nothing, "nothing", "nothing"}};

/// The share of a finger in the sum of all five.
std::array<double, hand::kFingers> shares_of(const std::array<double, hand::kFingers>& lengths) {
  double sum = 0.0;
  for (const double each : lengths) sum += each;
  std::array<double, hand::kFingers> out{};
  for (std::size_t f = 0; f < hand::kFingers; ++f) out[f] = lengths[f] / sum;
  return out;
}

}  // namespace

Result<void> synthetic_hands(Report& report) {
  HandEyes eyes(report);
  for (const HandMethod method : kHandMethods) {
    if (left_out(method, eyes)) continue;
    ScanScores scores;
    std::vector<cv::Mat> tiles;
    const std::uint64_t draws = report.quick() ? kQuickDraws : kDrawnHands;
    for (std::uint64_t i = 0; i < draws; ++i) {
      const DrawnHand drawn = testing::drawn_hand(varied_scene(report.seed() + i));
      const auto found = hand_by(method, drawn.picture, drawn.back, eyes);
      ++scores.shown;
      const bool right = found && judge(*found, drawn, scores);
      if (i < kOnSheet)
        tiles.push_back(tile_of(found ? hand::drawn(drawn.picture, *found) : drawn.picture, right));
    }
    add_rows(report, method, scores);
    draw_sheet(report, fmt::format("hand_sheet_{}", static_cast<int>(method)), tiles);
  }
  report.note(
      "synthetic: drawn hands, not photos; the outline alone is told which side of the hand is "
      "seen; tips and lengths are of hands whose fingers are right; the thumb's length counts");
  return {};
}

Result<void> things_refused(Report& report) {
  HandEyes eyes(report);
  const std::uint64_t draws = report.quick() ? 1 : kDrawnThings;
  for (const HandMethod method : kHandMethods) {
    if (left_out(method, eyes)) continue;
    for (const Refusal& each : kRefusals) {
      double refused = 0.0, reasons = 0.0;
      for (std::uint64_t i = 0; i < draws; ++i) {
        const DrawnHand drawn = testing::drawn_hand(varied_scene(report.seed() + i, each.thing));
        const auto found = hand_by(method, drawn.picture, drawn.back, eyes);
        if (found) continue;
        refused += 1.0;
        if (found.error().message.find(each.reason) != std::string::npos) reasons += 1.0;
      }
      const std::string name = fmt::format("refused {} ({})", each.name, name_of(method));
      report.row(name, "refused_percent", 100.0 * refused / static_cast<double>(draws), "%");
      report.row(name, "right_reason_percent", 100.0 * reasons / static_cast<double>(draws), "%");
    }
  }
  return {};
}

Result<void> repeated_drawings(Report& report) {
  constexpr std::uint64_t kPeople = 12, kShots = 5;
  HandEyes eyes(report);
  for (const HandMethod method : {HandMethod::Outline, HandMethod::Paper}) {
    std::vector<double> off;  // Of each finger's share from the true one, relative.
    for (std::uint64_t person = 1; person <= kPeople; ++person) {
      for (std::uint64_t shot = 0; shot < kShots; ++shot) {
        HandScene scene = varied_scene(report.seed() + 100 * person + shot);
        scene.person = 1000 + person;
        const DrawnHand drawn = testing::drawn_hand(scene);
        const auto found = hand_by(method, drawn.picture, drawn.back, eyes);
        if (!found) continue;
        std::array<double, hand::kFingers> lengths{};
        for (std::size_t f = 0; f < hand::kFingers; ++f) lengths[f] = found->fingers[f].length();
        const auto shares = shares_of(lengths), truth = shares_of(drawn.free);
        for (std::size_t f = 0; f < hand::kFingers; ++f)
          off.push_back(std::abs(shares[f] / truth[f] - 1.0));
      }
    }
    const std::string name = fmt::format("repeats-drawn ({})", name_of(method));
    report.row(name, "answered_percent",
               100.0 * static_cast<double>(off.size()) / (hand::kFingers * kPeople * kShots), "%");
    report.row(name, "share_error_median_percent", 100.0 * share_quantile(off, 0.5), "%");
    report.row(name, "share_error_p95_percent", 100.0 * share_quantile(off, 0.95), "%");
  }
  return {};
}

}  // namespace chorus::bench
