// SPDX-License-Identifier: Apache-2.0
// VTK's XML files with their numbers as bytes: every encoding gives what the text gives.
#include <zlib.h>

#include "../../support/gltf_writer.hpp"
#include "../../support/import_support.hpp"

using namespace fdcg::bake;
using namespace fdcg::bake::test;
using fdcg::test::base64;

namespace {

using Faces = std::vector<std::vector<std::uint32_t>>;

struct Encoding {
  bool is_compressed = false, is_big_endian = false, has_wide_counts = false;
  enum class Where { array, base64, raw } where = Where::array;
  std::size_t block = 32;  // bytes, of compressed ones
};

// Puts a file together.
class Writer {
 public:
  explicit Writer(const Encoding& encoding) : encoding_(encoding) {}

  template <class T>
  std::string array(const std::string& name, const std::string& type, const std::vector<T>& numbers) {
    std::string bytes;
    for (const T number : numbers)
      put(bytes, number, encoding_.is_big_endian);
    const std::string start = "<DataArray type='" + type + "' Name='" + name + "' NumberOfComponents='3' format='";
    const std::string packed = encoded(bytes);
    if (encoding_.where == Encoding::Where::array) return start + "binary'>\n  " + packed + "\n</DataArray>";
    const std::string result = start + "appended' offset='" + std::to_string(appended_.size()) + "'/>";
    appended_ += packed;
    return result;
  }

  [[nodiscard]] std::string file(const std::string& piece) const {
    const std::string appended = encoding_.where == Encoding::Where::array
                                     ? ""
                                     : std::string("<AppendedData encoding='") +
                                           (encoding_.where == Encoding::Where::raw ? "raw" : "base64") + "'>\n _" + appended_ +
                                           "\n</AppendedData>";
    return std::string("<?xml version='1.0'?><VTKFile type='PolyData' version='1.0' byte_order='") +
           (encoding_.is_big_endian ? "BigEndian'" : "LittleEndian'") +
           (encoding_.has_wide_counts ? " header_type='UInt64'" : "") +
           (encoding_.is_compressed ? " compressor='vtkZLibDataCompressor'" : "") + "><PolyData>" + piece + "</PolyData>" +
           appended + "</VTKFile>";
  }

 private:
  void put_count(std::string& bytes, std::size_t count) const {
    if (encoding_.has_wide_counts) {
      put(bytes, static_cast<std::uint64_t>(count), encoding_.is_big_endian);
    } else {
      put(bytes, static_cast<std::uint32_t>(count), encoding_.is_big_endian);
    }
  }
  [[nodiscard]] std::string as_text(const std::string& bytes) const {
    return encoding_.where == Encoding::Where::raw ? bytes : base64(bytes);
  }

  // In base64 the counts of compressed blocks are encoded by themselves, with what fills them up.
  [[nodiscard]] std::string encoded(const std::string& bytes) const {
    std::string counts;
    if (!encoding_.is_compressed) {
      put_count(counts, bytes.size());
      return as_text(counts + bytes);
    }
    const std::size_t blocks = (bytes.size() + encoding_.block - 1) / encoding_.block;
    put_count(counts, blocks), put_count(counts, encoding_.block), put_count(counts, bytes.size() % encoding_.block);
    std::string all;
    for (std::size_t b = 0; b < blocks; ++b) {
      const std::string block = bytes.substr(b * encoding_.block, encoding_.block);
      uLongf size = compressBound(block.size());
      std::string packed(size, '\0');
      REQUIRE(compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(block.data()),
                       block.size()) == Z_OK);
      put_count(counts, size);
      all += packed.substr(0, size);
    }
    return as_text(counts) + as_text(all);
  }

  Encoding encoding_;
  std::string appended_;
};

// A pyramid: four triangles and a square, numbers of many digits.
const std::vector<float> kPoints = {0.1f, 0, 0, 1, 0.3f, 0, 1.7f, 1, 0, 0, 1, 0.6f, 0.5f, 0.5f, -3.25f};

std::string pyramid(const Encoding& encoding) {
  Writer writer(encoding);
  std::string points = writer.array("Points", "Float32", kPoints);
  if (encoding.has_wide_counts) {
    points = writer.array("Points", "Float64", std::vector<double>(kPoints.begin(), kPoints.end()));
  }
  const std::string corners =
      encoding.has_wide_counts
          ? writer.array("connectivity", "Int64", std::vector<std::int64_t>{0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4, 3, 2, 1, 0})
          : writer.array("connectivity", "UInt8", std::vector<std::uint8_t>{0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4, 3, 2, 1, 0});
  const std::string ends = writer.array("offsets", "Int32", std::vector<std::int32_t>{3, 6, 9, 12, 16});
  return writer.file("<Piece NumberOfPoints='5' NumberOfPolys='5'><Points>" + points + "</Points><Polys>" + corners + ends +
                     "</Polys></Piece>");
}

void says(const std::string& text, const std::string& words) {
  const std::string message = refusal(text);
  INFO(message);
  CHECK(message.find(words) != std::string::npos);
}

std::string with(std::string text, const std::string& old, const std::string& now) {
  REQUIRE(text.find(old) != std::string::npos);
  return text.replace(text.find(old), old.size(), now);
}

}  // namespace

TEST_CASE("VTK in XML: bytes in every encoding are the numbers") {
  for (const auto where : {Encoding::Where::array, Encoding::Where::base64, Encoding::Where::raw}) {
    for (int bits = 0; bits < 8; ++bits) {
      const Encoding encoding{(bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0, where};
      CAPTURE(bits, static_cast<int>(where));
      const PolygonSoup soup = import_text(pyramid(encoding));
      check_invariants(soup);
      CHECK(faces_of(soup) == Faces{{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {3, 2, 1, 0}});
      REQUIRE(soup.points.size() == 5);
      for (std::size_t p = 0; p < 5; ++p) {
        CHECK(soup.points[p] == Vec3{static_cast<double>(kPoints[3 * p]), static_cast<double>(kPoints[3 * p + 1]),
                                     static_cast<double>(kPoints[3 * p + 2])});
      }
      CHECK(soup.relative_quantum == 0x1p-24);
      CHECK(soup.absolute_quantum == 0);
    }
  }
}

TEST_CASE("VTK in XML: blocks that fill a whole number of blocks, and one that is no multiple") {
  for (const std::size_t block : {4, 12, 60, 61, 1000}) {
    CAPTURE(block);
    CHECK(import_text(pyramid({true, false, false, Encoding::Where::raw, block})).points.size() == 5);
  }
}

TEST_CASE("VTK in XML: damaged bytes are refused with what is wrong") {
  const std::string inside = pyramid({}), appended = pyramid({true, false, false, Encoding::Where::raw});
  says(with(inside, "type='Float32'", "type='Float16'"), "numbers of the type 'Float16', which are not read");
  says(with(inside, "type='Float32'", "type='Float64'"), "holds 60 bytes, not a multiple of the 8 of a number");
  says(with(inside, "type='UInt8'", "type='Float32'"), "of the type Float, and needs whole ones");
  says(with(inside, "binary'>\n  PA", "binary'>\n  PB"), "is truncated: it promises");
  says(with(inside, "binary'>\n  PAAA", "binary'>\n  PA?A"), "is truncated: it promises 4 bytes more than it holds");
  says(with(appended, "vtkZLibDataCompressor", "vtkLZMADataCompressor"), "compressed with vtkLZMADataCompressor");
  says(with(appended, "offset='0'", "offset='99999'"), "has offset 99999, and");
  says(with(appended, "encoding='raw'", "encoding='hex'"), "has the encoding 'hex'");
  says(with(appended, "\n _", "\n "), "no underscore begins its appended data");
  const std::size_t first = appended.find("\n _") + 3;  // of the counts: blocks, bytes of each, of the last
  std::string changed = appended;
  changed[first + 3] = '\x7F';
  says(changed, "blocks of 32 bytes, the last of 28, which cannot be");
  changed = appended;
  changed[first + 7] = '\x7F';
  says(changed, "unpacks to more than the");
  changed = appended;
  changed[first + 26] ^= '\x55';  // in the first block
  says(changed, "has a damaged block 0");
}
