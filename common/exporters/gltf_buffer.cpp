#include "common/exporters/gltf_buffer.h"

#include <algorithm>
#include <bit>

namespace chorus::exporters {
namespace {

constexpr int kFloat = 5126;
constexpr int kUnsignedShort = 5123;
constexpr int kUnsignedByte = 5121;
constexpr std::uint32_t kGlbMagic = 0x46546C67;   // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;  // "JSON"
constexpr std::uint32_t kBinChunk = 0x004E4942;   // "BIN"

void append_u32(std::string& bytes, std::uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(value >> shift & 0xff);
}

void align(std::string& bytes, char filler) { bytes.resize((bytes.size() + 3) / 4 * 4, filler); }

template <class Rows>
std::vector<float> flat(const Rows& rows, std::size_t width) {
  std::vector<float> values;
  values.reserve(rows.size() * width);
  for (const auto& row : rows) values.insert(values.end(), row.data(), row.data() + width);
  return values;
}

}  // namespace

std::size_t GltfBuffer::add(std::string_view bytes, const Shape& shape, ViewTarget target) {
  nlohmann::json view{{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", bytes.size()}};
  if (target != ViewTarget::None) view["target"] = static_cast<int>(target);
  bytes_ += bytes;
  align(bytes_, '\0');
  views_.push_back(std::move(view));
  accessors_.push_back({{"bufferView", views_.size() - 1},
                        {"componentType", shape.component},
                        {"type", shape.type},
                        {"count", shape.count}});
  return accessors_.size() - 1;
}

std::size_t GltfBuffer::add_floats(std::span<const float> values, const char* type,
                                   std::size_t width, ViewTarget target) {
  std::string bytes;
  bytes.reserve(4 * values.size());
  for (const float value : values) append_u32(bytes, std::bit_cast<std::uint32_t>(value));
  return add(bytes, {kFloat, type, values.size() / width}, target);
}

std::size_t GltfBuffer::scalars(std::span<const float> values) {
  const std::size_t accessor = add_floats(values, "SCALAR", 1, ViewTarget::None);
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  accessors_[accessor]["min"] = {*low};
  accessors_[accessor]["max"] = {*high};
  return accessor;
}

std::size_t GltfBuffer::vectors(std::span<const Eigen::Vector3f> values, ViewTarget target) {
  const std::size_t accessor = add_floats(flat(values, 3), "VEC3", 3, target);
  Eigen::Vector3f low = values.front();
  Eigen::Vector3f high = values.front();
  for (const Eigen::Vector3f& value : values) {
    low = low.cwiseMin(value);
    high = high.cwiseMax(value);
  }
  accessors_[accessor]["min"] = {low.x(), low.y(), low.z()};
  accessors_[accessor]["max"] = {high.x(), high.y(), high.z()};
  return accessor;
}

std::size_t GltfBuffer::quaternions(std::span<const Eigen::Quaternionf> values) {
  std::vector<Eigen::Vector4f> xyzw;
  xyzw.reserve(values.size());
  for (const Eigen::Quaternionf& q : values) xyzw.push_back(q.coeffs());
  return add_floats(flat(xyzw, 4), "VEC4", 4, ViewTarget::None);
}

std::size_t GltfBuffer::matrices(std::span<const Eigen::Matrix4f> values) {
  return add_floats(flat(values, 16), "MAT4", 16, ViewTarget::None);
}

std::size_t GltfBuffer::vertex_joints(std::span<const std::uint8_t> first_joint) {
  std::string bytes;
  for (const std::uint8_t joint : first_joint) {
    bytes += static_cast<char>(joint);
    bytes.append(3, '\0');
  }
  return add(bytes, {kUnsignedByte, "VEC4", first_joint.size()}, ViewTarget::Vertices);
}

std::size_t GltfBuffer::vertex_weights(std::size_t count) {
  const std::vector<Eigen::Vector4f> weights(count, Eigen::Vector4f::UnitX());
  return add_floats(flat(weights, 4), "VEC4", 4, ViewTarget::Vertices);
}

std::size_t GltfBuffer::indices(std::span<const std::uint16_t> values) {
  std::string bytes;
  for (const std::uint16_t value : values) {
    bytes += static_cast<char>(value & 0xff);
    bytes += static_cast<char>(value >> 8);
  }
  return add(bytes, {kUnsignedShort, "SCALAR", values.size()}, ViewTarget::Indices);
}

std::string GltfBuffer::pack(nlohmann::json document) const {
  document["buffers"] = {{{"byteLength", bytes_.size()}}};
  document["bufferViews"] = views_;
  document["accessors"] = accessors_;
  std::string json = document.dump();
  align(json, ' ');
  std::string glb;
  append_u32(glb, kGlbMagic);
  append_u32(glb, 2);
  append_u32(glb, static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + bytes_.size()));
  append_u32(glb, static_cast<std::uint32_t>(json.size()));
  append_u32(glb, kJsonChunk);
  glb += json;
  append_u32(glb, static_cast<std::uint32_t>(bytes_.size()));
  append_u32(glb, kBinChunk);
  return glb + bytes_;
}

}  // namespace chorus::exporters
