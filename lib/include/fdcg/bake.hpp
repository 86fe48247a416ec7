// SPDX-License-Identifier: Apache-2.0
// Over 400 lines: every field is documented where it is declared.
/// @file fdcg/bake.hpp
/// The offline compiler as a library: mesh file -> polygon soup -> validated mesh -> FDCG bytes.
///
///     auto soup = fdcg::bake::import_mesh("bunny.ply");
///     auto compiled = fdcg::bake::compile(*soup, {});
///     if (compiled && compiled->report.passes()) write(compiled->bytes);
///
/// Bad meshes are values: a Failure where there is nothing to work on, a Report where there is.
///
/// **Frames, units, handedness.** Coordinates are those of the file, in its units, right-handed, no axis exchanged;
/// CompileOptions::metres_per_unit says what a unit is. **Ownership.** Results are values. **Threads.** Functions may be called
/// from several threads at once on different data; with `jobs` they use threads of their own.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "fdcg/appearance.hpp"
#include "fdcg/physics.hpp"

namespace fdcg::bake {

// ---- results -------------------------------------------------------------------------------------------------------------

/// Why there is no value. `exit_code` is the promise of the command line: 1 findings in the mesh, 2 wrong usage, 3 unreadable
/// input or unwritable output, 4 our own fault.
struct Failure {
  int exit_code = 4;    ///< as above
  std::string message;  ///< one line: file, element, value, limit, remedy
  std::string rule{};   ///< the rule that the report lists it under: unreadable or empty-mesh; empty where none fits
};

/// A value or a Failure; named like std::expected, which C++20 does not have.
template <class T>
class Result {
 public:
  /// Holds a value.
  Result(T value) : state_(std::move(value)) {}  // NOLINT(google-explicit-constructor)
  /// Holds a failure.
  Result(Failure failure) : state_(std::move(failure)) {}  // NOLINT(google-explicit-constructor)
  /// Whether there is a value.
  [[nodiscard]] bool has_value() const { return std::holds_alternative<T>(state_); }
  /// Whether there is a value.
  explicit operator bool() const { return has_value(); }
  /// The value; there must be one, here and in the next three.
  T& operator*() { return std::get<T>(state_); }
  /// The value.
  const T& operator*() const { return std::get<T>(state_); }
  /// The value.
  T* operator->() { return &std::get<T>(state_); }
  /// The value.
  const T* operator->() const { return &std::get<T>(state_); }
  /// The failure; there must be one.
  [[nodiscard]] const Failure& error() const { return std::get<Failure>(state_); }

 private:
  std::variant<T, Failure> state_;
};

/// A point or a direction.
struct Vec3 {
  double x = 0;  ///< right-handed
  double y = 0;  ///< likewise
  double z = 0;  ///< likewise
  /// By value: -0 equals 0.
  friend bool operator==(const Vec3&, const Vec3&) = default;
};

/// Called now and then with the stage's name and how far it has come (0..1). May be empty.
using Progress = std::function<void(std::string_view stage, double fraction)>;

// ---- import --------------------------------------------------------------------------------------------------------------

/// A mesh file's format.
enum class Format {
  off,      ///< OFF and its variants
  obj,      ///< Wavefront
  ply,      ///< all three encodings
  stl,      ///< text and binary
  gltf,     ///< glTF 2.0: JSON and GLB
  drc,      ///< Draco
  dae,      ///< COLLADA 1.4 and 1.5
  threemf,  ///< 3MF
  vtk,      ///< VTK polydata: legacy and XML (.vtp)
  x3d,      ///< X3D, XML encoding
};

/// What a file has beside faces, or what its encoding adds: left out of the soup, and counted so that nothing goes in silence.
struct Ignored {
  std::string what;         ///< plural: "line elements", "strip joints"
  std::uint64_t count = 0;  ///< of them
};

/// A named run of faces: an OBJ object or group with its material, a glTF node with its mesh's primitive. It ends where the
/// next begins.
struct Part {
  std::string name;               ///< as in the file
  std::uint32_t first_face = 0;   ///< where it begins
  std::uint32_t first_point = 0;  ///< glTF: of the primitive, whose own numbering starts there. Other formats: 0
};

/// The faces of a mesh file as the file has them: nothing merged, moved, rounded or dropped.
struct PolygonSoup {
  static constexpr std::uint32_t kInvalidVertex = 0xFFFFFFFFu;  ///< an index that the file has no vertex for
  static constexpr std::uint16_t kNoMaterial = 0xFFFF;          ///< a face without a material

  std::string name;                       ///< the path as the user gave it, for messages
  Format format = Format::off;            ///< of the file
  bool is_text = false;                   ///< text, or binary
  std::vector<Vec3> points;               ///< source units, source numbering; may hold NaN and infinities
  std::vector<std::uint32_t> face_first;  ///< face f has the corners face_first[f] .. face_first[f + 1] - 1
  std::vector<std::uint32_t> corners;     ///< indices into points, or kInvalidVertex
  std::vector<std::uint32_t> point_line;  ///< text formats: the line (1-based) of each point; else empty
  std::vector<std::uint32_t> face_line;   ///< text formats: the line of each face; else empty
  /// Half the spacing of the numbers in the file, as a bound on what rounding did to them: a coordinate c was known to within
  /// max(relative_quantum * |c|, absolute_quantum).
  double relative_quantum = 0;  ///< 2^-24 where every coordinate is a float, 2^-53 else
  double absolute_quantum = 0;  ///< decimal text: half a unit of the last digit printed, at most 1e-5 of the extent; else 0
  std::string sha256;           ///< of the file's bytes, 64 lower-case hex digits
  std::vector<Part> parts;      ///< ascending first_face; empty where the file names none
  /// OBJ's usemtl, glTF's materials, by name, in order of first use; empty where no face has one. A material of no name and one
  /// beyond the 65,535th are none.
  std::vector<std::string> materials;
  std::vector<std::uint16_t> face_material;  ///< of each face, or kNoMaterial; empty where there are no materials
  /// Of each entry of `corners`, where ImportOptions::normals asked for them and the file has any; not of unit length, 0 where
  /// the file has none at that corner. Empty: none.
  std::vector<Vec3> corner_normals;
  Appearance appearance;         ///< where ImportOptions::appearance asked for it
  std::vector<Ignored> ignored;  ///< what was left out
  double metres_per_unit = 0;    ///< as the file states it (COLLADA, 3MF); 0: it does not
  char up_axis = 0;              ///< COLLADA: 'x', 'y' or 'z', for information; 0: the file does not say
  StatedPhysics physics;         ///< glTF: friction, masses and shapes by formula
  std::vector<std::string>
      other_files;  ///< further files that the mesh is from: a glTF file's buffers, OBJ's materials, images

  /// Files that it names and that were not read, each with why and what to do, for a warning.
  std::vector<std::string> unread_files;

  /// Faces of the file.
  [[nodiscard]] std::size_t face_count() const { return face_first.empty() ? 0 : face_first.size() - 1; }
};

/// How a mesh file is read.
struct ImportOptions {
  std::optional<Format> format;  ///< default: by content, then by the file name's ending
  Progress progress;             ///< may be empty
  bool normals = false;          ///< read corner normals: OBJ's vn, PLY's nx ny nz, glTF's NORMAL, Draco's
  bool appearance = false;       ///< read PolygonSoup::appearance: of OBJ, PLY, glTF and Draco
  /// With `appearance`: read images of heights too (PNG). "file": those that the mesh file's materials name (map_bump, bump and
  /// disp of OBJ's libraries; normalTexture of glTF, whose normals are integrated); else the path of one for all faces. Empty:
  /// none.
  std::string heights = {};
  /// Experimental: read MPEG_haptic_material of glTF (ISO/IEC 23090-14) into StatedPhysics::haptic_materials, and name faces by
  /// it; reads `appearance` too.
  bool haptic_materials = false;
};

/// The most that is read of what is no regular file: a pipe, a terminal.
inline constexpr std::size_t kMostStreamBytes = std::size_t{64} << 20;

/// Reads OFF (also COFF, NOFF, comments), OBJ, PLY (ascii, both binaries), STL (ascii, binary), glTF 2.0 (JSON, GLB; buffers in
/// files beside or beneath it), Draco, COLLADA and 3MF. Never allocates more than a small multiple of the file's size (formats
/// with scenes: of what a scene may show, see docs/limits.md). Fails with exit code 3 on what cannot be read or holds no face.
/// Draco data is decoded in a child process (guarded_child.hpp).
Result<PolygonSoup> import_mesh(const std::filesystem::path& path, const ImportOptions& options = {});

/// The same from memory; `name` is for messages, and no other file is read.
Result<PolygonSoup> import_memory(std::string_view bytes, std::string name, const ImportOptions& options = {});

// ---- report --------------------------------------------------------------------------------------------------------------

/// How bad a finding is.
enum class Severity { note, warning, error };

/// One located finding. Indices in the source file's own numbering (0-based as they stand in the soup).
struct Element {
  std::vector<std::uint32_t> faces;                 ///< at most 32
  std::uint64_t more_faces = 0;                     ///< beyond these
  std::vector<std::array<std::uint32_t, 2>> edges;  ///< by their vertices
  std::vector<std::uint32_t> vertices;              ///< of the finding
  std::optional<Vec3> point;                        ///< source units
  std::optional<std::uint32_t> line;                ///< text formats
  std::string part;                                 ///< the name of the Part that the first face belongs to, if any
  /// Of the rule and the coordinates, as floats, of what was found (a patch: of its least corner), not of their numbers: stays
  /// when the file is renumbered or changed elsewhere. Several findings may share one, so compare as multisets.
  std::uint64_t fingerprint = 0;
  bool is_known = false;  ///< a baseline has it
};

/// Everything found under one rule.
struct Issue {
  std::string rule;                     ///< by name
  Severity severity = Severity::error;  ///< of each finding
  std::uint64_t total = 0;              ///< exact, however few elements are listed, unless is_at_least
  std::string message;                  ///< what, how many, and the remedy
  std::vector<Element> elements;        ///< the first max_elements of them, in source order; known ones last
  std::uint64_t known = 0;              ///< of these, accepted by a baseline: they do not fail the verdict
  bool is_at_least = false;             ///< total is where the count ended (self-intersection, at 1,000,000 pairs of triangles)
};

/// Everything found in a mesh.
struct Report {
  std::string file;              ///< as the user gave it
  std::uint64_t vertices = 0;    ///< of the file
  std::uint64_t faces = 0;       ///< of the file
  std::uint64_t components = 0;  ///< of faces joined by edges
  /// Faces that can be touched: every other face is listed under degenerate-face, index-out-of-range, non-finite-coordinate (by
  /// its vertices) or duplicate-face.
  std::uint64_t kept_faces = 0;
  std::vector<Ignored> ignored;     ///< as the soup has it
  std::vector<Issue> issues;        ///< errors first, then warnings, then notes; in the catalogue's order within
  std::vector<std::string> checks;  ///< the rules that were run
  std::set<std::string> allowed;    ///< rules whose errors do not fail the verdict
  std::optional<Severity> fail_on = Severity::error;  ///< findings from this severity on fail the verdict; none: nothing does
  std::string config;                                 ///< the configuration file that was followed, if any
  bool has_baseline = false;                          ///< findings were compared with a baseline
  std::map<std::string, std::uint64_t> resolved;      ///< by rule: findings of the baseline that are there no more
  double seconds = 0;                                 ///< spent on the file; 0: not measured

  /// No finding at or above `level` is neither allowed nor known.
  [[nodiscard]] bool passes(std::optional<Severity> level) const;
  /// The verdict: passes(fail_on).
  [[nodiscard]] bool passes() const { return passes(fail_on); }
};

/// One row of the catalogue of rules.
struct Rule {
  std::string_view name;     ///< as reports have it
  Severity severity;         ///< unless overridden
  std::string_view meaning;  ///< what it counts
  std::string_view why;      ///< what goes wrong at contact
  std::string_view remedy;   ///< what to do about it
  bool can_be_allowed;       ///< by compile --allow
};
/// The catalogue of rules, in the order of reports.
const std::vector<Rule>& rules();
/// A rule by name; null: there is none.
const Rule* find_rule(std::string_view name);

inline constexpr std::size_t kListedElements = 100;  ///< of each rule, in a report that is not full

/// A report as text for people.
std::string report_text(const Report& report, bool colour);

/// How reports are written.
enum class ReportFormat {
  text,   ///< for people
  json,   ///< schemas/validate-report.schema.json
  sarif,  ///< 2.1.0
  junit,  ///< the XML of Ant's JUnit task
};

/// Details of reports.
struct ReportOptions {
  std::size_t max_elements = kListedElements;  ///< of each issue; totals are exact all the same
  bool colour = false;                         ///< text
  std::string source_root;  ///< sarif: the absolute folder that relative paths start from; files in it get relative URIs
  bool result_per_element = false;                ///< sarif: a result for each listed element in place of one for each rule
  std::string timestamp = "1970-01-01T00:00:00";  ///< junit: when the run began, UTC
};

/// Writes the reports of many files one by one, so that only one need be in memory. add() for each file, then finish() once
/// with the exit code of the run. `write` gets pieces of any length, and is called by these two only.
class ReportWriter {
 public:
  virtual ~ReportWriter() = default;
  virtual void add(const Report& report) = 0;  ///< writes a file's report
  virtual void finish(int exit_code) = 0;      ///< writes the end
};
/// Makes a writer; `write` must live as long.
std::unique_ptr<ReportWriter> make_report_writer(ReportFormat format, std::function<void(std::string_view)> write,
                                                 const ReportOptions& options = {});

/// Reports as one string; the exit code is that of the verdicts and of files that could not be read.
std::string report_string(ReportFormat format, const std::vector<Report>& reports, const ReportOptions& options = {});
/// Reports as JSON (schemas/validate-report.schema.json).
inline std::string report_json(const std::vector<Report>& reports) {
  return report_string(ReportFormat::json, reports);
}

/// Elements on their way into a full report, as JSON text: in memory, or in a temporary file once they are many.
class ElementSpool {
 public:
  ElementSpool();                                    ///< empty
  ElementSpool(ElementSpool&&) noexcept;             ///< takes the elements over
  ElementSpool& operator=(ElementSpool&&) noexcept;  ///< takes the elements over
  ~ElementSpool();
  void add(std::string_view rule, const Element& element);  ///< keeps it; of one rule one at a time, of several at once

 private:
  friend class FullReportWriter;
  struct Pile;
  std::vector<Pile> piles_;  ///< of each rule of the catalogue
};

/// The JSON of ReportFormat::json with every element, from spools in place of Issue::elements.
class FullReportWriter {
 public:
  /// `write` gets pieces of any length.
  explicit FullReportWriter(std::function<void(std::string_view)> write);
  ~FullReportWriter();
  FullReportWriter(const FullReportWriter&) = delete;
  FullReportWriter& operator=(const FullReportWriter&) = delete;
  /// Writes a file's report. False where the temporary files could not hold the elements; nothing is of use then.
  [[nodiscard]] bool add(const Report& report, ElementSpool& spool);
  void finish();  ///< writes the end

 private:
  struct Document;
  std::unique_ptr<Document> document_;
};

// ---- validate and compile --------------------------------------------------------------------------------------------------

/// Vertices at equal coordinates are one (exact; -0 = 0), each is its own (none), or those within a distance are joined.
struct Weld {
  /// See above.
  enum class Kind { exact, none, distance };
  Kind kind = Kind::exact;  ///< which
  double distance = 0;      ///< source units
};

/// Which edges count as flat, beyond those that are so exactly (contact-model GRAPH-2;
/// `docs/internals/exactness.md#tiers-of-coplanarity`).
struct Coplanar {
  /// See above.
  enum class Kind { exact, quantum, angle };
  Kind kind = Kind::quantum;  ///< which
  double angle_rad = 0;       ///< where kind is angle
};

/// Of the numbers in a file.
enum class Precision { f64, f32 };

/// For max_elements: list every one.
inline constexpr std::size_t kAllElements = std::numeric_limits<std::size_t>::max();

/// Sees every finding before it is listed, and whether or not it will be: those of one rule in source order, one at a time;
/// those of several rules perhaps at once, from several threads. May set is_known: then it counts in Issue::known, and gives
/// way in the list to what is not known.
using EachElement = std::function<void(std::string_view rule, Element& element)>;

/// How a mesh is judged; the options of `fdcg validate`.
struct ValidateOptions {
  Weld weld;                                                    ///< which vertices are one
  std::set<std::string> allow;                                  ///< rules whose findings do not fail the verdict
  std::size_t max_elements = kListedElements;                   ///< listed of each rule
  Progress progress;                                            ///< may be empty
  std::map<std::string, std::optional<Severity>> severities{};  ///< in place of the catalogue's; none: the rule is not run
  std::optional<Severity> fail_on = Severity::error;            ///< from which severity on; none: nothing fails
  Precision precision = Precision::f64;  ///< of the graph to be: coordinates are rounded to it before anything is judged
  bool orient = false;                   ///< judge the mesh as compile's orient leaves it
  unsigned jobs = 0;                     ///< threads; 0: as many as there are cores. The report does not depend on it
  EachElement each_element{};            ///< may be empty
};

/// compile() refuses a mesh exactly where this report does not pass, with the same options and fail_on error.
Report validate(const PolygonSoup& soup, const ValidateOptions& options = {});

/// What one step of a repair did, and what it found and left, since it could not be repaired safely.
struct RepairAction {
  std::string name;                    ///< as on the command line: weld, drop-degenerate, ...
  std::uint64_t total = 0;             ///< done
  std::string message;                 ///< one line
  std::vector<Element> elements;       ///< the first kListedElements, in source order and the input's numbering
  std::uint64_t left = 0;              ///< found and not done
  std::string left_message;            ///< why; empty where nothing was left
  std::vector<Element> left_elements;  ///< likewise
  bool is_refused = false;             ///< simplify, solid: the step as a whole could not be taken; left_message says why
  /// Measured, source units: no point of the surface before or after the step is farther than this from the other surface. An
  /// upper bound, at most a hundredth above the largest distance, or 1e-9 of the object's size. Infinite where no surface is
  /// left.
  double distance = 0;
  double volume_change = 0;  ///< of the signed volume (RepairAccount), cubed source units
};

/// How far a repair may go.
enum class RepairLevel {
  safe,   ///< every point of the surface stays: welds, drops faces without area and copies, turns, splits, cuts
  full,   ///< also unfolds slivers, triangulates polygons that cross themselves, and drops faces that no graph can have
  solid,  ///< also closes holes and resolves intersections into the outer surface (SolidOptions' defaults)
};

/// As on the command line.
constexpr std::string_view level_name(RepairLevel level) {
  return level == RepairLevel::safe ? "safe" : level == RepairLevel::full ? "full" : "solid";
}

/// What a repair did to the surface as a whole.
struct RepairAccount {
  RepairLevel level = RepairLevel::full;         ///< as asked for
  std::map<std::string, std::uint64_t> found{};  ///< by rule: what there was before, of compile() without self-intersections
  std::vector<RepairAction> actions;  ///< one a step, also where there was nothing to do; compile(): none where nothing blocked
  double distance = 0;                ///< as RepairAction's, between the input and the result
  /// Of the tetrahedra between the middle of the input's bounds and each face, by the side that the face shows; what a closed
  /// mesh encloses.
  double volume_before = 0;
  double volume_after = 0;         ///< likewise, with the same middle
  std::uint64_t faces_before = 0;  ///< of the input
  std::uint64_t faces_after = 0;   ///< of the result
};

/// Gives memory for a file of so many bytes, starting at a multiple of 64; empty where there is none to be had. Every byte of
/// it is written, so that it need not be zeroed and one buffer can serve for many meshes.
using Allocate = std::function<std::span<std::byte>(std::size_t bytes)>;

/// 40 degrees.
inline constexpr double kDefaultCrease_rad = 0.6981317007977318;

/// Which normals the file has at the corners of its nodes, for force shading.
enum class Normals {
  none,   ///< no such section
  faces,  ///< from the faces around each vertex, up to creases; exact where a sphere passes through the vertices (Max 1999)
  file,   ///< those of the mesh file (ImportOptions::normals)
};

/// How a mesh is compiled; the options of `fdcg compile`.
struct CompileOptions {
  double metres_per_unit = 1;            ///< of the file's coordinates
  Precision precision = Precision::f64;  ///< of the file
  Coplanar coplanar;                     ///< which edges are flat
  bool merge = true;                     ///< join coplanar faces into convex nodes
  bool triangles = false;           ///< every node one triangle, as deform.h wants them; merges nothing, whatever `merge` says
  Weld weld;                        ///< which vertices are one
  bool orient = false;              ///< make the winding consistent and outward first
  bool store_planes = true;         ///< false: the step derives them, to the same bits
  Normals normals = Normals::none;  ///< for force shading. Faces that they make smooth are triangles, and not merged
  double crease_rad = kDefaultCrease_rad;  ///< Normals::faces: faces that meet at a larger angle meet at a crease
  /// The mesh for the eye too (fdcg/visual.h): with the soup's `appearance`, and its normals or, where it has none, those of
  /// the faces up to creases of `crease_rad`.
  bool visual = false;
  bool heights = false;           ///< the soup's images as heights (fdcg/heights.h): ImportOptions::heights asked for them
  double height_range_m = 0;      ///< of every image white above black; 0: as the mesh file says
  std::set<std::string> without;  ///< optional sections left out: hierarchy, source-map, info, mass, materials, normals
  /// At most one of the two; 0: not known. With either, a mesh that encloses no solid is refused; without, its file has no mass
  /// properties (Compiled::no_mass says why).
  double density_kg_per_m3 = 0;
  double mass_kg = 0;                          ///< see density_kg_per_m3
  std::set<std::string> allow;                 ///< rules whose findings do not refuse the mesh
  bool self_intersections = false;             ///< run that rule too
  std::optional<RepairLevel> repair;           ///< repair the mesh first, with `weld`; `orient` is then part of it
  std::size_t max_elements = kListedElements;  ///< listed of each rule
  unsigned jobs = 0;                           ///< threads; 0: as many as there are cores. The bytes do not depend on it
  Progress progress;                           ///< may be empty
  Allocate allocate;                           ///< where the file goes, a mapped output file say; default: Compiled::bytes
};

/// What compile() made.
struct Compiled {
  Report report;                    ///< the verdict, and what was found
  std::uint64_t flipped_faces = 0;  ///< by orient
  std::uint64_t split_faces = 0;    ///< not convex or not planar: cut into several nodes
  std::uint64_t merged_faces = 0;   ///< source faces that share their node with others
  std::uint64_t shaded_faces = 0;   ///< triangles with normals at their corners, where CompileOptions::normals asked for them
  std::uint64_t unusable_normals = 0;   ///< corners whose normal leans from their triangle's by more than 60 degrees: left out
  std::optional<RepairAccount> repair;  ///< where CompileOptions::repair asked for one
  std::string no_mass;           ///< why the file has no mass properties; empty where it has, and where they were left out
  std::vector<std::byte> bytes;  ///< the file, unless CompileOptions::allocate placed it; empty if the report does not pass
  std::span<std::byte> placed;   ///< the file, where CompileOptions::allocate placed it

  /// The file, wherever it is.
  [[nodiscard]] std::span<const std::byte> file() const { return placed.empty() ? std::span<const std::byte>(bytes) : placed; }
};

/// About how large the file will be; larger than it comes out where faces are merged.
std::size_t likely_file_bytes(const PolygonSoup& soup, const CompileOptions& options);

/// Compiled::report as report_json() has it, of the mesh as it was repaired in the input's numbering; where the mesh was
/// repaired, with the account under "repair".
std::string compile_report_json(const Compiled& compiled);

/// Compiles a mesh. Fails only where a mass was asked for of a mesh that encloses no solid (1), the options contradict one
/// another (2), the mesh outgrows the format (3), or by our own fault (4).
Result<Compiled> compile(const PolygonSoup& soup, const CompileOptions& options);

/// The same of a mesh that is not needed afterwards. Its points, corners and `face_first` are freed as soon as they have
/// served: of triangles a twelfth of the memory at the peak. What else it has stays.
Result<Compiled> compile(PolygonSoup&& soup, const CompileOptions& options);

// ---- repair ----------------------------------------------------------------------------------------------------------------

/// A length in source units, or as a share of the object's size, the diagonal of its bounds.
struct Extent {
  double value = 0;       ///< the length, or the share
  bool is_share = false;  ///< which
};

/// How a mesh becomes the boundary of a solid.
struct SolidOptions {
  /// Cut along its intersections by exact arithmetic, or rebuilt on a lattice from its winding number.
  enum class Method { exact, remesh };
  Method method = Method::exact;  ///< which
  Extent hole_size{1, true};      ///< holes whose bounds have a longer diagonal are left open
  Extent voxel{0.005, true};      ///< of the lattice, where rebuilt: what is smaller is lost
  Extent gap{1e-4, true};         ///< borders no farther apart are joined first
  bool as_floats = false;         ///< the result's coordinates are floats, as binary STL has them
};

/// What may be done to a mesh; each step is taken only where it is asked for, in this order. All but a weld by distance and
/// simplify leave the set of points that the surface covers as it is.
struct RepairOptions {
  /// Join vertices, so that the written file has them once; none: the file's own vertices are judged, at equal coordinates or
  /// not. Absent: vertices at equal coordinates are judged as one and written as they were, unless split_non_manifold_vertices
  /// is asked for, which implies exact.
  std::optional<Weld> weld;
  bool drop_degenerate_faces = false;        ///< faces without area
  bool drop_duplicate_faces = false;         ///< faces on the vertices of an earlier one
  bool split_non_manifold_vertices = false;  ///< a vertex for each fan
  bool orient = false;                       ///< each orientable patch consistent, closed ones of mixed winding outward
  bool reverse_inside_out = false;           ///< closed patches at even nesting depth that enclose negative volume
  bool cut_non_manifold = false;            ///< edges of more than two faces, folds, what makes a patch one-sided; implies weld
  bool drop_unusable_faces = false;         ///< a corner that is not finite, or that the file does not have
  bool triangulate_crossing_faces = false;  ///< polygons that cross themselves or come twice to a corner
  bool unfold = false;                      ///< folded slivers thinner than 1e-3 of the object's size
  bool drop_blocking_faces = false;         ///< what no step above could mend and no graph can have
  std::optional<SolidOptions> solid;        ///< close holes, resolve intersections, leave out what lies inside; implies weld
  std::optional<double> simplify_error;  ///< source units: no point of the result or the input farther from the other surface
  bool part_equal_points = false;  ///< move vertices that a repair put apart at equal coordinates apart by a float's rounding
  bool judges = true;              ///< fills Repaired::before and after
  unsigned jobs = 0;               ///< threads; 0: as many as there are cores
  Progress progress;               ///< may be empty
};

/// The steps of a level; weld is exact.
RepairOptions repair_options(RepairLevel level);

/// What repair() made.
struct Repaired : public RepairAccount {
  PolygonSoup soup;                         ///< the result
  std::vector<std::uint32_t> source_face;   ///< of each of its faces: that of the input it is, or is a part of
  std::vector<std::uint32_t> source_point;  ///< of each of its points: that of the input it is; of new ones: one nearby
  Report before;                            ///< validate() of the input
  Report after;                             ///< validate() of `soup`, as it is to be read
  /// How `soup` is to be read: none where vertices at equal coordinates are apart on purpose.
  Weld::Kind read_with = Weld::Kind::exact;
};

/// Repairs a mesh. Fails where no step is asked for or the options contradict the mesh (2).
Result<Repaired> repair(const PolygonSoup& soup, const RepairOptions& options);

/// The account as JSON (schemas/repair-report.schema.json); `output`: the file that was written, empty where none was.
std::string repair_json(const Repaired& repaired, const std::string& output);

// ---- export ----------------------------------------------------------------------------------------------------------------

/// How a mesh file is written.
struct ExportOptions {
  Format format = Format::off;  ///< off, obj, ply, stl
  bool is_text = false;         ///< ply, stl: ascii in place of binary little-endian
};

/// The bytes of a mesh file. Numbers read back as the same doubles: text with the shortest digits that do, PLY as float where
/// every coordinate is one and as double else. STL holds triangles only, binary STL floats only: fails (2) on what would be
/// lost.
Result<std::string> export_mesh(const PolygonSoup& soup, const ExportOptions& options);

}  // namespace fdcg::bake
