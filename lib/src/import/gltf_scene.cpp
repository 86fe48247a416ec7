// SPDX-License-Identifier: Apache-2.0
#include "import/gltf_scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "base/srgb.hpp"
#include "import/gltf_accessor.hpp"
#include "import/gltf_draco.hpp"
#include "import/gltf_haptics.hpp"
#include "import/gltf_heights.hpp"
#include "import/gltf_placing.hpp"
#include "import/gltf_scene_physics.hpp"

namespace fdcg::bake::gltf {
namespace {

constexpr std::uint64_t kPrimitiveCost = 64;  // in elements: overhead of a primitive beside its points and corners
constexpr std::size_t kMaxNameBytes = 128;    // of a node or a mesh, in the name of a part

constexpr std::array<float, 2> kNoPlace = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::quiet_NaN()};
constexpr Colour kWhite = {1, 1, 1, 1};

// Cut to kMaxNameBytes, never inside a UTF-8 character.
std::string cut(const std::string& name) {
  std::size_t size = std::min(name.size(), kMaxNameBytes);
  while (size < name.size() && size > 0 && (static_cast<unsigned char>(name[size]) & 0xC0) == 0x80)
    --size;
  return name.substr(0, size);
}

std::string name_or(const std::string& name, const char* list, Index index) {
  return name.empty() ? std::string(list) + "[" + std::to_string(index) + "]" : cut(name);
}

class SceneBuilder {
 public:
  SceneBuilder(const Document& document, Buffers& buffers, const MeshText& input, PolygonSoup& soup)
      : document_(document), buffers_(buffers), input_(input), soup_(soup), physics_(document) {}

  void build() {
    find_shown_nodes();
    draco_.decode(document_, shown_, buffers_, input_.bytes.size());
    for (std::size_t i = 0; i < shown_.size(); ++i) {
      show(shown_[i]);
      constexpr std::size_t kReportEvery = 1024;  // nodes
      if (input_.progress && i % kReportEvery == 0) {
        input_.progress("import", static_cast<double>(i) / static_cast<double>(shown_.size()));
      }
    }
    show_physics();
    if (!soup_.corner_normals.empty()) soup_.corner_normals.resize(soup_.corners.size());
    if (input_.wants_appearance) finish_appearance();
    if (input_.wants_haptics) measure_haptics(document_, buffers_, haptic_runs_, soup_);
    rounding_.finish(soup_);
    materials_.finish(soup_);
    for (const auto& [what, count] : ignored_) {
      if (count > 0) soup_.ignored.push_back({what, count});
    }
  }

 private:
  // ---- the nodes of the scene and their transforms

  // Depth first, a node before its children, in the file's order.
  void find_shown_nodes() {
    world_of_.assign(document_.nodes.size(), kNone);
    std::vector<bool> is_shown(document_.nodes.size());
    std::vector<Index> open(document_.roots.rbegin(), document_.roots.rend());
    while (!open.empty()) {
      const Index n = open.back();
      open.pop_back();
      const Node& node = document_.nodes[n];
      is_shown[n] = true;
      shown_.push_back(n);
      place(n);
      physics_.add(n, world_of(n), name_or(node.name, "nodes", n));
      open.insert(open.end(), node.children.rbegin(), node.children.rend());
    }
    physics_.finish();
    for (Index n = 0; n < document_.nodes.size(); ++n) {
      if (!is_shown[n] && document_.nodes[n].mesh != kNone) ++count("nodes with a mesh outside the scene");
    }
    std::vector<bool> has_node(document_.meshes.size());
    for (const Node& node : document_.nodes) {
      if (node.mesh != kNone) has_node[node.mesh] = true;
    }
    for (const bool has : has_node)
      count("meshes of no node") += has ? 0 : 1;
  }

  // Null: the identity. Of a node that was placed, until the next one is.
  [[nodiscard]] const Matrix* world_of(Index n) const { return world_of_[n] == kNone ? nullptr : &worlds_[world_of_[n]]; }

  // Identity times identity is stored as no matrix, so that untransformed points keep their bits.
  void place(Index n) {
    const Node& node = document_.nodes[n];
    const Index above = node.parent != kNone ? world_of_[node.parent] : kNone;
    if (node.matrix == kNone) {
      world_of_[n] = above;
      return;
    }
    const Matrix& own = document_.matrices[node.matrix];
    const Matrix world = above == kNone ? own : product(worlds_[above], own);
    if (!std::all_of(world.begin(), world.end(), [](double c) { return std::isfinite(c); })) {
      throw Refusal{"nodes[" + std::to_string(n) + "]: its transform and those above it multiply to more than a double holds"};
    }
    world_of_[n] = static_cast<Index>(worlds_.size());
    worlds_.push_back(world);
  }

  // ---- primitives

  void show(Index n) {
    const Node& node = document_.nodes[n];
    if (node.mesh == kNone) return;
    if (node.has_skin) ++count("skins (shown at rest)");
    const Mesh& mesh = document_.meshes[node.mesh];
    const Matrix* const world = world_of(n);
    for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
      const std::size_t faces = soup_.face_count();
      charge(primitives_, 1);
      begin_material(n, mesh.primitives[p].material, mesh.haptic);
      const std::uint32_t first_point = show(mesh.primitives[p], world);
      if (soup_.face_count() == faces) continue;
      take_material(mesh.primitives[p].material);
      if (mesh.haptic != kNone) haptic_runs_.push_back({faces, soup_.face_count(), mesh.haptic});
      soup_.parts.push_back(
          {name_or(node.name, "nodes", n) + "/" + name_or(mesh.name, "meshes", node.mesh) + "/primitive " + std::to_string(p),
           static_cast<std::uint32_t>(faces), first_point});
    }
  }

  // What the hand feels: the physics material of the node, else the haptic one of the mesh, else the one that is seen. One
  // without a name is named by its index.
  void begin_material(Index node, Index material, Index haptic) {
    std::string name = material == kNone ? std::string() : document_.materials[material];
    if (material != kNone && name.empty()) name = name_or(name, "materials", material);
    if (haptic != kNone) name = document_.haptics[haptic].name;
    if (const std::string* const physical = physics_.material_of(node)) name = *physical;
    if (!materials_.begin(soup_, name)) ++count("materials beyond the 65,535th");
  }

  // Returns the index of its first point.
  std::uint32_t show(const Primitive& primitive, const Matrix* world) {
    if (!primitive.positions && !primitive.draco_view) {
      ++count("primitives without positions");
      return 0;
    }
    if (primitive.has_targets) ++count("primitives with morph targets (shown at rest)");
    if (primitive.draco_view) return show_draco(primitive, world);
    const Positions positions(document_, *primitive.positions, buffers_);
    const Indices indices = primitive.indices ? Indices(document_, *primitive.indices, buffers_) : Indices(positions.count());
    if (count_if_no_faces(primitive.mode, indices.count())) return 0;
    const std::uint32_t first_point = place_points({false, *primitive.positions, 0}, positions.count(), grain_of(positions),
                                                   world, [&positions](const auto& use) { positions.for_each(use); });
    const auto resolve = [&indices, first_point, limit = positions.count()](std::uint64_t i) {
      const std::uint32_t index = indices.at(i);
      return index < limit ? first_point + index : PolygonSoup::kInvalidVertex;
    };
    const std::size_t first_corner = soup_.corners.size();
    add_faces(primitive.mode, indices.count(), world != nullptr && is_mirrored(*world), resolve);
    if (primitive.normals) take_normals(*primitive.normals, positions.count(), first_point, first_corner, world);
    const auto taken = [&](Index accessor, auto& of_corners, const auto& none, const auto& convert) {
      const Attribute attribute(document_, accessor, buffers_);
      if (attribute.count() != positions.count()) {
        ++count("primitives whose texture coordinates or colours are not as many as their positions");
        return;
      }
      fill(first_corner, first_point, of_corners, none, [&](std::uint32_t p) { return convert(attribute.at(p)); });
    };
    Appearance& look = soup_.appearance;
    if (primitive.uv) taken(*primitive.uv, look.uv, kNoPlace, place_of<double>);
    if (primitive.has_height_uv) {
      copy_places(first_corner);
      if (primitive.height_uv) taken(*primitive.height_uv, look.height_uv, kNoPlace, place_of<double>);
      look.height_uv.resize(soup_.corners.size(), kNoPlace);
    }
    if (primitive.colours) taken(*primitive.colours, look.colours, kWhite, colour_of<double>);
    return first_point;
  }

  template <class Number>
  static std::array<float, 2> place_of(const std::array<Number, 4>& value) {
    return {static_cast<float>(value[0]), static_cast<float>(value[1])};
  }
  template <class Number>
  static Colour colour_of(const std::array<Number, 4>& value) {
    return {share_of(value[0]), share_of(value[1]), share_of(value[2]), share_of(value[3])};
  }

  // Of the corners since first_corner, by the numbers of their points in the primitive; those before it that have none are
  // `none`.
  template <class Value, class At>
  void fill(std::size_t first_corner, std::uint32_t first_point, std::vector<Value>& of_corners, const Value& none,
            const At& at) const {
    of_corners.resize(soup_.corners.size(), none);
    for (std::size_t i = first_corner; i < soup_.corners.size(); ++i)
      if (soup_.corners[i] != PolygonSoup::kInvalidVertex) of_corners[i] = at(soup_.corners[i] - first_point);
  }

  // Of the corners up to this one that have no places for heights of their own: those for the eye.
  void copy_places(std::size_t end) {
    Appearance& look = soup_.appearance;
    for (std::size_t i = look.height_uv.size(); i < end; ++i)
      look.height_uv.push_back(i < look.uv.size() ? look.uv[i] : kNoPlace);
  }

  // Of the faces since the last call: what is seen, whatever is felt.
  void take_material(Index material) {
    if (!input_.wants_appearance || document_.materials.empty()) return;
    const bool has = material < Appearance::kNoMaterial;
    soup_.appearance.face_material.resize(soup_.face_count(),
                                          has ? static_cast<std::uint16_t>(material) : Appearance::kNoMaterial);
  }

  void finish_appearance() {
    Appearance& look = soup_.appearance;
    if (!look.uv.empty()) look.uv.resize(soup_.corners.size(), kNoPlace);
    if (!look.height_uv.empty()) copy_places(soup_.corners.size());
    if (!look.colours.empty()) look.colours.resize(soup_.corners.size(), kWhite);
    if (look.face_material.empty()) return;
    look.face_material.resize(soup_.face_count(), Appearance::kNoMaterial);
    for (std::size_t m = 0; m < document_.materials.size() && m < Appearance::kNoMaterial; ++m) {
      const bool has_colour = m < document_.base_colours.size();
      look.materials.push_back({document_.materials[m], has_colour ? document_.base_colours[m] : kWhite});
    }
    if (input_.wants_heights) add_normal_heights(document_, buffers_, soup_);
  }

  // Of the corners since first_corner. Normals go by the inverse transpose of the transform.
  void take_normals(Index accessor, std::uint64_t points, std::uint32_t first_point, std::size_t first_corner,
                    const Matrix* world) {
    const Positions normals(document_, accessor, buffers_);
    if (normals.count() != points) {
      ++count("primitives whose normals are not as many as their positions");
      return;
    }
    std::vector<Vec3> of_point;
    normals.for_each([&](const Vec3& n) { of_point.push_back(world != nullptr ? turned_normal(*world, n) : n); });
    fill(first_corner, first_point, soup_.corner_normals, Vec3{}, [&](std::uint32_t p) { return of_point[p]; });
  }

  // By the cofactors, with the determinant's sign: the inverse transpose but for its length.
  static Vec3 turned_normal(const Matrix& m, const Vec3& n) {
    const double s = is_mirrored(m) ? -1 : 1;
    return {s * ((m[5] * m[10] - m[6] * m[9]) * n.x + (m[2] * m[9] - m[1] * m[10]) * n.y + (m[1] * m[6] - m[2] * m[5]) * n.z),
            s * ((m[6] * m[8] - m[4] * m[10]) * n.x + (m[0] * m[10] - m[2] * m[8]) * n.y + (m[2] * m[4] - m[0] * m[6]) * n.z),
            s * ((m[4] * m[9] - m[5] * m[8]) * n.x + (m[1] * m[8] - m[0] * m[9]) * n.y + (m[0] * m[5] - m[1] * m[4]) * n.z)};
  }

  std::uint32_t show_draco(const Primitive& primitive, const Matrix* world) {
    const DracoMeshes::Mesh& mesh = draco_.mesh_of(primitive);
    const Grain grain = {mesh.is_float ? 0x1p-24 : 0x1p-53, mesh.absolute_quantum};
    const std::uint32_t first_point = place_points({true, *primitive.draco_view, primitive.draco_positions}, mesh.points.size(),
                                                   grain, world, [&mesh](const auto& use) {
                                                     for (const Vec3& p : mesh.points)
                                                       use(p);
                                                   });
    const auto resolve = [&mesh, first_point](std::uint64_t i) {
      const std::uint32_t index = mesh.corners[i];
      return index < mesh.points.size() ? first_point + index : PolygonSoup::kInvalidVertex;
    };
    const std::size_t first_corner = soup_.corners.size();
    add_faces(Mode::triangles, mesh.corners.size(), world != nullptr && is_mirrored(*world), resolve);
    take_draco_extras(primitive, mesh, first_point, first_corner, world);
    const std::uint64_t promised =
        primitive.indices && primitive.mode == Mode::triangles ? document_.accessors[*primitive.indices].count / 3 : 0;
    if (promised > mesh.corners.size() / 3) count("faces promised beyond the Draco data") += promised - mesh.corners.size() / 3;
    return first_point;
  }

  void take_draco_extras(const Primitive& primitive, const DracoMeshes::Mesh& mesh, std::uint32_t first_point,
                         std::size_t first_corner, const Matrix* world) {
    const auto taken = [&](DracoExtra which, auto& of_corners, const auto& none, const auto& convert) {
      const std::span<const DracoValue> values = mesh.extra(which);
      if (!values.empty())
        fill(first_corner, first_point, of_corners, none, [&](std::uint32_t p) { return convert(values[p]); });
      else if (primitive.draco_extras[static_cast<std::size_t>(which)])
        ++count("primitives whose Draco data has not the normals, texture coordinates or colours that they promise");
    };
    Appearance& look = soup_.appearance;
    taken(DracoExtra::normal, soup_.corner_normals, Vec3{}, [&](const DracoValue& n) {
      const Vec3 normal = {double{n[0]}, double{n[1]}, double{n[2]}};
      return world != nullptr ? turned_normal(*world, normal) : normal;
    });
    taken(DracoExtra::uv, look.uv, kNoPlace, place_of<float>);
    if (primitive.has_height_uv) {
      copy_places(first_corner);
      taken(DracoExtra::height_uv, look.height_uv, kNoPlace, place_of<float>);
      look.height_uv.resize(soup_.corners.size(), kNoPlace);
    }
    taken(DracoExtra::colour, look.colours, kWhite, colour_of<float>);
  }

  // ---- physics: boxes are faces where the scene shows no mesh

  void show_physics() {
    std::vector<StatedShape>& shapes = physics_.stated().shapes;
    const bool has_mesh = soup_.face_count() > 0;
    for (std::size_t s = 0; s < shapes.size(); ++s) {
      shapes[s].has_faces = !has_mesh && physics_.shape(s).kind == ImplicitShape::Kind::box;
      if (shapes[s].has_faces) {
        show_box(s);
      } else {
        ++count(has_mesh ? "shapes of colliders beside the meshes" : "shapes of colliders that have no faces");
      }
    }
    count("triggers") += physics_.triggers();
    if (!document_.physics.trouble.empty()) ++count("physics extensions left out, since " + document_.physics.trouble);
    soup_.physics = std::move(physics_.stated());
  }

  void show_box(std::size_t s) {
    const Matrix* const world = world_of(physics_.node(s));
    const std::array<Vec3, 8> corners = corners_of_box(physics_.shape(s));
    charge(primitives_, 1);
    begin_material(physics_.node(s), kNone, kNone);
    const auto first_face = static_cast<std::uint32_t>(soup_.face_count());
    const std::uint32_t first =
        place_points({false, kNone, static_cast<std::uint32_t>(s)}, corners.size(), {}, world, [&corners](const auto& use) {
          for (const Vec3& p : corners)
            use(p);
        });
    charge(corners_, 4 * kBoxFaces.size());
    for (std::array<std::uint32_t, 4> face : kBoxFaces) {
      if (world != nullptr && is_mirrored(*world)) std::swap(face[1], face[3]);
      for (const std::uint32_t corner : face)
        soup_.corners.push_back(first + corner);
      soup_.face_first.push_back(static_cast<std::uint32_t>(soup_.corners.size()));
    }
    soup_.parts.push_back({physics_.stated().shapes[s].node + "/box", first_face, first});
  }

  // Points and lines are only counted.
  bool count_if_no_faces(Mode mode, std::uint64_t corners) {
    const std::uint64_t lines = corners < 2               ? 0
                                : mode == Mode::lines     ? corners / 2
                                : mode == Mode::line_loop ? corners
                                                          : corners - 1;
    if (mode == Mode::points) count("points") += corners;
    if (mode == Mode::lines || mode == Mode::line_loop || mode == Mode::line_strip) count("line elements") += lines;
    return mode < Mode::triangles;
  }

  // ---- points: those of an accessor once for each transform, however many primitives share them

  using PointsKey = std::tuple<bool, Index, std::uint32_t>;  // Draco or not, view or accessor, unique id

  template <class ForEach>
  std::uint32_t place_points(const PointsKey& source, std::uint64_t points, const Grain& grain, const Matrix* world,
                             const ForEach& for_each) {
    const auto [placed, is_new] = placed_.emplace(std::pair(source, world != nullptr ? *world : kIdentity),
                                                  static_cast<std::uint32_t>(soup_.points.size()));
    if (!is_new) return placed->second;
    charge(points_, points);
    make_room(soup_.points, points);
    std::array<double, 3> largest{};
    for_each([&](const Vec3& p) {
      soup_.points.push_back(world != nullptr ? applied(*world, p) : p);
      const std::array<double, 3> size = {std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)};
      for (std::size_t k = 0; k < 3; ++k) {
        if (size[k] <= std::numeric_limits<double>::max()) largest[k] = std::max(largest[k], size[k]);
      }
    });
    rounding_.note(grain, largest, world);
    return placed->second;
  }

  // ---- faces

  template <class Resolve>
  void add_faces(Mode mode, std::uint64_t corners, bool is_flipped, const Resolve& corner) {
    if (mode == Mode::triangles) {
      charge(corners_, corners);
      make_room(soup_.corners, corners);
      make_room(soup_.face_first, corners / 3);
      for (std::uint64_t i = 0; i + 2 < corners; i += 3)
        add_face(corner(i), corner(i + 1), corner(i + 2), is_flipped);
      if (corners % 3 != 0) count("corners left over after the last triangle") += corners % 3;
      return;
    }
    if (corners < 3) {
      if (corners > 0)
        ++count(mode == Mode::triangle_fan ? "fans of fewer than three vertices" : "strips of fewer than three vertices");
      return;
    }
    charge(corners_, 3 * (corners - 2));
    make_room(soup_.corners, 3 * (corners - 2));
    make_room(soup_.face_first, corners - 2);
    for (std::uint64_t i = 0; i + 2 < corners; ++i) {
      if (mode == Mode::triangle_fan) {
        add_face(corner(0), corner(i + 1), corner(i + 2), is_flipped);
      } else {
        add_strip_face(corner(i), corner(i + 1), corner(i + 2), is_flipped != (i % 2 == 1));
      }
    }
  }

  // Writers join strips by repeating vertices: a triangle with a repeated vertex is such a joint and not a face.
  void add_strip_face(std::uint32_t a, std::uint32_t b, std::uint32_t c, bool is_flipped) {
    constexpr std::uint32_t kInvalid = PolygonSoup::kInvalidVertex;
    const bool is_known = a != kInvalid && b != kInvalid && c != kInvalid;
    if (is_known && (a == b || b == c || c == a)) {
      ++count("strip joints");
    } else {
      add_face(a, b, c, is_flipped);
    }
  }

  void add_face(std::uint32_t a, std::uint32_t b, std::uint32_t c, bool is_flipped) {
    if (is_flipped) std::swap(b, c);
    for (const std::uint32_t corner : {a, b, c})
      soup_.corners.push_back(corner);
    soup_.face_first.push_back(static_cast<std::uint32_t>(soup_.corners.size()));
  }

  // ---- limits

  [[nodiscard]] std::size_t file_bytes() const { return input_.bytes.size() + buffers_.outside_bytes(); }

  struct Budget {
    const char* what;
    std::uint64_t cost;  // elements, of each
    std::uint64_t most;  // that the soup can number
    std::uint64_t used = 0;
  };

  void charge(Budget& budget, std::uint64_t more) const {
    const std::uint64_t limit = (kFreeElements + kElementsPerByte * (file_bytes() + draco_.plain_bytes())) / budget.cost;
    if (more > limit - std::min(budget.used, limit)) {
      throw Refusal{"shows more than " + std::to_string(limit) + " " + budget.what +
                    ", the limit for a file of this size; export instances as meshes of their own"};
    }
    if (more > budget.most - budget.used) {
      throw Refusal{"holds more than " + std::to_string(budget.most) + " " + budget.what + "; cut the mesh into parts"};
    }
    budget.used += more;
  }

  // Grows geometrically, as push_back does, so that many small primitives do not cause an allocation each.
  template <class T>
  static void make_room(std::vector<T>& values, std::uint64_t more) {
    const std::size_t wanted = values.size() + static_cast<std::size_t>(more);
    if (wanted > values.capacity()) values.reserve(std::max(wanted, 2 * values.size()));
  }

  std::uint64_t& count(const std::string& what) { return ignored_[what]; }

  const Document& document_;
  Buffers& buffers_;
  const MeshText& input_;
  PolygonSoup& soup_;

  std::vector<Index> shown_;     // nodes
  std::vector<Index> world_of_;  // of each node that is shown: in worlds_; none: identity
  std::vector<Matrix> worlds_;
  SceneDraco draco_;
  std::vector<HapticRun> haptic_runs_;
  std::map<std::pair<PointsKey, Matrix>, std::uint32_t> placed_;
  Budget points_{"points", 1, kMaxPoints}, corners_{"face corners", 1, kMaxCorners};
  Budget primitives_{"primitives", kPrimitiveCost, kMaxCorners};
  std::map<std::string, std::uint64_t> ignored_;
  Rounding rounding_;
  MaterialList materials_;
  ScenePhysics physics_;
};

}  // namespace

void build_scene(const Document& document, Buffers& buffers, const MeshText& input, PolygonSoup& soup) {
  SceneBuilder(document, buffers, input, soup).build();
}

}  // namespace fdcg::bake::gltf
