// SPDX-License-Identifier: Apache-2.0
// Any soup is judged without harm, the same on one thread and on two; compile accepts what validate passes and nothing else;
// what it writes opens with full verification and is safe to step on. Run:
//   fdcg_fuzz_validate -max_len=256 -timeout=20 FOLDER testdata/fuzz/validate
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>

#include "fdcg/bake.hpp"
#include "sealed_bytes.hpp"

namespace {

using namespace fdcg::bake;

void require(bool condition, const char* what) {
  if (condition) return;
  std::fprintf(stderr, "broken promise: %s\n", what);
  std::abort();
}

// The fuzzer's bytes as numbers; zeros behind the last.
class Bytes {
 public:
  Bytes(const unsigned char* data, std::size_t size) : data_(data), size_(size) {}
  [[nodiscard]] bool at_end() const { return next_ >= size_; }
  unsigned below(unsigned limit) { return at_end() ? 0 : data_[next_++] % limit; }

 private:
  const unsigned char* data_;
  std::size_t size_;
  std::size_t next_ = 0;
};

// Few values, so that vertices coincide and corners are collinear often; and the ends of what a double can be.
constexpr double kCoordinates[] = {0,
                                   1,
                                   2,
                                   3,
                                   -1,
                                   0.5,
                                   0,
                                   1,
                                   0.1,
                                   0.3,
                                   1 + 0x1p-52,
                                   1e-30,
                                   -1e30,
                                   1e-320,
                                   1e308,
                                   16777217,
                                   std::numeric_limits<double>::infinity(),
                                   std::numeric_limits<double>::quiet_NaN()};
constexpr unsigned kTame = 10;  // of them, which is all that most soups get

PolygonSoup soup_from(Bytes& bytes) {
  PolygonSoup soup;
  soup.name = "fuzz";
  const unsigned kind = bytes.below(8), points = bytes.below(32);
  const bool is_wild = (kind & 1) != 0;
  soup.is_text = (kind & 2) != 0;
  soup.relative_quantum = is_wild ? 0x1p-53 : 0x1p-24;
  soup.absolute_quantum = (kind & 4) != 0 ? 5e-7 : 0;
  soup.sha256 = std::string(64, '0');
  const auto coordinate = [&] { return kCoordinates[bytes.below(is_wild ? std::size(kCoordinates) : kTame)]; };
  for (unsigned i = 0; i < points; ++i) {
    const double x = coordinate(), y = coordinate(), z = coordinate();
    soup.points.push_back({x, y, z});
  }
  soup.face_first.push_back(0);
  while (!bytes.at_end()) {
    const unsigned shape = bytes.below(32), corners = shape < 6 ? shape : 3;  // mostly triangles
    if (shape == 6) soup.parts.push_back({"part", static_cast<std::uint32_t>(soup.face_count()), 0});
    for (unsigned k = 0; k < corners; ++k) {
      const unsigned index = bytes.below(points + (is_wild ? 1 : 0) + (points == 0 ? 1 : 0));
      soup.corners.push_back(index < points ? index : PolygonSoup::kInvalidVertex);
    }
    soup.face_first.push_back(static_cast<std::uint32_t>(soup.corners.size()));
  }
  if (soup.is_text) {
    soup.point_line.assign(soup.points.size(), 1);
    soup.face_line.assign(soup.face_count(), 2);
  }
  return soup;
}

Weld weld_from(unsigned kind) {
  if (kind == 0) return {Weld::Kind::none, 0};
  if (kind == 1) return {Weld::Kind::distance, 0.25};
  return {};
}

void check_file(std::span<const std::byte> file) {
  fdcg::test::AlignedBytes bytes(file);
  fdcg_graph graph;
  fdcg_error error{};
  const fdcg_status status = fdcg_open_memory(bytes.data(), bytes.size(), FDCG_VERIFY_FULL, &graph, &error);
  if (status != FDCG_OK) std::fprintf(stderr, "%s\n", error.message);
  require(status == FDCG_OK, "what compile writes opens");
  fdcg::test::touch_everywhere(graph, 20);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  Bytes bytes(data, size);
  const unsigned weld = bytes.below(6), how = bytes.below(32);
  ValidateOptions options;
  options.weld = weld_from(weld);
  options.precision = (how & 1) != 0 ? Precision::f32 : Precision::f64;
  options.jobs = 1;
  CompileOptions compile_options;
  compile_options.weld = options.weld;
  compile_options.precision = options.precision;
  compile_options.merge = (how & 2) != 0;
  compile_options.store_planes = (how & 4) != 0;
  compile_options.self_intersections = (how & 8) != 0;
  compile_options.jobs = 1;
  if ((how & 16) != 0) options.allow = compile_options.allow = {"inside-out", "boundary-edge"};
  const PolygonSoup soup = soup_from(bytes);
  if (soup.face_count() == 0) return 0;  // no reader returns such a soup

  const Report report = validate(soup, options);
  require(report.faces == soup.face_count() && report.kept_faces <= report.faces, "faces are kept or not");
  for (const Issue& issue : report.issues)
    require(issue.total > 0 && issue.elements.size() <= issue.total && find_rule(issue.rule) != nullptr, "issues are counted");
  if (size % 8 == 1) {
    options.jobs = 2;
    require(report_json({validate(soup, options)}) == report_json({report}), "the same report from two threads");
  }
  const Result<Compiled> compiled = compile(soup, compile_options);
  require(compiled.has_value() || compiled.error().exit_code == 3, "compile refuses with a reason");
  if (!compiled) return 0;
  require(compiled->report.passes() == report.passes(), "compile accepts what validate passes");
  require(compiled->report.passes() == !compiled->file().empty(), "a file where the report passes");
  if (!compiled->file().empty()) check_file(compiled->file());
  return 0;
}
