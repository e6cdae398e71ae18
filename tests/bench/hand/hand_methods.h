// The ways of finding a hand that are compared.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <opencv2/core.hpp>

#include "common/hand/scan.h"
#include "tests/bench/report/report.h"

namespace chorus::bench {

enum class HandMethod { Both, Outline, Paper };
inline constexpr std::array kHandMethods{HandMethod::Both, HandMethod::Outline, HandMethod::Paper};

[[nodiscard]] std::string_view name_of(HandMethod method);

/// The network, started once; without its runner `Both` is left out, and that is noted.
class HandEyes {
 public:
  explicit HandEyes(Report& report);
  ~HandEyes();
  HandEyes(const HandEyes&) = delete;
  HandEyes& operator=(const HandEyes&) = delete;

  [[nodiscard]] bool there() const { return network_ != nullptr; }
  [[nodiscard]] Result<std::vector<hand::SeenHand>> look(const cv::Mat& picture);

 private:
  struct Network;
  std::unique_ptr<Network> network_;
};

/// `picture` is of working size.  The outline cannot tell palm from back: `back` tells it.
[[nodiscard]] Result<hand::HandShape> hand_by(HandMethod method, const cv::Mat& picture, bool back,
                                              HandEyes& eyes);

/// At most hand::kWorkingSide pixels wide and high.
[[nodiscard]] cv::Mat of_working_size(const cv::Mat& picture);

/// For sheets of results that a person looks at: a picture in a green frame, or in a red one.
[[nodiscard]] cv::Mat tile_of(const cv::Mat& picture, bool right);
/// Eight tiles across, as NAME.jpg in the report's folder for charts, if there is one.
void draw_sheet(const Report& report, const std::string& name, const std::vector<cv::Mat>& tiles);

/// NaN for no values.
[[nodiscard]] double share_quantile(std::vector<double> values, double share);

}  // namespace chorus::bench
