// One picture of a camera, and its conversion.  OpenCV's type is used only in .cpp files.
#pragma once

#include <memory>
#include <string>

#include "common/base/result.h"
#include "services/sensor/device/camera/lens.h"

namespace cv {
class Mat;
}

namespace chorus::camera {

struct Picture {
  std::shared_ptr<const cv::Mat> pixels;  ///< Rows of blue, green, red; never null.
  Size size;
};

/// The picture in a file, turned as its metadata says.
[[nodiscard]] Result<Picture> read_picture(const std::string& file);

/// Red, green and blue of the picture scaled to that size, row by row.
[[nodiscard]] std::string rgb_bytes(const Picture& picture, Size size);

[[nodiscard]] Result<std::string> jpeg_of(const Picture& picture);

}  // namespace chorus::camera
