// SPDX-License-Identifier: Apache-2.0
#include "report/phrases.hpp"

#include <algorithm>
#include <iterator>
#include <string_view>

namespace fdcg::bake {
namespace {

// The phrase for findings of a rule, in singular and plural.
struct Phrase {
  std::string_view rule, one, many;
};
constexpr Phrase kPhrases[] = {
    {"non-finite-coordinate", "vertex has a coordinate that is NaN, infinite or out of range",
     "vertices have a coordinate that is NaN, infinite or out of range"},
    {"index-out-of-range", "face names a vertex that the file does not have",
     "faces name a vertex that the file does not have"},
    {"empty-mesh", "file has no face", "files have no face"},
    {"self-crossing-face", "polygon has an outline that crosses or touches itself",
     "polygons have an outline that crosses or touches itself"},
    {"duplicate-face", "face repeats the vertices of an earlier one", "faces repeat the vertices of an earlier one"},
    {"non-manifold-edge", "edge has more than two faces", "edges have more than two faces"},
    {"non-manifold-vertex", "vertex joins more than one fan of faces", "vertices join more than one fan of faces"},
    {"winding-inconsistent", "edge has two faces that run along it the same way",
     "edges have two faces that run along them the same way"},
    {"not-orientable", "patch of faces has no consistent winding", "patches of faces have no consistent winding"},
    {"inside-out", "closed patch looks inwards", "closed patches look inwards"},
    {"folded-edge", "edge has two faces that lie on one another", "edges have two faces that lie on one another"},
    {"boundary-edge", "edge has one face only", "edges have one face only"},
    {"self-intersection", "pair of faces meets", "pairs of faces meet"},
    {"non-planar-face", "polygon is not flat", "polygons are not flat"},
    {"t-junction", "vertex lies inside a boundary edge of another face", "vertices lie inside a boundary edge of another face"},
    {"sliver-face", "face is thinner than a thousandth of its length", "faces are thinner than a thousandth of their length"},
    {"isolated-vertex", "vertex belongs to no face", "vertices belong to no face"},
    {"duplicate-vertex", "vertex was joined to an earlier one", "vertices were joined to an earlier one"},
};

}  // namespace

std::string finding_message(const Rule& rule, std::uint64_t total) {
  const Phrase& phrase =
      *std::find_if(std::begin(kPhrases), std::end(kPhrases), [&](const Phrase& p) { return p.rule == rule.name; });
  return std::to_string(total) + " " + std::string(total == 1 ? phrase.one : phrase.many) + ". " + std::string(rule.remedy);
}

}  // namespace fdcg::bake
