// What `chorus position` is given: the take of a suit, and what placed cameras saw.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/body/stature.h"
#include "common/positioning/take.h"

namespace chorus::ctl {

struct PositionArguments {
  std::vector<std::string> inputs;  ///< Videos or recordings, and the suit's file.
  std::string places;
  std::vector<std::string> lenses;
  std::string model = "blazepose-full";
  std::string method = "both";
  std::string background = "auto";
  std::string empty_room;
  double girth = 1.0;
  std::string start;
  double heading_deg = 0.0;
  bool heading_stated = false;
  double stature = 0.0;
  double offset_s = 0.0;
  bool offset_stated = false;
  double search_s = 2.0;
  double rate_hz = 30.0;
  std::string out;
  std::string size_from;     ///< What tells the person's stature; empty: nothing.
  bool recalibrate = false;  ///< The bones are found anew.
};

struct PositionInputs {
  std::vector<std::filesystem::path> videos;
  std::vector<std::filesystem::path> recordings;
  std::filesystem::path suit;
};

/// Refuses missing files, several takes, and none of either kind.
[[nodiscard]] Result<PositionInputs> sorted_inputs(const std::vector<std::string>& given);

struct PlacedCameras {
  std::vector<positioning::CameraTake> cameras;
  std::vector<std::string> notes;  ///< What was looked at, and what could not be.
};

/// The stature by --size-from: a depth camera's recording, or somebody who stands before one of the
/// placed cameras, in a recording or video.
[[nodiscard]] Result<LearnedLength> found_size(const PositionArguments& arguments);

/// What the cameras saw, as far as the method asks: videos are looked through, recordings read.
/// Refuses cameras without a place, and pictures that the method needs but does not get.
[[nodiscard]] Result<PlacedCameras> placed_cameras(const PositionInputs& inputs,
                                                   const PositionArguments& arguments,
                                                   double stature);

}  // namespace chorus::ctl
