#include "services/sensor/device/scan/hand_scan.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "common/base/file.h"
#include "common/base/units.h"
#include "common/hand/density.h"
#include "common/hand/drawing.h"
#include "common/hand/sheet.h"

namespace chorus::scan {
namespace {

constexpr std::uintmax_t kMaxScan = 1u << 29;
constexpr double kMillimetresPerInch = 25.4;
// From wrist to the tip of the middle finger [mm]: of children of six, and more than any adult's.
constexpr double kShortestHand = 110.0;
constexpr double kLongestHand = 250.0;

/// A picture of working size, and what one of its pixels measures.
struct Prepared {
  cv::Mat picture;
  std::optional<double> mm_per_pixel;
  std::string scale_from;
};

cv::Mat of_working_size(const cv::Mat& picture) {
  const int side = std::max(picture.cols, picture.rows);
  if (side <= hand::kWorkingSide) return picture;
  cv::Mat out;
  const double factor = 1.0 * hand::kWorkingSide / side;
  cv::resize(picture, out, {}, factor, factor, cv::INTER_AREA);
  return out;
}

Result<Prepared> on_a4(const cv::Mat& whole) {
  if (hand::has_sides_of_a4(whole.cols, whole.rows)) {
    cv::Mat picture = of_working_size(whole);
    const double mm = hand::kSheetLong / std::max(picture.cols, picture.rows);
    return Prepared{std::move(picture), mm, "the picture is a whole sheet of A4"};
  }
  const cv::Mat small = of_working_size(whole);
  const auto sheet = hand::find_sheet(small);
  if (!sheet)
    return fail(
        ErrorCode::NotFound, "--paper",
        "no whole sheet is in the picture: show all four corners of a white A4 sheet on a darker "
        "ground, or scan the whole sheet");
  return Prepared{hand::flattened(small, *sheet, hand::kWorkingSide),
                  hand::kSheetLong / hand::kWorkingSide, "the A4 sheet in the picture"};
}

Result<Prepared> beside_card(const cv::Mat& whole) {
  const cv::Mat small = of_working_size(whole);
  const auto card = hand::find_card(small);
  if (!card)
    return fail(ErrorCode::NotFound, "--card",
                "no bank card is in the picture: lay it flat beside the hand, on a ground of "
                "another colour");
  return Prepared{hand::without_card(small, *card), card->mm_per_pixel,
                  "the bank card in the picture"};
}

Prepared by_density(const cv::Mat& whole, std::optional<double> per_metre, std::string from) {
  Prepared out{of_working_size(whole), std::nullopt, ""};
  if (!per_metre) return out;
  const double shrunk = 1.0 * out.picture.cols / whole.cols;
  out.mm_per_pixel = 1000.0 / *per_metre / shrunk;
  out.scale_from = std::move(from);
  return out;
}

Result<Prepared> prepared(const cv::Mat& whole, const std::string& bytes, const HandScan& how) {
  switch (how.scale) {
    case ScaleBy::A4:
      return on_a4(whole);
    case ScaleBy::Card:
      return beside_card(whole);
    case ScaleBy::Dpi:
      return by_density(whole, how.dpi / kMillimetresPerInch * 1000.0,
                        fmt::format("--dpi {:g}", how.dpi));
    case ScaleBy::File:
      break;
  }
  const auto stated = hand::pixels_per_metre(bytes);
  return by_density(
      whole, stated,
      fmt::format("the file's {:.0f} dpi", stated.value_or(0.0) * kMillimetresPerInch / 1000.0));
}

/// Cameras write 72 dpi into photos, which means nothing.
Result<void> check_size(ScannedHand& hand, const HandScan& how) {
  const double length = to_mm(length_of(hand.skeleton));
  if (hand.skeleton.relative || (length > kShortestHand && length < kLongestHand)) return {};
  const std::string what =
      fmt::format("{}: the hand would be {:.0f} mm long", hand.record.scale_from, length);
  if (how.scale != ScaleBy::File)
    return fail(ErrorCode::InvalidArgument, "scale", what + "; is that right?");
  hand.shape.notes.push_back(what + ", so lengths are relative");
  hand.skeleton = hand::skeleton_of(hand.shape, std::nullopt);
  hand.record.mm_per_pixel = 0.0;
  hand.record.scale_from.clear();
  return {};
}

void compare_with_file(ScannedHand& hand, const cv::Mat& whole, const std::string& bytes) {
  constexpr double kAgree = 0.03;
  const auto stated = hand::pixels_per_metre(bytes);
  if (!stated || hand.record.mm_per_pixel <= 0.0) return;
  const double long_side = std::max(whole.cols, whole.rows) / *stated * 1000.0;
  const double ours = hand.record.mm_per_pixel * hand::kWorkingSide;
  if (std::abs(ours / long_side - 1.0) > kAgree &&
      std::max(whole.cols, whole.rows) >= hand::kWorkingSide)
    hand.shape.notes.push_back(fmt::format(
        "the file states another scale: by it the picture is {:.0f} mm long, not {:.0f}", long_side,
        ours));
}

}  // namespace

Result<ScannedHand> scan_hand(const std::string& file, const HandScan& how,
                              camera::HandFinder* finder) {
  auto bytes = read_file(file, kMaxScan);
  if (!bytes) return pass(bytes);
  auto picture = camera::read_picture(file);
  if (!picture) return pass(picture);
  return scan_picture({file, std::move(*bytes), std::move(*picture)}, how, finder);
}

Result<ScannedHand> scan_picture(const ScanSource& source, const HandScan& how,
                                 camera::HandFinder* finder) {
  const cv::Mat& whole = *source.picture.pixels;
  const auto ready = prepared(whole, source.bytes, how);
  if (!ready) return pass(ready);
  std::vector<hand::SeenHand> seen;
  if (finder != nullptr && !how.options.paper) {
    auto found = finder->look({std::make_shared<const cv::Mat>(ready->picture),
                               {ready->picture.cols, ready->picture.rows}});
    if (!found) return pass(found);
    seen = std::move(*found);
  }
  auto shape = hand::hand_in(ready->picture, seen, how.options);
  if (!shape)
    return tl::unexpected<Error>(Error{shape.error().code, source.name,
                                       shape.error().context + ": " + shape.error().message});
  ScannedHand out;
  out.skeleton = hand::skeleton_of(*shape, ready->mm_per_pixel);
  out.record = {std::filesystem::path(source.name).filename().string(), ready->scale_from,
                ready->mm_per_pixel.value_or(0.0),
                shape->origin == hand::Origin::Both ? finder->name() : ""};
  out.shape = std::move(*shape);
  if (finder != nullptr && !how.options.paper && out.shape.origin != hand::Origin::Both)
    out.shape.notes.emplace_back(
        seen.empty() ? "the network sees no hand: the outline alone answers"
                     : "what the network sees does not fit the outline, which alone answers");
  if (how.scale == ScaleBy::A4) compare_with_file(out, whole, source.bytes);
  if (const auto ok = check_size(out, how); !ok) return pass(ok);
  out.drawn = std::make_shared<const cv::Mat>(hand::drawn(ready->picture, out.shape));
  return out;
}

}  // namespace chorus::scan
