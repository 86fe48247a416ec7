// SPDX-License-Identifier: Apache-2.0
// The 3MF Consortium's own library as a judge of 3MF files: what the build shows, with its transforms.
#include "judge_scene.hpp"

#if defined(FDCG_HAS_LIB3MF)
#include <Model/COM/NMR_DLLInterfaces.h>

#include <array>
#include <memory>

namespace fdcg::test {
namespace {

using bake::Vec3;

struct Release {
  void operator()(void* instance) const { NMR::lib3mf_release(static_cast<NMR::PLib3MFBase*>(instance)); }
};
using Owned = std::unique_ptr<void, Release>;

// Calls a function that hands out an instance; null where it fails.
template <class Function, class... Arguments>
Owned made_by(Function function, Arguments... arguments) {
  NMR::PLib3MFBase* instance = nullptr;
  if (function(arguments..., &instance) != 0) return nullptr;
  return Owned(instance);
}
NMR::PLib3MFBase* raw(const Owned& owned) {
  return static_cast<NMR::PLib3MFBase*>(owned.get());
}

// x' = x a + t, rows as the library has them: field[row][column], with column 3 the translation.
using Place = std::array<std::array<double, 4>, 3>;
constexpr Place kHere = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

Place in_double(const NMR::MODELTRANSFORM& from) {
  Place place{};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 4; ++column)
      place[row][column] = static_cast<double>(from.m_fFields[row][column]);
  }
  return place;
}

Vec3 applied(const Place& m, const Vec3& p) {
  const auto row = [&](std::size_t r) { return m[r][0] * p.x + m[r][1] * p.y + m[r][2] * p.z + m[r][3]; };
  return {row(0), row(1), row(2)};
}

Place product(const Place& a, const Place& b) {
  Place result{};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 4; ++column) {
      result[row][column] = column == 3 ? a[row][3] : 0;
      for (std::size_t k = 0; k < 3; ++k)
        result[row][column] += a[row][k] * b[k][column];
    }
  }
  return result;
}

class BuildReader {
 public:
  JudgeScene read(const std::filesystem::path& path) {
    const Owned model = made_by([](NMR::PLib3MFBase** out) { return NMR::lib3mf_createmodel(out); });
    const Owned reader = made_by([&](NMR::PLib3MFBase** out) { return NMR::lib3mf_model_queryreader(raw(model), "3mf", out); });
    if (!reader || NMR::lib3mf_reader_readfromfileutf8(raw(reader), path.string().c_str()) != 0) {
      result_.trouble = "lib3mf refuses the file";
      return std::move(result_);
    }
    constexpr std::array kMetres = {1e-6, 1e-3, 1e-2, 0.0254, 0.3048, 1.0};
    DWORD unit = 1;
    NMR::lib3mf_model_getunit(raw(model), &unit);
    result_.metres_per_unit = kMetres.at(unit);
    const Owned items = made_by([&](NMR::PLib3MFBase** out) { return NMR::lib3mf_model_getbuilditems(raw(model), out); });
    for (BOOL has_next = 0; NMR::lib3mf_builditemiterator_movenext(raw(items), &has_next) == 0 && has_next != 0;)
      add_item(raw(items));
    return std::move(result_);
  }

 private:
  void add_item(NMR::PLib3MFBase* items) {
    const Owned item = made_by([&](NMR::PLib3MFBase** out) { return NMR::lib3mf_builditemiterator_getcurrent(items, out); });
    const Owned object =
        made_by([&](NMR::PLib3MFBase** out) { return NMR::lib3mf_builditem_getobjectresource(raw(item), out); });
    NMR::MODELTRANSFORM transform{};
    BOOL has_transform = 0;
    NMR::lib3mf_builditem_hasobjecttransform(raw(item), &has_transform);
    if (has_transform != 0) NMR::lib3mf_builditem_getobjecttransform(raw(item), &transform);
    add_object(raw(object), has_transform != 0 ? in_double(transform) : kHere);
  }

  void add_object(NMR::PLib3MFBase* object, const Place& place) {
    BOOL is_mesh = 0;
    NMR::lib3mf_object_ismeshobject(object, &is_mesh);
    if (is_mesh != 0) return add_mesh(object, place);
    DWORD count = 0;
    NMR::lib3mf_componentsobject_getcomponentcount(object, &count);
    for (DWORD c = 0; c < count; ++c) {
      const Owned component =
          made_by([&](NMR::PLib3MFBase** out) { return NMR::lib3mf_componentsobject_getcomponent(object, c, out); });
      const Owned inner =
          made_by([&](NMR::PLib3MFBase** out) { return NMR::lib3mf_component_getobjectresource(raw(component), out); });
      NMR::MODELTRANSFORM transform{};
      BOOL has_transform = 0;
      NMR::lib3mf_component_hastransform(raw(component), &has_transform);
      if (has_transform != 0) NMR::lib3mf_component_gettransform(raw(component), &transform);
      add_object(raw(inner), has_transform != 0 ? product(place, in_double(transform)) : place);
    }
  }

  void add_mesh(NMR::PLib3MFBase* mesh, const Place& place) {
    DWORD triangles = 0;
    NMR::lib3mf_meshobject_gettrianglecount(mesh, &triangles);
    const bool is_mirrored = determinant(place) < 0;
    for (DWORD t = 0; t < triangles; ++t) {
      NMR::MODELMESHTRIANGLE triangle{};
      NMR::lib3mf_meshobject_gettriangle(mesh, t, &triangle);
      PlacedFace face;
      for (const DWORD corner : triangle.m_nIndices) {
        NMR::MODELMESHVERTEX vertex{};
        NMR::lib3mf_meshobject_getvertex(mesh, corner, &vertex);
        const float* const p = vertex.m_fPosition;
        face.push_back(applied(place, {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])}));
      }
      if (is_mirrored) std::swap(face[1], face[2]);
      result_.faces.push_back(std::move(face));
    }
  }

  static double determinant(const Place& m) {
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  }

  JudgeScene result_;
};

}  // namespace

JudgeScene read_with_lib3mf(const std::filesystem::path& path) {
  return BuildReader().read(path);
}

}  // namespace fdcg::test
#else
namespace fdcg::test {

JudgeScene read_with_lib3mf(const std::filesystem::path& /*path*/) {
  return {{}, 0, kNoJudge};
}

}  // namespace fdcg::test
#endif
