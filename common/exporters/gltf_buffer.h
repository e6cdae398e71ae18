// The binary part of a glTF file: views and accessors over one buffer, and the GLB container.
//
// glTF 2.0, sections 3.6 (buffers, views, accessors) and 4 (GLB): little-endian, aligned to four
// bytes, two chunks.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

namespace chorus::exporters {

/// What a view is used for; the numbers are OpenGL's.
enum class ViewTarget { None = 0, Vertices = 34962, Indices = 34963 };

class GltfBuffer {
 public:
  /// Each of these functions appends values and returns the number of the new accessor.
  std::size_t scalars(std::span<const float> values);  ///< With minimum and maximum.
  std::size_t vectors(std::span<const Eigen::Vector3f> values, ViewTarget target);
  std::size_t quaternions(std::span<const Eigen::Quaternionf> values);  ///< In the order x y z w.
  std::size_t matrices(std::span<const Eigen::Matrix4f> values);        ///< Column by column.
  /// Joints 2 to 4 of each vertex are 0.
  std::size_t vertex_joints(std::span<const std::uint8_t> first_joint);
  std::size_t vertex_weights(std::size_t count);  ///< All weight on the first joint.
  std::size_t indices(std::span<const std::uint16_t> values);

  /// Adds buffers, bufferViews and accessors to the document and packs both into a GLB.
  [[nodiscard]] std::string pack(nlohmann::json document) const;

 private:
  struct Shape {
    int component = 0;  ///< 5126 float, 5123 unsigned short, 5121 unsigned byte
    const char* type = "";
    std::size_t count = 0;
  };
  std::size_t add(std::string_view bytes, const Shape& shape, ViewTarget target);
  std::size_t add_floats(std::span<const float> values, const char* type, std::size_t width,
                         ViewTarget target);

  std::string bytes_;
  nlohmann::json views_ = nlohmann::json::array();
  nlohmann::json accessors_ = nlohmann::json::array();
};

}  // namespace chorus::exporters
