// SPDX-License-Identifier: Apache-2.0
#include "page_writer.hpp"

#include <nlohmann/json.hpp>

#include "fdcg/fdcg.h"
#include "fdcg_viewer.h"
#include "packed_array.hpp"

namespace fdcg::page {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kMissing = "missing: ";
constexpr std::string_view kDataMark = "<!--data-->";
constexpr std::string_view kTitleMark = "<!--title-->";

std::string_view viewer() {
  return {reinterpret_cast<const char*>(fdcg_viewer), static_cast<std::size_t>(fdcg_viewer_bytes)};
}

std::string escaped(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

std::string dumped(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json rules_json() {
  Json list = Json::array();
  for (const bake::Rule& rule : bake::rules())
    list.push_back({{"name", rule.name}, {"meaning", rule.meaning}, {"why", rule.why}, {"remedy", rule.remedy}});
  return list;
}

Json report_json(const bake::Report& report) {
  bake::ReportOptions options;
  options.max_elements = bake::kAllElements;
  const Json all = Json::parse(bake::report_string(bake::ReportFormat::json, {report}, options), nullptr, false);
  return all.is_object() ? all["files"][0] : Json(nullptr);
}

Json parts_json(const bake::PolygonSoup& soup) {
  constexpr std::size_t kMostParts = 20000;
  Json list = Json::array();
  for (std::size_t i = 0; i < soup.parts.size() && i < kMostParts; ++i)
    list.push_back({soup.parts[i].name, soup.parts[i].first_face});
  return list;
}

}  // namespace

std::string viewer_missing() {
  if (viewer().substr(0, kMissing.size()) != kMissing) return {};
  return std::string(viewer().substr(kMissing.size()));
}

PageWriter::PageWriter(Write write, std::string_view name) : write_(std::move(write)) {
  const std::string title = Json::parse(dumped(Json(name))).get<std::string>();  // valid UTF-8, whatever the name is
  const std::string_view page = viewer();
  const std::size_t at_title = page.find(kTitleMark);
  write_(page.substr(0, at_title));
  write_(escaped(title));
  const std::size_t rest = at_title + kTitleMark.size();
  write_(page.substr(rest, page.find(kDataMark) - rest));
  const Json about{{"version", FDCG_VERSION_STRING}, {"title", title}, {"rules", rules_json()}};
  write_("<script type=\"text/plain\" id=\"page\">" + packed_text(dumped(about)) + "</script>\n");
}

std::size_t PageWriter::add_blob(const std::string& encoded) {
  const std::size_t id = blobs_++;
  write_("<script type=\"text/plain\" id=\"blob-" + std::to_string(id) + "\">");
  write_(encoded);
  write_("</script>\n");
  return id;
}

Json PageWriter::add_array(const PackedArray& array) {
  Json about = array.about;
  about["blob"] = add_blob(array.encoded);
  return about;
}

Json PageWriter::add_geometry(const bake::PolygonSoup& soup) {
  Json geometry = mesh_frame(soup);
  for (const auto& [name, array] : mesh_arrays(soup))
    geometry[name] = add_array(array);
  return geometry;
}

Json PageWriter::add_log_text(std::string_view name, std::string_view log) {
  Json about = described(log.size(), {});
  about["name"] = name;
  about["blob"] = add_blob(packed_text(log));
  return about;
}

// Items stand after the arrays that they speak of.
void PageWriter::add_item(const Json& item) {
  write_("<script type=\"text/plain\" class=\"item\">" + packed_text(dumped(item)) + "</script>\n");
}

void PageWriter::add_mesh(const bake::PolygonSoup& soup, const MeshDetails& details) {
  Json item{{"name", soup.name}, {"report", report_json(*details.report)}};
  item["geometry"] = add_geometry(soup);
  item["parts"] = parts_json(soup);
  item["materials"] = soup.materials;
  if (details.graph.empty()) {
    item["no_graph"] = details.no_graph;
  } else {
    item["graph"] = add_array(graph_array(details.graph));
    item["compile_options"] = details.compile_options;
  }
  if (details.repaired != nullptr) {
    item["repaired"] = {{"geometry", add_geometry(details.repaired->soup)},
                        {"report", report_json(details.repaired->after)},
                        {"account", Json::parse(bake::repair_json(*details.repaired, ""), nullptr, false)}};
  }
  add_item(item);
}

void PageWriter::add_report(const bake::Report& report) {
  add_item({{"name", report.file}, {"report", report_json(report)}});
}

void PageWriter::add_graph(std::string_view name, std::span<const std::byte> file, std::string_view log_name,
                           std::string_view log) {
  Json item{{"name", name}};
  item["graph"] = add_array(graph_array(file));
  if (!log.empty()) item["log"] = add_log_text(log_name, log);
  add_item(item);
}

void PageWriter::add_log(std::string_view name, std::string_view log) {
  Json item{{"name", name}};
  item["log"] = add_log_text(name, log);
  add_item(item);
}

void PageWriter::finish() {
  write_(viewer().substr(viewer().find(kDataMark) + kDataMark.size()));
}

}  // namespace fdcg::page
