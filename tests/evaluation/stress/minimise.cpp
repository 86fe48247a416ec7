// SPDX-License-Identifier: Apache-2.0
#include "minimise.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <set>
#include <sstream>
#include <stdexcept>

#include "meshes.hpp"

namespace fdcg::test {
namespace {

constexpr int kMostRounds = 4;
constexpr int kMostTrials = 20'000;                       // compilations in all
constexpr int kShortBits[] = {3, 6, 10, 16, 24, 32, 40};  // of a coordinate

using Faces = std::vector<Polygon>;

Faces faces_of(const PolygonSoup& soup) {
  Faces faces;
  for (std::size_t f = 0; f < soup.face_count(); ++f)
    faces.push_back(face_corners(soup, f));
  return faces;
}

// Without the points that no face uses.
PolygonSoup soup_of(const PolygonSoup& like, const Faces& faces) {
  std::vector<std::uint32_t> place(like.points.size(), PolygonSoup::kInvalidVertex);
  std::vector<bake::Vec3> points;
  Faces renumbered = faces;
  for (Polygon& face : renumbered) {
    for (std::uint32_t& v : face) {
      if (place[v] == PolygonSoup::kInvalidVertex) {
        place[v] = static_cast<std::uint32_t>(points.size());
        points.push_back(like.points[v]);
      }
      v = place[v];
    }
  }
  PolygonSoup soup = make_soup("reproducer", std::move(points), renumbered);
  soup.relative_quantum = like.relative_quantum;
  return soup;
}

// To so many significant bits.
double shortened(double x, int bits) {
  if (x == 0 || !std::isfinite(x)) return x;
  const double unit = std::exp2(std::ilogb(x) - bits + 1);
  return std::round(x / unit) * unit;
}

// Of such a mesh nothing would say what is inside. The compiler warns of it, but does not refuse it.
bool passes_through_itself(const Body& body) {
  if (!body.is_closed) return false;
  bake::ValidateOptions options;
  options.precision = body.options.precision;
  options.jobs = 1;
  options.severities["self-intersection"] = bake::Severity::error;
  return !bake::validate(body.soup, options).passes();
}

class Minimiser {
 public:
  explicit Minimiser(Reproducer r) : best_(std::move(r)) { best_.body.focus.clear(); }

  Reproducer run() {
    if (!take(best_)) throw std::runtime_error("the reproducer does not fail: nothing to cut down");
    for (int round = 0; round < kMostRounds; ++round) {
      const std::size_t size = best_.path_m.size() + best_.body.soup.face_count();
      cut_ticks();
      if (asks_for_inside()) {
        draw_together();
      } else {
        cut_faces();
      }
      if (best_.path_m.size() + best_.body.soup.face_count() == size) break;
    }
    shorten();
    cut_ticks();
    return best_;
  }

 private:
  [[nodiscard]] bool asks_for_inside() const {
    return best_.fault == Fault::push_through || best_.fault == Fault::unseen || best_.fault == Fault::thin_air;
  }

  // Whether it fails; if so it is the best, without the ticks after the fault.
  bool take(Reproducer candidate) {
    if (trials_++ >= kMostTrials) return false;
    if (trials_ > 1 && passes_through_itself(candidate.body)) return false;
    try {
      const Specimen specimen(candidate.body);
      const std::int64_t tick = first_fault(specimen, candidate);
      if (tick < 0) return false;
      candidate.path_m.resize(static_cast<std::size_t>(tick) + 1);
    } catch (const std::runtime_error&) {  // refused by the compiler
      return false;
    }
    best_ = std::move(candidate);
    return true;
  }

  // Leaves out runs of items, halves first, single ones last; `without` makes the candidate.
  void cut(const std::function<std::size_t()>& count,
           const std::function<Reproducer(std::size_t first, std::size_t end)>& without) {
    for (std::size_t length = std::max<std::size_t>(1, count() / 2); length > 0; length /= 2) {
      for (std::size_t first = 0; first < count() && count() > 1;) {
        if (!take(without(first, std::min(first + length, count())))) first += length;
      }
    }
  }

  void cut_ticks() {
    // One specimen serves all: paths alone change.
    const Specimen specimen(best_.body);
    for (std::size_t length = std::max<std::size_t>(1, best_.path_m.size() / 2); length > 0; length /= 2) {
      for (std::size_t first = 0; first < best_.path_m.size();) {
        Reproducer candidate = best_;
        const std::size_t end = std::min(first + length, candidate.path_m.size());
        candidate.path_m.erase(candidate.path_m.begin() + static_cast<std::ptrdiff_t>(first),
                               candidate.path_m.begin() + static_cast<std::ptrdiff_t>(end));
        const std::int64_t tick = candidate.path_m.empty() ? -1 : first_fault(specimen, candidate);
        if (tick >= 0) {
          candidate.path_m.resize(static_cast<std::size_t>(tick) + 1);
          best_ = std::move(candidate);
        } else {
          first += length;
        }
      }
    }
  }

  void cut_faces() {
    cut([&] { return best_.body.soup.face_count(); },
        [&](std::size_t first, std::size_t end) {
          Faces faces = faces_of(best_.body.soup);
          faces.erase(faces.begin() + static_cast<std::ptrdiff_t>(first), faces.begin() + static_cast<std::ptrdiff_t>(end));
          Reproducer r = best_;
          r.body.soup = soup_of(best_.body.soup, faces);
          r.body.is_closed = false;
          return r;
        });
  }

  // One end of an edge moves onto the other; the faces between them vanish.
  [[nodiscard]] Reproducer with_drawn(std::uint32_t from, std::uint32_t onto) const {
    Faces faces;
    for (Polygon face : faces_of(best_.body.soup)) {
      std::replace(face.begin(), face.end(), from, onto);
      face.erase(std::unique(face.begin(), face.end()), face.end());
      while (face.size() > 1 && face.front() == face.back())
        face.pop_back();
      if (face.size() > 2) faces.push_back(std::move(face));
    }
    Reproducer r = best_;
    r.body.soup = soup_of(best_.body.soup, faces);
    return r;
  }

  void draw_together() {
    for (bool has_changed = true; has_changed && trials_ < kMostTrials;) {
      has_changed = false;
      std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
      for (const Polygon& face : faces_of(best_.body.soup)) {
        for (std::size_t k = 0; k < face.size(); ++k)
          edges.emplace(face[k], face[(k + 1) % face.size()]);
      }
      for (const auto& [from, onto] : edges) {
        if (!take(with_drawn(from, onto))) continue;
        has_changed = true;  // the points have other numbers now
        break;
      }
    }
  }

  void shorten() {
    for (const int bits : kShortBits) {
      Reproducer r = best_;
      for (bake::Vec3& p : r.body.soup.points)
        p = {shortened(p.x, bits), shortened(p.y, bits), shortened(p.z, bits)};
      if (take(std::move(r))) break;
    }
    for (std::size_t i = 0; i < best_.path_m.size(); ++i) {
      for (const int bits : kShortBits) {
        if (i >= best_.path_m.size()) return;
        Reproducer r = best_;
        for (double& x : r.path_m[i])
          x = shortened(x, bits);
        if (take(std::move(r))) break;
      }
    }
  }

  Reproducer best_;
  int trials_ = 0;
};

std::string text_of(const char* format, double x) {
  char text[40];
  std::snprintf(text, sizeof text, format, x);
  return text;
}

}  // namespace

Reproducer minimised(Reproducer reproducer) {
  return Minimiser(std::move(reproducer)).run();
}

std::string test_case_text(const Reproducer& r, const std::string& name) {
  const bake::CompileOptions& o = r.body.options;
  std::ostringstream text;
  text << "// " << r.body.description << "; " << r.command << "\nTEST_CASE(\"" << name << "\") {\n  Reproducer r;\n"
       << "  r.body.soup = make_soup(\"" << name_of(r.fault) << "\",\n                          {";
  for (const bake::Vec3& p : r.body.soup.points) {
    text << (&p == r.body.soup.points.data() ? "" : ", ") << "{" << text_of("%.17g", p.x) << ", " << text_of("%.17g", p.y)
         << ", " << text_of("%.17g", p.z) << "}";
  }
  text << "},\n                          {";
  for (std::size_t f = 0; f < r.body.soup.face_count(); ++f) {
    text << (f > 0 ? ", {" : "{");
    const Polygon face = face_corners(r.body.soup, f);
    for (std::size_t k = 0; k < face.size(); ++k)
      text << (k > 0 ? ", " : "") << face[k];
    text << "}";
  }
  text << "});\n  r.body.is_closed = " << (r.body.is_closed ? "true" : "false")
       << (r.body.sheets_meet ? ";\n  r.body.sheets_meet = true" : "")
       << ";\n  r.body.soup.relative_quantum = " << text_of("%a", r.body.soup.relative_quantum)
       << ";\n  r.body.options.precision = Precision::" << (o.precision == bake::Precision::f32 ? "f32" : "f64")
       << ";\n  r.body.options.coplanar.kind = Coplanar::Kind::"
       << (o.coplanar.kind == bake::Coplanar::Kind::quantum ? "quantum" : "exact")
       << ";\n  r.body.options.merge = " << (o.merge ? "true" : "false")
       << ";\n  r.body.options.store_planes = " << (o.store_planes ? "true" : "false")
       << ";\n  r.body.options.metres_per_unit = " << text_of("%.17g", o.metres_per_unit) << ";\n  r.params = contact_params("
       << text_of("%.17g", r.params.mu_static) << ", " << text_of("%.17g", r.params.mu_dynamic) << ", "
       << (r.params.edge_friction == FDCG_EDGE_PAPER ? "FDCG_EDGE_PAPER" : "FDCG_EDGE_WEDGE") << ");\n  r.path_m = {";
  for (const Hip& h : r.path_m) {
    text << (&h == r.path_m.data() ? "{" : ", {") << text_of("%a", h[0]) << ", " << text_of("%a", h[1]) << ", "
         << text_of("%a", h[2]) << "}";
  }
  text << "};\n  r.fault = *fault_named(\"" << name_of(r.fault)
       << "\");\n  CHECK(first_fault(Specimen(r.body), r) == -1);\n}\n";
  return text.str();
}

int minimise_file(const std::string& file) {
  const Reproducer whole = read_reproducer(file);
  const Reproducer small = minimised(whole);
  const std::string stem = file.ends_with(".obj") ? file.substr(0, file.size() - 4) : file;
  write_reproducer(stem + ".small.obj", small);
  std::ofstream test(stem + ".test.cpp");
  test << test_case_text(small, std::string(name_of(small.fault)) + " on " + small.body.description);
  if (!test.flush()) throw std::runtime_error(stem + ".test.cpp: cannot be written");
  std::printf("%zu faces and %zu ticks are now %zu and %zu: %s.small.obj, %s.test.cpp\n", whole.body.soup.face_count(),
              whole.path_m.size(), small.body.soup.face_count(), small.path_m.size(), stem.c_str(), stem.c_str());
  return 0;
}

}  // namespace fdcg::test
