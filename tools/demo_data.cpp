// SPDX-License-Identifier: Apache-2.0
// What tools/demo needs beside the two programs: the numbers and images of the picture.
//
//   fdcg_demo_data GRAPH.fdcg LOG.csv FOLDER    FOLDER/{whole,close}.rgb, path.dat, frame.gp for tools/demo.gp
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "fdcg/fdcg.h"

namespace {

using Vec = std::array<double, 3>;

Vec operator+(const Vec& a, const Vec& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
Vec operator-(const Vec& a, const Vec& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Vec operator*(double s, const Vec& a) {
  return {s * a[0], s * a[1], s * a[2]};
}
double dot(const Vec& a, const Vec& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
double length(const Vec& a) {
  return std::sqrt(dot(a, a));
}
Vec unit(const Vec& a) {
  return (1 / length(a)) * a;
}

struct Graph {
  fdcg_graph view{};
  Vec centre{};
  double size = 0;  // the bounding box's diagonal, metres

  explicit Graph(const char* path) {
    fdcg_error error{};
    if (fdcg_open_file(path, FDCG_VERIFY_FULL, &view, &error) != FDCG_OK) {
      std::fprintf(stderr, "fdcg_demo_data: %s: %s\n", path, error.message);
      std::exit(3);
    }
    const Vec low = in_metres(view.header->bounds_min), high = in_metres(view.header->bounds_max);
    centre = 0.5 * (low + high);
    size = length(high - low);
  }
  ~Graph() { fdcg_close(&view); }
  Graph(const Graph&) = delete;
  Graph& operator=(const Graph&) = delete;

  [[nodiscard]] Vec in_metres(const double (&local)[3]) const {
    const fdcg_header& h = *view.header;
    return h.metres_per_unit * Vec{local[0] + h.origin[0], local[1] + h.origin[1], local[2] + h.origin[2]};
  }
};

// An orthographic view, from where the hand of `fdcg-servo replay --path slide` comes: right and up in the picture, toward the
// viewer. Metres from the object's centre.
struct Camera {
  Vec centre, right, up, toward;

  explicit Camera(const Graph& graph) : centre(graph.centre) {
    constexpr double kTurn = 25 * std::numbers::pi / 180, kTilt = 12 * std::numbers::pi / 180;
    toward = {std::sin(kTurn) * std::cos(kTilt), std::sin(kTilt), std::cos(kTurn) * std::cos(kTilt)};
    right = {std::cos(kTurn), 0, -std::sin(kTurn)};
    up = {-std::sin(kTurn) * std::sin(kTilt), std::cos(kTilt), -std::cos(kTurn) * std::sin(kTilt)};
  }
  [[nodiscard]] Vec project(const Vec& p) const {
    return {dot(p - centre, right), dot(p - centre, up), dot(p - centre, toward)};
  }
};

// ---- the picture -----------------------------------------------------------------------------------------------------------

struct Window {
  double left, bottom, width, height;  // metres in the picture plane
  int columns, rows;                   // of the image
  bool wire;                           // draw the connections, shade flat
};

constexpr int kSamples = 2;  // a pixel's side in samples
constexpr std::array<double, 3> kPaper{255, 255, 255};
constexpr std::array<double, 3> kClay{214, 205, 190};

class Image {
 public:
  Image(const Window& window, const Camera& camera)
      : window_(window),
        camera_(camera),
        columns_(window.columns * kSamples),
        rows_(window.rows * kSamples),
        depth_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), -std::numeric_limits<double>::infinity()),
        colour_(depth_.size(), kPaper) {}

  void draw(const Graph& graph) {
    for (std::uint32_t n = 0; n < graph.view.header->node_count; ++n) {
      const fdcg_node_info node = fdcg_get_node(&graph.view, n);
      const Vec normal{node.normal[0], node.normal[1], node.normal[2]};
      if (dot(normal, camera_.toward) <= 0) continue;
      for (std::uint32_t k = 1; k + 1 < node.side_count; ++k) {
        const std::uint32_t loop[3] = {fdcg_get_side(&graph.view, n, 0).corner, fdcg_get_side(&graph.view, n, k).corner,
                                       fdcg_get_side(&graph.view, n, k + 1).corner};
        const bool real[3] = {k == 1, true, k + 2 == node.side_count};  // a side of the node, not a cut of the fan
        draw_triangle(graph, loop, real, normal);
      }
    }
  }

  void write(const std::string& path) const {
    std::ofstream out(path, std::ios::binary);
    for (int row = 0; row < window_.rows; ++row) {
      for (int column = 0; column < window_.columns; ++column) {
        std::array<double, 3> sum{};
        for (int i = 0; i < kSamples * kSamples; ++i) {
          const auto& sample = colour_[index(column * kSamples + i % kSamples, row * kSamples + i / kSamples)];
          for (std::size_t c = 0; c < 3; ++c)
            sum[c] += sample[c] / (kSamples * kSamples);
        }
        for (const double c : sum)
          out.put(static_cast<char>(static_cast<unsigned char>(std::lround(c))));
      }
    }
  }

 private:
  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
  }

  [[nodiscard]] Vec sample_point(const Vec& metres) const {
    const Vec p = camera_.project(metres);
    return {(p[0] - window_.left) / window_.width * columns_, (p[1] - window_.bottom) / window_.height * rows_, p[2]};
  }

  void draw_triangle(const Graph& graph, const std::uint32_t (&loop)[3], const bool (&real)[3], const Vec& face_normal) {
    Vec p[3], normals[3];
    for (int i = 0; i < 3; ++i) {
      const fdcg_corner_info corner = fdcg_get_corner(&graph.view, loop[i]);
      p[i] = sample_point(graph.in_metres(corner.point));
      normals[i] = window_.wire ? face_normal : Vec{corner.normal[0], corner.normal[1], corner.normal[2]};
    }
    const double area = (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]);
    if (area <= 0) return;
    const auto low = [&](int axis) { return std::floor(std::min({p[0][axis], p[1][axis], p[2][axis]})); };
    const auto high = [&](int axis) { return std::ceil(std::max({p[0][axis], p[1][axis], p[2][axis]})); };
    const int first_column = static_cast<int>(std::max(0.0, low(0))),
              last_column = static_cast<int>(std::min<double>(columns_ - 1, high(0)));
    const int first_row = static_cast<int>(std::max(0.0, low(1))),
              last_row = static_cast<int>(std::min<double>(rows_ - 1, high(1)));
    for (int row = first_row; row <= last_row; ++row) {
      for (int column = first_column; column <= last_column; ++column) {
        double weight[3], nearest_line = std::numeric_limits<double>::infinity();
        for (int i = 0; i < 3; ++i) {  // weight i belongs to the side from corner i + 1 to corner i + 2
          const Vec &a = p[(i + 1) % 3], &b = p[(i + 2) % 3];
          const double cross = (b[0] - a[0]) * (row + 0.5 - a[1]) - (b[1] - a[1]) * (column + 0.5 - a[0]);
          weight[i] = cross / area;
          if (real[(i + 1) % 3]) nearest_line = std::min(nearest_line, cross / std::hypot(b[0] - a[0], b[1] - a[1]));
        }
        if (weight[0] < 0 || weight[1] < 0 || weight[2] < 0) continue;
        const double depth = weight[0] * p[0][2] + weight[1] * p[1][2] + weight[2] * p[2][2];
        if (depth <= depth_[index(column, row)]) continue;
        depth_[index(column, row)] = depth;
        const Vec normal = unit(weight[0] * normals[0] + weight[1] * normals[1] + weight[2] * normals[2]);
        colour_[index(column, row)] = shade(normal, window_.wire && nearest_line < 0.5 * kSamples);
      }
    }
  }

  // A lamp to the upper left of the viewer, some light from everywhere, darker where the surface turns away.
  [[nodiscard]] std::array<double, 3> shade(const Vec& normal, bool on_line) const {
    const Vec lamp = unit(camera_.toward + 0.9 * camera_.up - 0.8 * camera_.right);
    const double lit = 0.38 + 0.62 * std::max(0.0, dot(normal, lamp));
    const double facing = std::max(0.0, dot(normal, camera_.toward));
    const double light = lit * (0.55 + 0.45 * std::sqrt(facing)) * (on_line ? 0.72 : 1.0);
    return {kClay[0] * light + 12, kClay[1] * light + 12, kClay[2] * light + 14};
  }

  const Window window_;
  const Camera& camera_;
  int columns_, rows_;
  std::vector<double> depth_;
  std::vector<std::array<double, 3>> colour_;
};

struct LogRow {
  double t;
  Vec hip, god_object, force;
  std::string state;
  long feature;
  int slip, transitions;
};

std::vector<LogRow> read_log(const char* path) {
  std::ifstream in(path);
  std::string line;
  std::getline(in, line);
  std::vector<LogRow> rows;
  while (std::getline(in, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream fields(line);
    LogRow row{};
    fields >> row.t;
    for (Vec* v : {&row.hip, &row.god_object, &row.force})
      fields >> (*v)[0] >> (*v)[1] >> (*v)[2];
    fields >> row.state >> row.feature >> row.slip >> row.transitions;
    if (!fields) {
      std::fprintf(stderr, "fdcg_demo_data: %s: row %zu is not of a log\n", path, rows.size() + 2);
      std::exit(3);
    }
    rows.push_back(row);
  }
  return rows;
}

// |Ft| / |Fn| on a face, "nan" elsewhere.
double friction_ratio(const Graph& graph, const LogRow& row) {
  if (row.state != "face") return std::numeric_limits<double>::quiet_NaN();
  const fdcg_node_info face = fdcg_get_node(&graph.view, row.feature);
  const Vec normal{face.normal[0], face.normal[1], face.normal[2]};
  const double pressing = dot(row.force, normal);
  return length(row.force - pressing * normal) / pressing;
}

void write_path_data(const Graph& graph, const Camera& camera, const std::vector<LogRow>& rows, const std::string& path) {
  std::ofstream out(path);
  out << "# t, HIP right, up, god-object right, up (mm in the picture), force (N), friction ratio, slip, transitions, "
         "touching\n";
  for (const LogRow& row : rows) {
    const Vec hip = camera.project(row.hip), god = camera.project(row.god_object);
    out << row.t << ' ' << 1e3 * hip[0] << ' ' << 1e3 * hip[1] << ' ' << 1e3 * god[0] << ' ' << 1e3 * god[1] << ' '
        << length(row.force) << ' ' << friction_ratio(graph, row) << ' ' << row.slip << ' ' << row.transitions << ' '
        << (row.state == "free" ? 0 : 1) << '\n';
  }
}

// The whole object, and a close view around the place where the hand is when `part` of the contact has passed.
std::array<Window, 2> windows_of(const Graph& graph, const Camera& camera, const std::vector<LogRow>& rows) {
  Vec low{1e300, 1e300, 0}, high{-1e300, -1e300, 0};
  for (std::uint32_t v = 0; v < graph.view.header->corner_count; ++v) {
    const Vec p = camera.project(graph.in_metres(fdcg_get_corner(&graph.view, v).point));
    for (std::size_t axis = 0; axis < 2; ++axis) {
      low[axis] = std::min(low[axis], p[axis]);
      high[axis] = std::max(high[axis], p[axis]);
    }
  }
  const double side = 1.04 * std::max(high[0] - low[0], high[1] - low[1]);
  const Window whole{0.5 * (low[0] + high[0] - side), 0.5 * (low[1] + high[1] - side), side, side, 660, 660, false};
  std::vector<const LogRow*> touching;
  for (const LogRow& row : rows) {
    if (row.state != "free") touching.push_back(&row);
  }
  if (touching.empty()) {
    std::fputs("fdcg_demo_data: the log never touches\n", stderr);
    std::exit(3);
  }
  constexpr double kPart = 0.375;
  const Vec at = camera.project(touching[static_cast<std::size_t>(kPart * static_cast<double>(touching.size()))]->god_object);
  const double near = 0.05 * side;
  return {whole, Window{at[0] - 0.5 * near, at[1] - 0.5 * near, near, near, 360, 360, true}};
}

void write_picture(const Graph& graph, const char* log, const std::string& folder) {
  const Camera camera(graph);
  const std::vector<LogRow> rows = read_log(log);
  const std::array<Window, 2> windows = windows_of(graph, camera, rows);
  const std::array<std::string, 2> names{"whole", "close"};
  std::ofstream frame(folder + "/frame.gp");
  for (std::size_t i = 0; i < windows.size(); ++i) {
    Image image(windows[i], camera);
    image.draw(graph);
    image.write(folder + "/" + names[i] + ".rgb");
    const Window& w = windows[i];
    frame << names[i] << "_left = " << 1e3 * w.left << "\n" << names[i] << "_bottom = " << 1e3 * w.bottom << "\n";
    frame << names[i] << "_width = " << 1e3 * w.width << "\n" << names[i] << "_height = " << 1e3 * w.height << "\n";
    frame << names[i] << "_columns = " << w.columns << "\n" << names[i] << "_rows = " << w.rows << "\n";
  }
  write_path_data(graph, camera, rows, folder + "/path.dat");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 4) {
    write_picture(Graph(argv[1]), argv[2], argv[3]);
    return 0;
  }
  std::fputs("usage: fdcg_demo_data GRAPH.fdcg LOG.csv FOLDER\n", stderr);
  return 2;
}
