// SPDX-License-Identifier: Apache-2.0
#include "import/meshopt_decode.hpp"

#include <meshoptimizer.h>

#include <new>
#include <vector>

namespace fdcg::bake::gltf {
namespace {

// What the decoders demand (they check it with assert alone), and what the data can hold at most: 256 vertices of equal bytes
// take an eighth of a byte for each byte of a vertex, a triangle takes a byte.
void check(const Meshopt& packed, std::size_t bytes, const std::string& place) {
  const auto fail = [&place](const std::string& what) { throw Refusal{place + what + "; export the file again"}; };
  const std::string stride = std::to_string(packed.stride);
  if (packed.mode == Meshopt::Mode::attributes) {
    if (packed.stride == 0 || packed.stride > 256 || packed.stride % 4 != 0)
      fail(".byteStride is " + stride + "; of attributes it is a multiple of 4, up to 256");
  } else if (packed.stride != 2 && packed.stride != 4) {
    fail(".byteStride is " + stride + "; of indices it is 2 or 4");
  }
  if (packed.mode == Meshopt::Mode::triangles && packed.count % 3 != 0)
    fail(".count is " + std::to_string(packed.count) + ", not a multiple of 3");
  const bool is_filter_fit = packed.filter == Meshopt::Filter::none || packed.filter == Meshopt::Filter::exponential ||
                             packed.stride == 8 || (packed.filter == Meshopt::Filter::octahedral && packed.stride == 4);
  if (!is_filter_fit) fail(".byteStride is " + stride + ", which its filter cannot have");
  constexpr std::uint64_t kMostPerByte = 128;
  if (packed.count > (bytes * kMostPerByte + 4096) / packed.stride) {
    fail(".count promises " + std::to_string(packed.count) + " values of " + stride + " bytes, more than its " +
         std::to_string(bytes) + " bytes can hold");
  }
}

int decode(const Meshopt& packed, const unsigned char* bytes, std::size_t size, void* out) {
  const auto count = static_cast<std::size_t>(packed.count), stride = static_cast<std::size_t>(packed.stride);
  switch (packed.mode) {
    case Meshopt::Mode::attributes:
      return meshopt_decodeVertexBuffer(out, count, stride, bytes, size);
    case Meshopt::Mode::triangles:
      return meshopt_decodeIndexBuffer(out, count, stride, bytes, size);
    default:
      return meshopt_decodeIndexSequence(out, count, stride, bytes, size);
  }
}

}  // namespace

std::string decode_meshopt(const Meshopt& packed, std::string_view bytes, const std::string& place) {
  check(packed, bytes.size(), place);
  const auto count = static_cast<std::size_t>(packed.count), stride = static_cast<std::size_t>(packed.stride);
  if (count == 0) return {};
  std::vector<std::uint32_t> words((count * stride + 3) / 4);  // aligned as the filters want it
  if (decode(packed, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), words.data()) != 0)
    throw Refusal{place + ": its compressed data is damaged; fetch or export the file again"};
  if (packed.filter == Meshopt::Filter::octahedral) meshopt_decodeFilterOct(words.data(), count, stride);
  if (packed.filter == Meshopt::Filter::quaternion) meshopt_decodeFilterQuat(words.data(), count, stride);
  if (packed.filter == Meshopt::Filter::exponential) meshopt_decodeFilterExp(words.data(), count, stride);
  return {reinterpret_cast<const char*>(words.data()), count * stride};
}

}  // namespace fdcg::bake::gltf
