// SPDX-License-Identifier: Apache-2.0
// The only source file that includes Draco.
#include "import/draco_decode.hpp"

#include <draco/attributes/attribute_quantization_transform.h>
#include <draco/compression/decode.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

namespace fdcg::bake {
namespace {

// libdraco's messages end in a full stop, which ours go on from.
std::string plain(const draco::Status& status) {
  std::string text = status.error_msg_string();
  while (text.ends_with('.'))
    text.pop_back();
  return text;
}

DracoMesh refused(std::string trouble) {
  DracoMesh mesh;
  mesh.trouble = std::move(trouble);
  return mesh;
}

// Copies the values of the attribute, whose type is T, to the points. False if a value is not representable as double.
template <class T>
bool copy_values(const draco::PointAttribute& attribute, bool is_normalized, std::vector<Vec3>& points) {
  constexpr double kExact = 0x1p53;  // integers up to this are exact in double
  const std::size_t stride = static_cast<std::size_t>(attribute.byte_stride());
  const auto first = static_cast<std::size_t>(attribute.byte_offset());
  const std::size_t there = attribute.buffer()->data_size();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint32_t value = attribute.mapped_index(draco::PointIndex(static_cast<std::uint32_t>(i))).value();
    const std::size_t at = first + value * stride;
    if (value >= attribute.size() || at > there || there - at < 3 * sizeof(T)) return false;
    std::array<T, 3> xyz;
    std::memcpy(xyz.data(), attribute.buffer()->data() + at, sizeof xyz);
    std::array<double, 3> c{};
    for (std::size_t k = 0; k < 3; ++k) {
      c[k] = static_cast<double>(xyz[k]);
      if (std::is_integral_v<T> && std::fabs(c[k]) > kExact) return false;
      if (is_normalized && std::is_integral_v<T>) {
        c[k] = std::max(c[k] / static_cast<double>(std::numeric_limits<T>::max()), -1.0);
      }
    }
    points[i] = {c[0], c[1], c[2]};
  }
  return true;
}

bool copy_values(const draco::PointAttribute& attribute, bool is_normalized, std::vector<Vec3>& points) {
  constexpr bool (*kCopy[])(const draco::PointAttribute&, bool, std::vector<Vec3>&) = {
      copy_values<std::int8_t>,  copy_values<std::uint8_t>,  copy_values<std::int16_t>, copy_values<std::uint16_t>,
      copy_values<std::int32_t>, copy_values<std::uint32_t>, copy_values<std::int64_t>, copy_values<std::uint64_t>,
      copy_values<float>,        copy_values<double>};
  static_assert(draco::DT_FLOAT64 - draco::DT_INT8 + 1 == std::size(kCopy));
  const int type = attribute.data_type() - draco::DT_INT8;
  return type >= 0 && type < static_cast<int>(std::size(kCopy)) && kCopy[type](attribute, is_normalized, points);
}

// The positions as libdraco gives them by default: dequantised here, because the decoder is configured to keep the quantised
// form, from which alone the step of the quantisation is known.
bool read_points(const draco::Mesh& source, const draco::PointAttribute& attribute, DracoMesh& mesh) {
  if (!attribute.is_mapping_identity() && attribute.indices_map_size() < source.num_points()) return false;
  mesh.points.resize(source.num_points());
  const draco::AttributeTransformData* transform = attribute.GetAttributeTransformData();
  if (transform == nullptr || transform->transform_type() != draco::ATTRIBUTE_QUANTIZATION_TRANSFORM) {
    mesh.is_float = attribute.data_type() == draco::DT_FLOAT32;
    return copy_values(attribute, attribute.normalized(), mesh.points);
  }
  draco::AttributeQuantizationTransform quantization;
  if (!quantization.InitFromAttribute(attribute)) return false;
  draco::GeometryAttribute shape;
  constexpr std::int64_t kStride = 3 * sizeof(float);
  shape.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_FLOAT32, false, kStride, 0);
  draco::PointAttribute floats(shape);
  if (!floats.Reset(attribute.size())) return false;
  if (!quantization.InverseTransformAttribute(attribute, &floats)) return false;
  if (attribute.is_mapping_identity()) {
    floats.SetIdentityMapping();
  } else {
    floats.SetExplicitMapping(source.num_points());
    for (draco::PointIndex p(0); p < source.num_points(); ++p)
      floats.SetPointMapEntry(p, attribute.mapped_index(p));
  }
  mesh.is_float = true;
  const double steps = std::ldexp(1.0, quantization.quantization_bits()) - 1;
  mesh.absolute_quantum = std::fabs(static_cast<double>(quantization.range())) / steps / 2;
  return copy_values(floats, false, mesh.points);
}

DracoMesh read_mesh(const draco::Mesh& source, const DracoInput& input) {
  const draco::PointAttribute* const attribute = input.position_id
                                                     ? source.GetAttributeByUniqueId(*input.position_id)
                                                     : source.GetNamedAttribute(draco::GeometryAttribute::POSITION);
  if (attribute == nullptr) {
    return refused(input.position_id
                       ? "has no attribute with the unique id " + std::to_string(*input.position_id) + " for its positions"
                       : "has no positions");
  }
  if (attribute->num_components() != 3) {
    return refused("has positions of " + std::to_string(attribute->num_components()) + " coordinates, not 3");
  }
  DracoMesh mesh;
  if (!read_points(source, *attribute, mesh))
    return refused("has positions that are missing, or no numbers that a double holds");
  mesh.corners.reserve(std::size_t{source.num_faces()} * 3);
  for (draco::FaceIndex f(0); f < source.num_faces(); ++f) {
    for (const draco::PointIndex& corner : source.face(f))
      mesh.corners.push_back(corner.value());
  }
  return mesh;
}

// ---- the result of the child process: for each mesh a header, its points, its corners, its error text

struct MeshHeader {
  std::uint64_t points = 0, corners = 0, trouble = 0;
  double absolute_quantum = 0;
  std::uint32_t is_point_cloud = 0, is_float = 0;
};

template <class T>
void append(ChildAnswer& answer, const T* values, std::size_t count) {
  const std::span<std::byte> place = answer.append(count * sizeof(T));
  if (count > 0) std::memcpy(place.data(), values, place.size());
}

void append(ChildAnswer& answer, const DracoMesh& mesh) {
  const MeshHeader header = {mesh.points.size(),    mesh.corners.size(), mesh.trouble.size(),
                             mesh.absolute_quantum, mesh.is_point_cloud, mesh.is_float};
  append(answer, &header, 1);
  append(answer, mesh.points.data(), mesh.points.size());
  append(answer, mesh.corners.data(), mesh.corners.size());
  append(answer, mesh.trouble.data(), mesh.trouble.size());
}

// Reads values from the front of the result; false where it is too short.
template <class T>
bool take(std::span<const std::byte>& bytes, std::uint64_t count, std::span<const T>& values) {
  if (count > bytes.size() / sizeof(T)) return false;
  const std::size_t size = static_cast<std::size_t>(count) * sizeof(T), padded = (size + 7) / 8 * 8;
  if (padded > bytes.size()) return false;
  values = {reinterpret_cast<const T*>(bytes.data()), static_cast<std::size_t>(count)};
  bytes = bytes.subspan(padded);
  return true;
}

}  // namespace

DracoMesh decode_draco_here(const DracoInput& input) {
  draco::DecoderBuffer buffer;
  buffer.Init(input.bytes.data(), input.bytes.size());
  const auto type = draco::Decoder::GetEncodedGeometryType(&buffer);
  if (!type.ok()) return refused("is not Draco data that libdraco reads: " + plain(type.status()));
  if (type.value() != draco::TRIANGULAR_MESH) {
    DracoMesh cloud;
    cloud.is_point_cloud = true;
    return cloud;
  }
  draco::Decoder decoder;
  decoder.SetSkipAttributeTransform(draco::GeometryAttribute::POSITION);
  const auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) return refused("cannot be decoded: libdraco says '" + plain(decoded.status()) + "'");
  return read_mesh(*decoded.value(), input);
}

bool DracoMeshes::read(std::size_t count) {
  std::span<const std::byte> bytes = result_.bytes();
  for (std::size_t i = 0; i < count; ++i) {
    std::span<const MeshHeader> header;
    std::span<const char> trouble;
    Mesh mesh;
    if (!take(bytes, 1, header) || !take(bytes, header[0].points, mesh.points) ||
        !take(bytes, header[0].corners, mesh.corners) || !take(bytes, header[0].trouble, trouble)) {
      return false;
    }
    mesh.trouble.assign(trouble.begin(), trouble.end());
    mesh.absolute_quantum = header[0].absolute_quantum;
    mesh.is_point_cloud = header[0].is_point_cloud != 0;
    mesh.is_float = header[0].is_float != 0;
    if (mesh.corners.size() % 3 != 0) return false;
    meshes_.push_back(std::move(mesh));
  }
  return true;
}

std::string DracoMeshes::refusal() const {
  const bool is_starved = trouble_.starts_with("cannot be started");  // caused by the machine, not by the file
  return "decoding its Draco data " + trouble_ +
         (is_starved ? "; free some memory or raise its limit, and run again"
                     : "; the file is damaged or forged: compress the mesh again");
}

DracoMeshes decode_draco(std::span<const DracoInput> inputs, const ChildLimits& limits) {
  DracoMeshes result;
  result.result_ = run_guarded(limits, [inputs](ChildAnswer& answer) {
    for (const DracoInput& input : inputs)
      append(answer, decode_draco_here(input));
  });
  result.trouble_ = result.result_.trouble();
  if (result.trouble_.empty() && !result.read(inputs.size())) {
    result.trouble_ = "gave an answer that makes no sense";
    result.meshes_.clear();
  }
  return result;
}

ChildLimits draco_limits(std::size_t draco_bytes) {
  constexpr std::size_t kMebibyte = std::size_t{1} << 20;
  ChildLimits limits;
  limits.memory_bytes = 256 * kMebibyte + 512 * draco_bytes;
  limits.answer_bytes = limits.memory_bytes;
  limits.cpu_seconds = static_cast<unsigned>(10 + 4 * (draco_bytes / kMebibyte));
  return limits;
}

}  // namespace fdcg::bake
