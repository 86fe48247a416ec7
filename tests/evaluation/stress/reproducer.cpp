// SPDX-License-Identifier: Apache-2.0
#include "reproducer.hpp"

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "meshes.hpp"
#include "stress_run.hpp"

namespace fdcg::test {
namespace {

std::string exact(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}
std::string hexadecimal(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%a", x);
  return text;
}
double number(const std::string& text) {
  return std::strtod(text.c_str(), nullptr);
}

// "# key value": one line of a comment.
void read_remark(std::istringstream& line, Reproducer& r) {
  std::string key, value;
  line >> key;
  std::getline(line >> std::ws, value);
  if (key == "fault") r.fault = fault_named(value).value_or(Fault::count);
  if (key == "command") r.command = value;
  if (key == "body") r.body.description = value;
  if (key == "precision") r.body.options.precision = value == "f32" ? bake::Precision::f32 : bake::Precision::f64;
  if (key == "flat")
    r.body.options.coplanar.kind = value == "quantum" ? bake::Coplanar::Kind::quantum : bake::Coplanar::Kind::exact;
  if (key == "merge") r.body.options.merge = value == "1";
  if (key == "planes") r.body.options.store_planes = value == "stored";
  if (key == "closed") r.body.is_closed = value == "1";
  if (key == "sheets_meet") r.body.sheets_meet = value == "1";
  if (key == "quantum") r.body.soup.relative_quantum = number(value);
  if (key == "absolute_quantum") r.body.soup.absolute_quantum = number(value);
  if (key == "metres_per_unit") r.body.options.metres_per_unit = number(value);
  if (key == "mu_static") r.params.mu_static = number(value);
  if (key == "mu_dynamic") r.params.mu_dynamic = number(value);
  if (key == "edge_friction") r.params.edge_friction = static_cast<std::uint32_t>(number(value));
  if (key != "hip_m") return;
  std::istringstream cells(value);
  Hip hip;
  std::string cell;
  for (double& x : hip) {
    if (!std::getline(cells, cell, ',')) throw std::runtime_error("a HIP needs three numbers: " + value);
    x = number(cell);
  }
  r.path_m.push_back(hip);
}

std::string described(const fdcg_contact& c, const fdcg_result& out, std::uint32_t faults) {
  static const char* const kStates[] = {"free", "face", "edge", "vertex"};
  std::ostringstream text;
  text.precision(17);
  text << kStates[c.state] << ' ' << static_cast<std::int32_t>(c.feature) << (out.slipping ? " slips" : " sticks")
       << ", transitions " << out.transitions << ", flags " << out.flags << ", HIP " << c.hip[0] << ' ' << c.hip[1] << ' '
       << c.hip[2] << ", GO " << c.god_object[0] << ' ' << c.god_object[1] << ' ' << c.god_object[2] << " (local)";
  for (std::size_t i = 0; i < kFaults; ++i) {
    if ((faults >> i & 1) != 0) text << "; " << name_of(static_cast<Fault>(i));
  }
  return text.str();
}

}  // namespace

void write_reproducer(const std::string& path, const Reproducer& r) {
  std::ofstream file(path);
  const bake::CompileOptions& o = r.body.options;
  file << "# fdcg_stress --minimise THIS_FILE makes it small; fdcg_stress --replay THIS_FILE steps it\n"
       << "# fault " << name_of(r.fault) << "\n# command " << r.command << "\n# body " << r.body.description << "\n# precision "
       << (o.precision == bake::Precision::f32 ? "f32" : "f64") << "\n# flat "
       << (o.coplanar.kind == bake::Coplanar::Kind::quantum ? "quantum" : "exact") << "\n# merge " << o.merge << "\n# planes "
       << (o.store_planes ? "stored" : "derived") << "\n# closed " << r.body.is_closed << "\n# sheets_meet "
       << r.body.sheets_meet << "\n# quantum " << exact(r.body.soup.relative_quantum) << "\n# absolute_quantum "
       << exact(r.body.soup.absolute_quantum) << "\n# metres_per_unit " << exact(o.metres_per_unit) << "\n# mu_static "
       << exact(r.params.mu_static) << "\n# mu_dynamic " << exact(r.params.mu_dynamic) << "\n# edge_friction "
       << r.params.edge_friction << '\n';
  for (const bake::Vec3& p : r.body.soup.points)
    file << "v " << exact(p.x) << ' ' << exact(p.y) << ' ' << exact(p.z) << '\n';
  for (std::size_t f = 0; f < r.body.soup.face_count(); ++f) {
    file << 'f';
    for (const std::uint32_t v : face_corners(r.body.soup, f))
      file << ' ' << v + 1;
    file << '\n';
  }
  for (const Hip& h : r.path_m)
    file << "# hip_m " << hexadecimal(h[0]) << ',' << hexadecimal(h[1]) << ',' << hexadecimal(h[2]) << '\n';
  file.flush();
  if (!file) throw std::runtime_error(path + ": cannot be written; is the disk full, the folder there and yours?");
}

Reproducer read_reproducer(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error(path + ": cannot be read; is it there, and yours?");
  Reproducer r;
  r.params = fdcg_make_params();
  std::vector<bake::Vec3> points;
  std::vector<Polygon> faces;
  std::string text, word;
  while (std::getline(file, text)) {
    std::istringstream line(text);
    if (!(line >> word)) continue;
    if (word == "v") {
      std::string x, y, z;
      line >> x >> y >> z;
      points.push_back({number(x), number(y), number(z)});
    } else if (word == "f") {
      Polygon face;
      for (std::uint32_t v = 0; line >> v;)
        face.push_back(v - 1);
      faces.push_back(face);
    } else if (word == "#") {
      read_remark(line, r);
    }
  }
  if (faces.empty() || r.path_m.empty() || r.fault == Fault::count) {
    throw std::runtime_error(path + ": no reproducer; it needs faces, lines `# hip_m x,y,z` and a line `# fault NAME`");
  }
  const double quantum = r.body.soup.relative_quantum, absolute_quantum = r.body.soup.absolute_quantum;
  r.body.soup = make_soup("reproducer", std::move(points), faces);
  if (quantum > 0) r.body.soup.relative_quantum = quantum;
  r.body.soup.absolute_quantum = absolute_quantum;
  r.body.options.jobs = 1;
  r.body.options.without = {"source-map", "info"};
  return r;
}

std::int64_t first_fault(const Specimen& specimen, const Reproducer& r, std::vector<std::string>* log) {
  Judge judge(specimen, r.fault == Fault::no_force);
  if (r.fault == Fault::uncertified) judge.certify_all();
  judge.begin(r.params);
  Verdicts verdicts;
  fdcg_contact contact{};
  for (std::size_t i = 0; i < r.path_m.size(); ++i) {
    const fdcg_contact before = contact;
    fdcg_result out;
    fdcg_step(&specimen.graph(), &r.params, &contact, r.path_m[i].data(), &out);
    const std::uint32_t found = judge.judge(before, r.path_m[i], contact, out, verdicts);
    if (log != nullptr) log->push_back(described(contact, out, found));
    if ((found >> static_cast<unsigned>(r.fault) & 1) != 0) return static_cast<std::int64_t>(i);
  }
  return -1;
}

}  // namespace fdcg::test
