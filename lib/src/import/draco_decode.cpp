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

// Calls take(point, values) for each point with the first `components` values of the attribute, whose type is T. False if one
// is missing, or not representable as double.
template <class T, class Take>
bool take_values(const draco::PointAttribute& attribute, std::uint32_t points, std::size_t components, bool is_normalized,
                 const Take& take) {
  constexpr double kExact = 0x1p53;  // integers up to this are exact in double
  const std::size_t stride = static_cast<std::size_t>(attribute.byte_stride());
  const auto first = static_cast<std::size_t>(attribute.byte_offset());
  const std::size_t there = attribute.buffer()->data_size();
  for (std::uint32_t i = 0; i < points; ++i) {
    const std::uint32_t value = attribute.mapped_index(draco::PointIndex(i)).value();
    const std::size_t at = first + value * stride;
    if (value >= attribute.size() || at > there || there - at < components * sizeof(T)) return false;
    std::array<T, 4> stored{};
    std::memcpy(stored.data(), attribute.buffer()->data() + at, components * sizeof(T));
    std::array<double, 4> values = {1, 1, 1, 1};
    for (std::size_t k = 0; k < components; ++k) {
      values[k] = static_cast<double>(stored[k]);
      if (std::is_integral_v<T> && std::fabs(values[k]) > kExact) return false;
      if (is_normalized && std::is_integral_v<T>)
        values[k] = std::max(values[k] / static_cast<double>(std::numeric_limits<T>::max()), -1.0);
    }
    take(i, values);
  }
  return true;
}

// The same of any type; components: 4 at most, and of the attribute.
template <class Take>
bool take_values(const draco::PointAttribute& attribute, std::uint32_t points, std::size_t components, bool is_normalized,
                 const Take& take) {
  if (!attribute.is_mapping_identity() && attribute.indices_map_size() < points) return false;
  const auto take_as = [&](auto zero) {
    return take_values<decltype(zero)>(attribute, points, components, is_normalized, take);
  };
  switch (attribute.data_type()) {
    case draco::DT_INT8:
      return take_as(std::int8_t{});
    case draco::DT_UINT8:
      return take_as(std::uint8_t{});
    case draco::DT_INT16:
      return take_as(std::int16_t{});
    case draco::DT_UINT16:
      return take_as(std::uint16_t{});
    case draco::DT_INT32:
      return take_as(std::int32_t{});
    case draco::DT_UINT32:
      return take_as(std::uint32_t{});
    case draco::DT_INT64:
      return take_as(std::int64_t{});
    case draco::DT_UINT64:
      return take_as(std::uint64_t{});
    case draco::DT_FLOAT32:
      return take_as(float{});
    case draco::DT_FLOAT64:
      return take_as(double{});
    default:
      return false;
  }
}

bool take_points(const draco::PointAttribute& attribute, bool is_normalized, std::vector<Vec3>& points) {
  return take_values(attribute, static_cast<std::uint32_t>(points.size()), 3, is_normalized,
                     [&](std::uint32_t i, const std::array<double, 4>& v) {
                       points[i] = {v[0], v[1], v[2]};
                     });
}

// The positions as libdraco gives them by default: dequantised here, because the decoder is configured to keep the quantised
// form, from which alone the step of the quantisation is known.
bool read_points(const draco::Mesh& source, const draco::PointAttribute& attribute, DracoMesh& mesh) {
  if (!attribute.is_mapping_identity() && attribute.indices_map_size() < source.num_points()) return false;
  mesh.points.resize(source.num_points());
  const draco::AttributeTransformData* transform = attribute.GetAttributeTransformData();
  if (transform == nullptr || transform->transform_type() != draco::ATTRIBUTE_QUANTIZATION_TRANSFORM) {
    mesh.is_float = attribute.data_type() == draco::DT_FLOAT32;
    return take_points(attribute, attribute.normalized(), mesh.points);
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
  const double quantum = std::fabs(static_cast<double>(quantization.range())) / steps / 2;
  if (std::isfinite(quantum)) mesh.absolute_quantum = quantum;  // a forged range may be no number
  return take_points(floats, false, mesh.points);
}

const draco::PointAttribute* extra_of(const draco::Mesh& source, const DracoInput& input, DracoExtra which) {
  if (const auto& id = input.extra_ids[static_cast<std::size_t>(which)]) return source.GetAttributeByUniqueId(*id);
  if (!input.wants_named || which == DracoExtra::height_uv) return nullptr;
  return source.GetNamedAttribute(which == DracoExtra::normal ? draco::GeometryAttribute::NORMAL
                                  : which == DracoExtra::uv   ? draco::GeometryAttribute::TEX_COORD
                                                              : draco::GeometryAttribute::COLOR);
}

void read_extras(const draco::Mesh& source, const DracoInput& input, DracoMesh& mesh) {
  for (const DracoExtra which : {DracoExtra::normal, DracoExtra::uv, DracoExtra::height_uv, DracoExtra::colour}) {
    const draco::PointAttribute* const attribute = extra_of(source, input, which);
    if (attribute == nullptr) continue;
    const auto components = static_cast<std::size_t>(attribute->num_components());
    const bool fits = which == DracoExtra::normal   ? components == 3
                      : which == DracoExtra::colour ? components == 3 || components == 4
                                                    : components == 2;
    if (!fits) continue;
    std::vector<DracoValue>& values = mesh.extras[static_cast<std::size_t>(which)];
    values.resize(source.num_points());
    const auto take = [&values](std::uint32_t i, const std::array<double, 4>& v) {
      for (std::size_t k = 0; k < v.size(); ++k)
        values[i][k] = static_cast<float>(v[k]);
    };
    if (!take_values(*attribute, source.num_points(), components, true, take)) values.clear();
    if (which == DracoExtra::colour)
      mesh.has_whole_colours = attribute->data_type() != draco::DT_FLOAT32 && attribute->data_type() != draco::DT_FLOAT64;
  }
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
  read_extras(source, input, mesh);
  return mesh;
}

// ---- the result of the child process: for each mesh a header, its points, its corners, its extras, its error text

struct MeshHeader {
  std::uint64_t points = 0, corners = 0, trouble = 0;
  double absolute_quantum = 0;
  std::uint32_t is_point_cloud = 0, is_float = 0, has_whole_colours = 0, unused = 0;
  std::array<std::uint64_t, kDracoExtras> extras{};
};

template <class T>
void append(ChildAnswer& answer, const T* values, std::size_t count) {
  const std::span<std::byte> place = answer.append(count * sizeof(T));
  if (count > 0) std::memcpy(place.data(), values, place.size());
}

void append(ChildAnswer& answer, const DracoMesh& mesh) {
  MeshHeader header;
  header.points = mesh.points.size(), header.corners = mesh.corners.size(), header.trouble = mesh.trouble.size();
  header.absolute_quantum = mesh.absolute_quantum;
  header.is_point_cloud = mesh.is_point_cloud, header.is_float = mesh.is_float;
  header.has_whole_colours = mesh.has_whole_colours;
  std::transform(mesh.extras.begin(), mesh.extras.end(), header.extras.begin(), [](const auto& of) { return of.size(); });
  append(answer, &header, 1);
  append(answer, mesh.points.data(), mesh.points.size());
  append(answer, mesh.corners.data(), mesh.corners.size());
  for (const std::vector<DracoValue>& extra : mesh.extras)
    append(answer, extra.data(), extra.size());
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
        !take(bytes, header[0].corners, mesh.corners)) {
      return false;
    }
    for (std::size_t k = 0; k < kDracoExtras; ++k) {
      const std::uint64_t values = header[0].extras[k];
      if ((values != 0 && values != header[0].points) || !take(bytes, values, mesh.extras[k])) return false;
    }
    if (!take(bytes, header[0].trouble, trouble)) return false;
    mesh.trouble.assign(trouble.begin(), trouble.end());
    mesh.absolute_quantum = header[0].absolute_quantum;
    mesh.is_point_cloud = header[0].is_point_cloud != 0;
    mesh.is_float = header[0].is_float != 0;
    mesh.has_whole_colours = header[0].has_whole_colours != 0;
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
