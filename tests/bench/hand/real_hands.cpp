// Pictures of people's hands, which do not travel with the repository: CHORUS_HANDS names their
// folder.  judged.csv says where the five tips are and which hand it is, as a person has seen it.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "common/hand/drawing.h"
#include "tests/bench/hand/hand_cases.h"
#include "tests/bench/hand/hand_methods.h"

namespace chorus::bench {
namespace {

namespace fs = std::filesystem;

constexpr const char* kJudged = "tests/bench/hand/judged.csv";
// A tip is the right finger's if it is nearer to where a person sees it than this share of the way
// between the tips of index and little finger.
constexpr double kSameTip = 0.2;

fs::path hands_folder() {
  const char* stated = std::getenv("CHORUS_HANDS");
  return stated != nullptr ? stated : "../shared/data/hands";
}

struct JudgedHand {
  std::string file;  ///< Below the folder of hands.
  bool left = false;
  bool back = false;
  bool side_shows = true;                          ///< False for silhouettes.
  std::array<hand::Pixel, hand::kFingers> tips{};  ///< In the picture as it is.
};

/// file,side,seen,thumb x,thumb y,...; of silhouettes or of photos.
Result<std::vector<JudgedHand>> read_judged(bool silhouettes) {
  std::ifstream file(kJudged);
  std::vector<JudgedHand> out;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    JudgedHand one;
    std::string side, seen;
    words >> one.file >> side >> seen;
    one.left = side == "left";
    one.back = seen == "back";
    one.side_shows = seen != "silhouette";
    for (hand::Pixel& tip : one.tips) words >> tip.x() >> tip.y();
    if (!words) return fail(ErrorCode::Malformed, kJudged, "has an unreadable line: " + line);
    if (one.side_shows != silhouettes) out.push_back(std::move(one));
  }
  if (out.empty()) return fail(ErrorCode::NotFound, kJudged, "names no picture");
  return out;
}

bool fingers_are_right(const hand::HandShape& found, const JudgedHand& judged, double scale) {
  const double apart = scale * (judged.tips[1] - judged.tips[4]).norm();
  for (std::size_t f = 0; f < hand::kFingers; ++f) {
    if ((found.fingers[f].tip - scale * judged.tips[f]).norm() > kSameTip * apart) return false;
  }
  return true;
}

struct RealScores {
  std::size_t shown = 0, accepted = 0, right = 0, sides = 0;
};

Result<RealScores> score_of(HandMethod method, const std::vector<JudgedHand>& hands, HandEyes& eyes,
                            std::vector<cv::Mat>& tiles) {
  RealScores scores;
  for (const JudgedHand& judged : hands) {
    const cv::Mat whole = cv::imread((hands_folder() / judged.file).string());
    if (whole.empty()) return fail(ErrorCode::NotFound, judged.file, "is no picture");
    const cv::Mat picture = of_working_size(whole);
    ++scores.shown;
    const auto found = hand_by(method, picture, judged.back, eyes);
    const bool right = found && fingers_are_right(*found, judged, 1.0 * picture.cols / whole.cols);
    tiles.push_back(tile_of(found ? hand::drawn(picture, *found) : picture, right));
    if (!found) continue;
    ++scores.accepted;
    if (right) ++scores.right;
    if (right && (found->side == hand::Side::Left) == judged.left) ++scores.sides;
  }
  return scores;
}

/// Of several shots of a hand, named PERSON_SHOT: how far each finger's share is from the person's
/// mean, and how far people are apart.
struct ShareSpread {
  std::vector<double> within, between;
  std::size_t shots = 0;
};

using PersonShares = std::map<std::string, std::vector<std::array<double, hand::kFingers>>>;

ShareSpread spread_of(const PersonShares& people) {
  ShareSpread out;
  for (std::size_t f = 0; f < hand::kFingers; ++f) {
    std::vector<double> means;
    for (const auto& [person, shots] : people) {
      if (shots.size() < 2) continue;
      double sum = 0.0, squares = 0.0;
      for (const auto& shot : shots) sum += shot[f];
      const double mean = sum / static_cast<double>(shots.size());
      for (const auto& shot : shots) squares += (shot[f] - mean) * (shot[f] - mean);
      out.within.push_back(std::sqrt(squares / static_cast<double>(shots.size() - 1)) / mean);
      means.push_back(mean);
    }
    double sum = 0.0, squares = 0.0;
    for (const double mean : means) sum += mean;
    const double all = sum / static_cast<double>(std::max<std::size_t>(1, means.size()));
    for (const double mean : means) squares += (mean - all) * (mean - all);
    if (means.size() > 1)
      out.between.push_back(std::sqrt(squares / static_cast<double>(means.size() - 1)) / all);
  }
  return out;
}

Result<void> judge_all(Report& report, const std::string& name, bool silhouettes) {
  const auto hands = read_judged(silhouettes);
  if (!hands) return pass(hands);
  if (!fs::exists(hands_folder() / hands->front().file)) {
    report.note(name + ": left out; the pictures are not there (CHORUS_HANDS)");
    return {};
  }
  HandEyes eyes(report);
  for (const HandMethod method : kHandMethods) {
    if (method == HandMethod::Both && !eyes.there()) continue;
    std::vector<cv::Mat> tiles;
    const auto scores = score_of(method, *hands, eyes, tiles);
    if (!scores) return pass(scores);
    const std::string row = fmt::format("{} ({})", name, name_of(method));
    const auto count = [](std::size_t n) { return static_cast<double>(n); };
    report.row(row, "shown", count(scores->shown), "1");
    report.row(row, "right", count(scores->right), "1");
    report.row(row, "right_with_side", count(scores->sides), "1");
    report.row(row, "wrong_accepted", count(scores->accepted - scores->right), "1");
    draw_sheet(report, fmt::format("{}-{}", name, static_cast<int>(method)), tiles);
  }
  return {};
}

}  // namespace

Result<void> hand_photos(Report& report) {
  auto done = judge_all(report, "photos", false);
  report.note("photos: the outline alone and the paper are told which side of the hand is seen");
  return done;
}

Result<void> hand_silhouettes(Report& report) { return judge_all(report, "silhouettes", true); }

Result<void> repeated_silhouettes(Report& report) {
  const auto hands = read_judged(true);
  if (!hands) return pass(hands);
  if (!fs::exists(hands_folder() / hands->front().file)) {
    report.note("repeats-real: left out; the pictures are not there (CHORUS_HANDS)");
    return {};
  }
  HandEyes eyes(report);
  for (const HandMethod method : {HandMethod::Outline, HandMethod::Paper}) {
    PersonShares people;
    double answered = 0.0;
    for (const JudgedHand& judged : *hands) {
      const cv::Mat picture = of_working_size(cv::imread((hands_folder() / judged.file).string()));
      const auto found = hand_by(method, picture, judged.back, eyes);
      if (!found) continue;
      answered += 1.0;
      std::array<double, hand::kFingers> shares{};
      double sum = 0.0;
      for (std::size_t f = 0; f < hand::kFingers; ++f) sum += found->fingers[f].length();
      for (std::size_t f = 0; f < hand::kFingers; ++f) shares[f] = found->fingers[f].length() / sum;
      const std::string name = fs::path(judged.file).stem().string();
      people[name.substr(0, name.find('_'))].push_back(shares);
    }
    const ShareSpread spread = spread_of(people);
    const std::string row = fmt::format("repeats-silhouettes ({})", name_of(method));
    report.row(row, "answered", answered, "1");
    report.row(row, "share_spread_median_percent", 100.0 * share_quantile(spread.within, 0.5), "%");
    report.row(row, "share_spread_worst_percent", 100.0 * share_quantile(spread.within, 1.0), "%");
    report.row(row, "between_people_percent", 100.0 * share_quantile(spread.between, 0.5), "%");
  }
  return {};
}

}  // namespace chorus::bench
