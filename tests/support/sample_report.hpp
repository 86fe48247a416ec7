// SPDX-License-Identifier: Apache-2.0
// A report with everything that one can hold, for the tests of its formats.
#pragma once

#include <string>

#include "fdcg/bake.hpp"

namespace fdcg::test {

// A path that every format has to escape, and that is no UTF-8.
inline const std::string kOddPath = "meshes/a b#\xFF<&>\"'\x01 [7].obj";

inline bake::Element sample_element(std::uint32_t i) {
  bake::Element element;
  element.faces = {i, i + 1};
  element.edges = {{i, i + 7}};
  element.vertices = {3 * i};
  element.point = bake::Vec3{0.1 * i, -1, 1e300};
  element.line = i + 10;
  element.part = "wheel \"left\"\x1b[31m";
  element.fingerprint = 0x0123456789abcdefu + i;
  return element;
}

// An error with 300 findings of which 100 are listed, 2 of them known; a warning that is allowed; a note without places.
inline bake::Report sample_report() {
  bake::Report report;
  report.file = kOddPath;
  report.vertices = 9;
  report.faces = 6;
  report.kept_faces = 5;
  report.components = 2;
  report.ignored = {{"line elements", 3}};
  report.checks = {"empty-mesh", "non-manifold-edge", "boundary-edge", "isolated-vertex"};
  report.allowed = {"boundary-edge"};
  report.config = "meshes/.fdcg-validate.json";
  report.has_baseline = true;
  report.resolved = {{"boundary-edge", 4}};
  report.seconds = 0.25;
  bake::Issue error{
      "non-manifold-edge", bake::Severity::error, 300, "300 edges have <more> than two faces. Split [them].", {}, 2};
  for (std::uint32_t i = 0; i < 100; ++i) {
    error.elements.push_back(sample_element(i));
    error.elements.back().is_known = i >= 98;
  }
  bake::Issue warning{"boundary-edge", bake::Severity::warning, 1, "1 edge has one face only. Close the hole.", {}, 0};
  warning.elements.push_back(sample_element(5));
  bake::Issue note{"isolated-vertex", bake::Severity::note, 7, "7 vertices belong to no face.", {}, 7};
  report.issues = {error, warning, note};
  return report;
}

inline bake::Report unreadable_report() {
  bake::Report report;
  report.file = "/data/gone.stl";
  report.checks = {"unreadable", "empty-mesh"};
  report.issues = {{"unreadable", bake::Severity::error, 1, "/data/gone.stl: cannot be opened", {}, 0}};
  return report;
}

}  // namespace fdcg::test
