// SPDX-License-Identifier: Apache-2.0
// fdcg inspect: what a file holds. Every file is verified in full before anything is said about it.
#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "../common/atomic_file.hpp"
#include "../common/options.hpp"
#include "../common/terminal.hpp"
#include "dump.hpp"
#include "fdcg/fdcg.h"
#include "fdcg/heights.h"
#include "fdcg/visual.h"
#include "fdcg_commands.hpp"
#include "invariants.hpp"
#include "open_graph.hpp"

namespace fdcg::tools {
namespace {

using Json = nlohmann::ordered_json;

struct InspectArguments {
  std::string file;
  bool json = false;
  bool dump = false;
  bool verify = false;
};

std::string section_name(std::uint32_t id) {
  constexpr const char* kNames[] = {"nodes",
                                    "node-offsets",
                                    "edges",
                                    "connections",
                                    "corners",
                                    "fans",
                                    "hierarchy",
                                    "source-map",
                                    "info",
                                    "fan-boxes",
                                    "busy-corners",
                                    "mass",
                                    "materials",
                                    "names",
                                    "fan-runs",
                                    "normals",
                                    "visual-vertices",
                                    "visual-indices",
                                    "visual-nodes",
                                    "visual-materials",
                                    "places",
                                    "height-maps",
                                    "height-texels"};
  if (id >= 1 && id <= std::size(kNames)) return kNames[id - 1];
  return "unknown-" + std::to_string(id);
}

Json sections_of(const fdcg_header& header) {
  const auto* const table = reinterpret_cast<const fdcg_section*>(&header + 1);
  Json sections = Json::array();
  for (std::uint32_t i = 0; i < header.section_count; ++i) {
    sections.push_back({{"name", section_name(table[i].id)},
                        {"offset", table[i].offset},
                        {"bytes", table[i].record_bytes * table[i].record_count}});
  }
  return sections;
}

Json verification_of(const std::vector<Invariant>& invariants) {
  Json checks = Json::array();
  bool passed = true;
  for (const Invariant& invariant : invariants) {
    passed = passed && invariant.violations == 0;
    checks.push_back({{"name", invariant.name},
                      {"checked", invariant.checked},
                      {"violations", invariant.violations},
                      {"worst", invariant.worst},
                      {"limit", invariant.limit}});
  }
  return {{"passed", passed}, {"checks", checks}};
}

// The object's frame, metres.
Json bound(const fdcg_header& header, const double (&local)[3]) {
  Json point = Json::array();
  for (int axis = 0; axis < 3; ++axis)
    point.push_back((local[axis] + header.origin[axis]) * header.metres_per_unit);
  return point;
}

// null where the file has none. Without a density the inertia is that of density 1.
Json mass_of(const fdcg_graph& graph) {
  fdcg_mass mass{};
  if (fdcg_get_mass(&graph, &mass, nullptr) != FDCG_OK) return nullptr;
  const bool is_known = mass.mass_kg != 0;
  const auto tensor = [&mass](double factor) {
    const double* const i = mass.inertia_per_density_m5;
    return Json{{"xx", i[0] * factor}, {"yy", i[1] * factor}, {"zz", i[2] * factor},
                {"xy", i[3] * factor}, {"xz", i[4] * factor}, {"yz", i[5] * factor}};
  };
  return {{"volume_m3", mass.volume_m3},
          {"centroid_m", mass.centroid_m},
          {"inertia_per_density_m5", tensor(1)},
          {"density_kg_per_m3", is_known ? Json(mass.density_kg_per_m3) : Json(nullptr)},
          {"mass_kg", is_known ? Json(mass.mass_kg) : Json(nullptr)},
          {"inertia_kg_m2", is_known ? tensor(mass.density_kg_per_m3) : Json(nullptr)}};
}

// By name, with the number of nodes; null where the file has none.
Json materials_of(const fdcg_graph& graph) {
  if (graph.node_materials == nullptr) return nullptr;
  std::vector<std::uint32_t> nodes(graph.material_count + 1, 0);
  for (std::uint32_t n = 0; n < graph.header->node_count; ++n)
    ++nodes[std::min(fdcg_get_node_material(&graph, n), graph.material_count)];
  Json list = Json::array();
  for (std::uint32_t i = 0; i < graph.material_count; ++i)
    list.push_back({{"name", fdcg_get_material_name(&graph, i)}, {"nodes", nodes[i]}});
  return {{"list", list}, {"nodes_without", nodes.back()}};
}

// null where the file has none.
Json visual_of(const fdcg_graph& graph) {
  fdcg_visual visual{};
  if (fdcg_get_visual(&graph, &visual, nullptr) != FDCG_OK) return nullptr;
  Json materials = Json::array();
  for (std::uint32_t m = 0; m < visual.material_count; ++m) {
    const fdcg_visual_material& material = visual.materials[m];
    materials.push_back({{"name", material.name},
                         {"triangles", material.index_count / 3},
                         {"base_colour", material.base_colour},
                         {"texture_coordinates", (material.flags & FDCG_VISUAL_UV) != 0},
                         {"colours", (material.flags & FDCG_VISUAL_COLOURS) != 0}});
  }
  return {{"vertices", visual.vertex_count}, {"triangles", visual.index_count / 3}, {"materials", materials}};
}

// null where the file has none.
Json heights_of(const fdcg_graph& graph) {
  fdcg_heights heights{};
  if (fdcg_get_heights(&graph, &heights, nullptr) != FDCG_OK) return nullptr;
  std::vector<std::uint32_t> nodes(heights.map_count, 0);
  for (std::uint32_t n = 0; n < heights.node_count; ++n)
    if (heights.places[n].map < heights.map_count) ++nodes[heights.places[n].map];
  Json maps = Json::array();
  for (std::uint32_t m = 0; m < heights.map_count; ++m) {
    const fdcg_height_map& map = heights.maps[m];
    maps.push_back({{"width", map.width}, {"height", map.height}, {"levels", map.level_count}, {"nodes", nodes[m]}});
  }
  return {{"most_m", heights.most_m}, {"curvature_per_m", heights.curvature_per_m}, {"maps", maps}};
}

Json description_of(const fdcg_graph& graph) {
  const fdcg_header& header = *graph.header;
  const std::uint32_t* const types = header.connection_type_count;
  Json info = graph.info == nullptr ? Json::object() : Json::parse(graph.info, graph.info + graph.info_bytes, nullptr, false);
  if (!info.is_object()) info = Json::object();
  const auto from_info = [&info](const char* key) { return info.contains(key) ? info[key] : Json(nullptr); };
  Json source = from_info("source");
  if (!source.is_object()) source = Json::object();
  return {{"format_version", header.format_version},
          {"precision", header.real_bytes == 8 ? "f64" : "f32"},
          {"nodes", header.node_count},
          {"connections", header.connection_count},
          {"corners", header.corner_count},
          {"connection_types",
           {{"convex", types[FDCG_CONVEX]},
            {"concave", types[FDCG_CONCAVE]},
            {"coplanar", types[FDCG_COPLANAR]},
            {"boundary", types[FDCG_BOUNDARY]}}},
          {"bounds", {{"min", bound(header, header.bounds_min)}, {"max", bound(header, header.bounds_max)}}},
          {"metres_per_unit", header.metres_per_unit},
          {"max_deviation_m", header.max_deviation * header.metres_per_unit},
          {"mass", mass_of(graph)},
          {"no_mass", from_info("no_mass")},
          {"repair", from_info("repair")},
          {"physics", from_info("physics")},
          {"materials", materials_of(graph)},
          {"visual", visual_of(graph)},
          {"heights", heights_of(graph)},
          {"sections", sections_of(header)},
          {"source",
           {{"file_sha256", source.contains("file_sha256") ? source["file_sha256"] : Json(nullptr)},
            {"vertices", header.source_vertex_count},
            {"faces", header.source_face_count}}},
          {"options", from_info("options")},
          {"verdict", from_info("verdict")}};
}

std::string as_words(const Json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

std::string materials_text(const Json& materials) {
  std::string text = "  materials    ";
  for (const Json& material : materials["list"])
    text += as_words(material["name"]) + " (" + material["nodes"].dump() + " nodes), ";
  return text + "none (" + materials["nodes_without"].dump() + ")\n";
}

std::string visual_text(const Json& visual) {
  std::string text = "  visual       " + grouped(visual["vertices"].get<std::uint64_t>()) + " vertices, " +
                     grouped(visual["triangles"].get<std::uint64_t>()) + " triangles: ";
  for (const Json& material : visual["materials"]) {
    text += text.ends_with(": ") ? "" : ", ";
    text += (material["name"] == "" ? "no material" : as_words(material["name"])) + " (" + material["triangles"].dump() +
            (material["texture_coordinates"] == true ? ", texture coordinates" : "") +
            (material["colours"] == true ? ", colours" : "") + ")";
  }
  return text + "\n";
}

std::string heights_text(const Json& heights) {
  std::string text = "  heights      up to " + heights["most_m"].dump() + " m:";
  for (const Json& map : heights["maps"])
    text += (text.ends_with(":") ? " " : ", ") + map["width"].dump() + " x " + map["height"].dump() + " texels in " +
            map["levels"].dump() + " levels (" + map["nodes"].dump() + " nodes)";
  return text + "\n";
}

// What the mesh file states, which the program that steps is to follow: a line each.
std::string physics_text(const Json& physics) {
  std::string text;
  const auto add = [&text](const std::string& line) {
    text += (text.empty() ? "  physics      " : "               ") + line + "\n";
  };
  const auto rule = [](const Json& combine) {
    return combine.is_null() ? std::string() : " (combined: " + as_words(combine) + ")";
  };
  for (const Json& m : physics.value("materials", Json::array())) {
    add("material " + m["name"].dump() + ": friction " + m["static_friction"].dump() + " static, " +
        m["dynamic_friction"].dump() + " dynamic" + rule(m["friction_combine"]) + ", restitution " + m["restitution"].dump() +
        rule(m["restitution_combine"]));
  }
  for (const Json& m : physics.value("haptic_materials", Json::array())) {
    const auto share = [&m](const char* what) {
      const Json& of = m[what];
      return std::string(what) + (of.is_null() ? " not stated"
                                               : " " + short_number(of["mean"]) + " of full scale (" +
                                                     short_number(of["least"]) + " to " + short_number(of["most"]) + ")");
    };
    add("haptic material " + m["name"].dump() + ": " + share("stiffness") + ", " + share("friction"));
  }
  for (const Json& b : physics.value("bodies", Json::array())) {
    add("body " + b["node"].dump() + ": " + (b["mass_kg"].is_null() ? "mass not stated" : b["mass_kg"].dump() + " kg") +
        (b["kinematic"] == true ? ", moved by others" : ""));
  }
  for (const Json& s : physics.value("shapes", Json::array())) {
    add("shape " + s["node"].dump() +
        (s.contains("problem") ? " " + as_words(s["problem"])
                               : ": " + s["surface"].dump() + (s["in_mesh"] == true ? ", faces of the mesh" : "")));
  }
  return text;
}

std::string mass_text(const Json& about) {
  const Json& mass = about["mass"];
  if (mass.is_null())
    return "  mass         " + (about["no_mass"].is_null() ? "not in the file" : "none: " + as_words(about["no_mass"])) + "\n";
  const bool is_known = !mass["mass_kg"].is_null();
  const Json& inertia = mass[is_known ? "inertia_kg_m2" : "inertia_per_density_m5"];
  return "  volume       " + mass["volume_m3"].dump() + " m^3 about " + mass["centroid_m"].dump() + " m\n  mass         " +
         (is_known ? mass["mass_kg"].dump() + " kg, " + mass["density_kg_per_m3"].dump() + " kg/m^3\n"
                   : std::string("not known: compiled without --density or --mass\n")) +
         "  inertia      " + inertia.dump() + (is_known ? " kg m^2\n" : " m^5 times the density\n");
}

std::string description_text(const std::string& file, const Json& about) {
  const auto count = [](const Json& number) { return grouped(number.get<std::uint64_t>()); };
  const Json& types = about["connection_types"];
  std::string text = file + ": FDCG version " + about["format_version"].dump() + ", " + as_words(about["precision"]) + "\n";
  text += "  nodes        " + count(about["nodes"]) + "\n";
  text += "  connections  " + count(about["connections"]) + " (" + count(types["convex"]) + " convex, " +
          count(types["concave"]) + " concave, " + count(types["coplanar"]) + " coplanar, " + count(types["boundary"]) +
          " boundary)\n";
  text += "  corners      " + count(about["corners"]) + "\n";
  text += "  bounds       " + about["bounds"]["min"].dump() + " to " + about["bounds"]["max"].dump() + " m\n";
  text += "  unit         " + about["metres_per_unit"].dump() + " m\n";
  text += "  deviation    " + about["max_deviation_m"].dump() + " m at most between a corner and its node's plane\n";
  text += mass_text(about);
  if (!about["materials"].is_null()) text += materials_text(about["materials"]);
  if (!about["visual"].is_null()) text += visual_text(about["visual"]);
  if (!about["heights"].is_null()) text += heights_text(about["heights"]);
  if (about["physics"].is_object()) text += physics_text(about["physics"]);
  const Json& source = about["source"];
  text += "  source       " + count(source["vertices"]) + " vertices, " + count(source["faces"]) + " faces, SHA-256 " +
          (source["file_sha256"].is_null() ? "not recorded" : as_words(source["file_sha256"])) + "\n";
  text += "  options      " + (about["options"].is_null() ? "not recorded" : about["options"].dump()) + "\n";
  text += "  verdict      " + (about["verdict"].is_null() ? "not recorded" : as_words(about["verdict"])) + "\n";
  text += "  sections\n";
  for (const Json& section : about["sections"]) {
    std::string name = as_words(section["name"]);
    name.resize(std::max<std::size_t>(name.size(), 12), ' ');
    text += "    " + name + " at " + section["offset"].dump() + ", " + count(section["bytes"]) + " bytes\n";
  }
  return text;
}

std::string verification_text(const fdcg_graph& graph, const std::vector<Invariant>& invariants) {
  std::string text = "  verified\n    ok    header, section table and " + std::to_string(graph.header->section_count) +
                     " sections: bounds, checksums, zero padding\n    ok    every index, loop, fan, box and number in range\n";
  for (const Invariant& invariant : invariants) {
    text += invariant.violations == 0 ? "    ok    " : "    FAIL  ";
    text += invariant.name + ": " + grouped(invariant.checked) + " checked, worst " + short_number(invariant.worst, 3) +
            ", limit " + short_number(invariant.limit, 3);
    if (invariant.violations != 0) {
      text += ", " + grouped(invariant.violations) + " violations, the first at record " + std::to_string(invariant.first);
    }
    text += "\n";
  }
  return text;
}

int run_inspect(const InspectArguments& arguments) {
  OpenGraph opened;
  fdcg_error error{};
  ProgressBar bar(true);
  const bake::Progress progress = [&bar](std::string_view stage, double done) { bar.update(stage, done); };
  if (opened.open(arguments.file, progress, error) != FDCG_OK) {
    bar.wipe();
    return fail(kFile, arguments.file == "-" ? std::string("standard input: ") + error.message : error.message);
  }
  const fdcg_graph& graph = opened.graph();
  fdcg_visual visual{};
  if (const fdcg_status status = fdcg_get_visual(&graph, &visual, &error); status != FDCG_OK && status != FDCG_E_ABSENT) {
    bar.wipe();
    return fail(kFile, arguments.file + ": " + error.message);
  }
  fdcg_heights heights{};
  if (const fdcg_status status = fdcg_get_heights(&graph, &heights, &error); status != FDCG_OK && status != FDCG_E_ABSENT) {
    bar.wipe();
    return fail(kFile, arguments.file + ": " + error.message);
  }
  const std::vector<Invariant> invariants = arguments.verify ? check_invariants(graph, progress) : std::vector<Invariant>{};
  bar.wipe();
  Json about = description_of(graph);
  AtomicFile out("-");
  if (arguments.json) {
    if (arguments.verify) about["verification"] = verification_of(invariants);
    out.write(about.dump(2) + "\n");
  } else {
    out.write(description_text(arguments.file, about));
    if (arguments.verify) out.write(verification_text(graph, invariants));
    if (arguments.dump) dump_records(graph, out);
  }
  const bool is_sound =
      std::all_of(invariants.begin(), invariants.end(), [](const Invariant& invariant) { return invariant.violations == 0; });
  return commit_all({&out}, is_sound ? kClean : kFindings);
}

}  // namespace

Command add_inspect(CLI::App& app) {
  CLI::App* const command = app.add_subcommand("inspect", "Show what an FDCG file holds.");
  command->footer(R"(Examples:
  fdcg inspect bunny.fdcg
  fdcg inspect --json bunny.fdcg
  fdcg inspect --verify bunny.fdcg
  fdcg inspect --dump cube.fdcg | less

A damaged file is refused. --verify also measures the geometry and compares it with the records.

)" + exit_codes("the file is sound", "--verify: the geometry and the records disagree"));
  const auto arguments = std::make_shared<InspectArguments>();
  required_argument(*command, "file", "FILE", arguments->file, "FDCG file. - is standard input.");
  const OptionGroup output(*command, "Output");
  CLI::Option* const json = output.flag("--json", arguments->json, "Print JSON (schemas/inspect.schema.json).");
  output.flag("--dump", arguments->dump, "Print every node, side, connection and corner, one on each line.")->excludes(json);
  output.flag("--verify", arguments->verify, "Report what was verified, and measure the geometry.");
  return {command, [arguments] { return run_inspect(*arguments); }};
}

}  // namespace fdcg::tools
