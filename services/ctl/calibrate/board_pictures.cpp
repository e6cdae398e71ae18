#include "services/ctl/calibrate/board_pictures.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "common/calibration/board_finder.h"
#include "services/ctl/line/photo_files.h"
#include "services/sensor/device/camera/video.h"

namespace chorus::ctl {
namespace {

namespace fs = std::filesystem;

// Time between the examined pictures of a video [s]; a hand moves the board far enough in it.
constexpr double kEvery = 0.25;
constexpr std::size_t kMaxViews = 2000;

class Search {
 public:
  explicit Search(const BoardSearch& how) : how_(how), finder_(how.board) {}

  Result<BoardViews> run(const std::vector<std::string>& files) {
    for (std::size_t i = 0; i < files.size(); ++i) {
      begin_ = static_cast<double>(i) / static_cast<double>(files.size());
      step_ = 1.0 / static_cast<double>(files.size());
      const auto done = is_photo(files[i]) ? photo(files[i]) : video(files[i]);
      if (done) continue;
      if (files.size() == 1) return pass(done);
      out_.notes.push_back(to_string(done.error()) + "; left out");
    }
    if (!groups_.empty()) take(groups_);
    return std::move(out_);
  }

 private:
  /// The pictures of one size, and the views of the board in them.
  struct Group {
    calibration::PictureSize size;
    std::size_t pictures = 0;
    std::vector<calibration::View> views;
  };

  /// Takes the size of picture in which the board was found most often; if it was found in none,
  /// the size of most pictures.
  void take(std::vector<Group>& groups) {
    const auto rank = [](const Group& group) {
      return std::pair(group.views.size(), group.pictures);
    };
    Group& best = *std::ranges::max_element(groups, {}, rank);
    std::size_t others = 0;
    for (const Group& group : groups) others += &group == &best ? 0 : group.pictures;
    out_.size = best.size;
    out_.pictures = best.pictures;
    out_.views = std::move(best.views);
    if (others == 0) return;
    out_.notes.push_back(
        fmt::format("{} not {} x {}, as most of those with the board are; left out",
                    others == 1 ? "1 picture is" : fmt::format("{} pictures are", others),
                    out_.size.width, out_.size.height));
  }

  Result<void> photo(const std::string& file) {
    std::error_code failed;
    if (!fs::exists(file, failed)) return fail(ErrorCode::NotFound, file, "there is no such file");
    const auto picture = camera::read_picture(file);
    if (!picture) return pass(picture);
    look(*picture, fs::path(file).filename().string());
    tell(1.0);
    return {};
  }

  Result<void> video(const std::string& source) {
    camera::CameraSettings settings;
    settings.source = camera::meant_source(source);
    const auto video = camera::open_video(settings);
    if (!video) return pass(video);
    const bool film = camera::kind_of(settings.source) == camera::SourceKind::File;
    return watch(**video, film, fs::path(settings.source).filename().string());
  }

  Result<void> watch(camera::Video& video, bool film, const std::string& name) {
    const camera::FileTiming timing = film ? video.timing() : camera::FileTiming{};
    const double whole = timing.length ? seconds(*timing.length) : how_.seconds;
    const auto began = std::chrono::steady_clock::now();
    double next = 0.0;
    for (double at = 0.0; film || at < how_.seconds; at += film ? seconds(timing.step) : 0.0) {
      const auto moment = video.next();
      if (!moment) return pass(moment);
      if (!*moment) break;
      if (!film)
        at = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
      if (at < next) continue;
      next = at + kEvery;
      const auto picture = video.picture();
      if (picture) look(*picture, fmt::format("{} at {:.2f} s", name, at));
      tell(std::min(1.0, at / whole));
    }
    return {};
  }

  void look(const camera::Picture& picture, std::string name) {
    const calibration::PictureSize size{picture.size.width, picture.size.height};
    auto group = std::ranges::find(groups_, size, &Group::size);
    if (group == groups_.end()) group = groups_.insert(groups_.end(), {size, 0, {}});
    ++group->pictures;
    ++pictures_;
    auto corners = finder_.find(*picture.pixels);
    if (corners.empty() || found_ >= kMaxViews) return;
    ++found_;
    group->views.push_back({std::move(name), std::move(corners)});
  }

  void tell(double share) const {
    if (!how_.progress) return;
    how_.progress(begin_ + step_ * share,
                  fmt::format("the board in {} of {} pictures", found_, pictures_));
  }

  const BoardSearch& how_;
  calibration::BoardFinder finder_;
  BoardViews out_;
  std::vector<Group> groups_;
  std::size_t pictures_ = 0;
  std::size_t found_ = 0;
  double begin_ = 0.0;
  double step_ = 1.0;
};

}  // namespace

Result<BoardViews> look_for_board(const BoardSearch& search) {
  const auto files = photo_files(search.sources);
  if (!files) return pass(files);
  auto found = Search(search).run(*files);
  if (found && found->pictures == 0)
    return fail(ErrorCode::NotFound, search.sources.empty() ? "pictures" : search.sources.front(),
                found->notes.empty() ? "has no picture that can be read" : found->notes.front());
  return found;
}

}  // namespace chorus::ctl
