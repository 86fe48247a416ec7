// SPDX-License-Identifier: Apache-2.0
// Polygon soup -> the bytes of a mesh file.
#include "export/export.hpp"

#include <new>
#include <stdexcept>

namespace fdcg::bake {
namespace {

Result<std::string> export_as(const PolygonSoup& soup, const ExportOptions& options) {
  std::string bytes;
  switch (options.format) {
    case Format::off:
      write_off(soup, bytes);
      return bytes;
    case Format::obj:
      write_obj(soup, bytes);
      return bytes;
    case Format::ply:
      write_ply(soup, options.is_text, bytes);
      return bytes;
    case Format::stl:
      if (const std::string loss = stl_refusal(soup, options.is_text); !loss.empty())
        return Failure{2, soup.name + ": " + loss, {}};
      write_stl(soup, options.is_text, bytes);
      return bytes;
    case Format::gltf:
    case Format::drc:
    case Format::dae:
    case Format::threemf:
    case Format::vtk:
    case Format::x3d:
      break;
  }
  return Failure{2, soup.name + ": this format is read, not written; choose OFF, OBJ, PLY or STL", {}};
}

}  // namespace

Result<std::string> export_mesh(const PolygonSoup& soup, const ExportOptions& options) {
  try {
    return export_as(soup, options);
  } catch (const std::bad_alloc&) {
  } catch (const std::length_error&) {
  }
  return Failure{3, soup.name + ": writing it needs more memory than there is", {}};
}

}  // namespace fdcg::bake
