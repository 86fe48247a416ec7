// SPDX-License-Identifier: Apache-2.0
#include "view_mesh.hpp"

#include <algorithm>
#include <cctype>
#include <numbers>

#include "../common/terminal.hpp"
#include "fdcg/robot.hpp"
#include "fdcg_commands.hpp"
#include "mesh_input.hpp"

namespace fdcg::tools {
namespace {

constexpr std::size_t kMostTouchFaces = 1'000'000;  // beyond, the graph alone would make the page larger than browsers like

// As a shell takes it.
std::string as_shell_word(const std::string& text) {
  const auto is_plain = [](unsigned char c) { return std::isalnum(c) != 0 || c == '.' || c == '/' || c == '_' || c == '-'; };
  if (std::all_of(text.begin(), text.end(), is_plain)) return text;
  std::string word = "'";
  for (const char c : text)
    word += c == '\'' ? "'\\''" : std::string(1, c);
  return word + "'";
}

std::string options_text(const MeshView& view) {
  std::string text = view.precision == bake::Precision::f32 ? "--precision f32 --planes derived" : "--planes derived";
  if (view.metres_per_unit != 1) text += " --scale " + short_number(view.metres_per_unit);
  if (view.weld.kind == bake::Weld::Kind::none) text += " --weld none";
  if (view.weld.kind == bake::Weld::Kind::distance) text += " --weld " + short_number(view.weld.distance);
  if (view.felt.normals == bake::Normals::file) text += " --normals file";
  if (view.felt.normals == bake::Normals::faces)
    text += " --normals faces --crease " + short_number(view.felt.crease_rad * 180 / std::numbers::pi);
  if (!view.heights.empty()) text += " --heights " + as_shell_word(view.heights);
  if (view.felt.height_range_m != 0) text += " --height-range " + short_number(view.felt.height_range_m);
  return text;
}

// Planes are derived in the step: to the same bits, from a file a third smaller.
bake::CompileOptions compile_options(const MeshView& view, const bake::Progress& progress) {
  bake::CompileOptions options = view.felt;
  options.heights = !view.heights.empty();
  options.metres_per_unit = view.metres_per_unit;
  options.precision = view.precision;
  options.weld = view.weld;
  options.store_planes = false;
  options.jobs = view.jobs;
  options.progress = progress;
  return options;
}

bake::ImportOptions import_options(const MeshView& view, const bake::Progress& progress) {
  bake::ImportOptions options{view.input_format, progress};
  options.normals = view.felt.normals == bake::Normals::file;
  options.appearance = !view.heights.empty();
  options.heights = view.heights;
  return options;
}

bake::RepairOptions all_repairs(const MeshView& view, const bake::Progress& progress) {
  bake::RepairOptions options;
  options.weld = view.weld;
  options.drop_degenerate_faces = options.drop_duplicate_faces = true;
  options.split_non_manifold_vertices = options.orient = options.reverse_inside_out = true;
  options.jobs = view.jobs;
  options.progress = progress;
  return options;
}

// The graph's bytes in *compiled, or why there are none.
std::string compile_for_touch(const MeshView& view, const bake::PolygonSoup& soup, const bake::Report& report,
                              const bake::Progress& progress, std::optional<bake::Compiled>* compiled) {
  if (!view.touch) return "the page was made without a graph (fdcg view adds one)";
  if (!report.passes(bake::Severity::error)) return "the mesh has errors, so it cannot be compiled; repair them first";
  if (soup.face_count() > kMostTouchFaces) {
    return "it has more than " + grouped(kMostTouchFaces) + " faces; compile it and view the FDCG file to touch it";
  }
  auto made = bake::compile(soup, compile_options(view, progress));
  if (!made) return made.error().message;
  if (made->file().empty()) return "the mesh has errors at the precision of the graph; --precision f64 may do";
  *compiled = std::move(*made);
  return {};
}

}  // namespace

void add_judged_mesh(const MeshView& asked, const bake::PolygonSoup& soup, const bake::Report& report, page::PageWriter& page) {
  MeshView view = asked;
  if (!view.has_unit && soup.metres_per_unit > 0) view.metres_per_unit = soup.metres_per_unit;
  ProgressBar bar(view.shows_progress);
  const bake::Progress progress = [&bar](std::string_view stage, double fraction) { bar.update(stage, fraction); };
  page::MeshDetails details;
  details.report = &report;
  std::optional<bake::Compiled> compiled;
  details.no_graph = compile_for_touch(view, soup, report, progress, &compiled);
  if (compiled) {
    details.graph = compiled->file();
    details.compile_options = options_text(view);
  }
  std::optional<bake::Repaired> repaired;
  if (view.repair && !report.passes(bake::Severity::error)) {
    auto done = bake::repair(soup, all_repairs(view, progress));
    if (done) repaired = std::move(*done);
  }
  if (repaired) details.repaired = &*repaired;
  page.add_mesh(soup, details);
}

std::string add_mesh_view(const MeshView& view, const ListedMesh& mesh, page::PageWriter& page) {
  ProgressBar bar(view.shows_progress);
  const bake::Progress progress = [&bar](std::string_view stage, double fraction) { bar.update(stage, fraction); };
  auto soup = mesh.problem.empty()
                  ? import_input(mesh.path, import_options(view, progress))
                  : bake::Result<bake::PolygonSoup>(bake::Failure{kFile, mesh.path + ": " + mesh.problem, "unreadable"});
  if (!soup) {
    bar.wipe();
    bake::Report report;
    report.file = mesh.path;
    bake::Issue issue;
    issue.rule = soup.error().rule.empty() ? "unreadable" : soup.error().rule;
    issue.total = 1;
    issue.message = soup.error().message;
    report.issues.push_back(issue);
    page.add_report(report);
    return soup.error().message;
  }
  bake::scale_soup(*soup, mesh.scale);
  bake::ValidateOptions options;
  options.weld = view.weld;
  options.max_elements = kPageElements;
  options.jobs = view.jobs;
  options.progress = progress;
  const bake::Report report = bake::validate(*soup, options);
  bar.wipe();
  add_judged_mesh(view, *soup, report, page);
  return {};
}

}  // namespace fdcg::tools
