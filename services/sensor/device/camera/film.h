// Sends the pictures of a video file through a runner, one after the other, however long that
// takes.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "services/sensor/device/camera/looker.h"

namespace chorus::camera {

struct Film {
  CameraSettings settings;  ///< The source is the file; max_rate_hz limits the pictures used.
  std::vector<std::string> command;  ///< The command that starts the runner.
  SensorId sensor;
  Timestamp start;  ///< Capture time of the first picture.
  /// Called after every picture used with the share of the file that is done, in [0, 1].
  std::function<void(double share)> progress = {};
  /// Called with the mask of every picture used, if the runner gives any.
  std::function<void(Timestamp captured, PersonMask mask)> mask = {};
};

struct FilmPicture {
  Picture picture;
  Timestamp captured;
  double share = 0.0;  ///< Of the file that is done, in [0, 1].
};

/// The pictures of a file that are used, one after the other: at most max_rate_hz of them a second.
class FilmPictures {
 public:
  /// `start`: capture time of the first picture.
  [[nodiscard]] static Result<FilmPictures> open(const CameraSettings& settings, Timestamp start);
  FilmPictures(FilmPictures&&) noexcept;
  FilmPictures& operator=(FilmPictures&&) noexcept;
  ~FilmPictures();

  /// None at the end of the file.  Damaged pictures are left out.
  [[nodiscard]] Result<std::optional<FilmPicture>> next();

 private:
  struct State;
  explicit FilmPictures(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

struct FilmFrames {
  std::vector<SensorFrame> frames;  ///< One per picture used; `received` equals `captured`.
  std::string runner;               ///< The runner's name.
  std::string layout;
  Lens lens;
  std::size_t people = 0;  ///< Largest number of people in one picture.
};

/// Processes the film.  An error names the file and what is wrong with it, or the runner.
[[nodiscard]] Result<FilmFrames> look_through(const Film& film, const std::stop_token& stop = {});

}  // namespace chorus::camera
