// SPDX-License-Identifier: Apache-2.0
#include "way_file.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>

namespace fdcg::test {
namespace {

constexpr const char* kFirstLine = "fdcg-way 1";
constexpr const char* kColumns =
    "hip_x_m hip_y_m hip_z_m state god_object_x_m god_object_y_m god_object_z_m force_x_n force_y_n force_z_n others";

std::string exact(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%a", value);
  return text;
}

void put(std::ofstream& file, const Ground::Point& point) {
  for (const double value : point)
    file << ' ' << exact(value);
}

void close_or_throw(std::ofstream& file, const std::filesystem::path& path) {
  file.close();
  if (!file) throw std::runtime_error(path.string() + ": cannot be written; is the disk full, the folder there and yours?");
}

const char* state_name(std::uint32_t state) {
  constexpr const char* kNames[] = {"free", "face", "edge", "vertex"};
  static_assert(FDCG_FREE == 0 && FDCG_FACE == 1 && FDCG_EDGE == 2 && FDCG_VERTEX == 3);
  return kNames[state];
}

void write_mesh(const std::filesystem::path& path, const bake::PolygonSoup& soup) {
  if (std::filesystem::exists(path)) return;
  std::ofstream file(path);
  file << "OFF\n" << soup.points.size() << ' ' << soup.face_count() << " 0\n";
  file.precision(17);
  for (const bake::Vec3& p : soup.points)
    file << p.x << ' ' << p.y << ' ' << p.z << '\n';
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    file << soup.face_first[f + 1] - soup.face_first[f];
    for (std::uint32_t k = soup.face_first[f]; k < soup.face_first[f + 1]; ++k)
      file << ' ' << soup.corners[k];
    file << '\n';
  }
  close_or_throw(file, path);
}

class Reader {
 public:
  explicit Reader(const std::string& path) : path_(path), file_(path) {
    if (!file_) throw std::runtime_error(path + ": cannot be read");
  }
  bool next(std::string& line) {
    ++line_;
    return static_cast<bool>(std::getline(file_, line));
  }
  [[noreturn]] void wrong(const std::string& why) const {
    throw std::runtime_error(path_ + ":" + std::to_string(line_) + ": " + why);
  }
  double number(std::istringstream& words) const {
    std::string word;
    words >> word;
    char* end = nullptr;
    const double value = std::strtod(word.c_str(), &end);
    if (word.empty() || *end != 0 || !(value - value == 0)) wrong("'" + word + "' is no finite number");
    return value;
  }
  Ground::Point point(std::istringstream& words) const { return {number(words), number(words), number(words)}; }

 private:
  std::string path_;
  std::ifstream file_;
  std::size_t line_ = 0;
};

void read_plain(Reader& reader, WayFile& file, const PlainColumns& columns) {
  for (std::string line; reader.next(line);) {
    std::replace_if(
        line.begin(), line.end(), [](char c) { return c == ',' || c == ';' || c == '\r'; }, ' ');
    if (line.find_first_not_of(" \t") == std::string::npos || line[0] == '#') continue;
    std::istringstream words(line);
    std::string passed_over;
    for (int column = 1; column < columns.first; ++column)
      words >> passed_over;
    Ground::Point hip = reader.point(words);
    for (double& value : hip)
      value *= columns.unit_m;
    file.hips.push_back(hip);
  }
  if (file.hips.empty()) reader.wrong("the file has no row");
}

void read_rows(Reader& reader, WayFile& file, bool has_truth) {
  for (std::string line; reader.next(line);) {
    std::istringstream words(line);
    if (line.empty() || line[0] == '#') continue;
    file.hips.push_back(reader.point(words));
    if (!has_truth) continue;
    std::string state;
    words >> state;
    if (state != "free" && state != "face" && state != "edge" && state != "vertex")
      reader.wrong("'" + state + "' is not free, face, edge or vertex");
    file.true_god_objects.push_back(reader.point(words));
  }
  if (file.hips.empty()) reader.wrong("the file has no row");
}

// Until the line that names the columns.
void read_head(Reader& reader, WayFile& file) {
  std::map<std::string, std::string> said;
  std::string line;
  while (reader.next(line)) {
    const std::size_t space = line.find(' ');
    const std::string key = line.substr(0, space);
    said[key] = space == std::string::npos ? "" : line.substr(space + 1);
    if (key == "columns") break;
  }
  const auto value = [&](const char* key, double otherwise) {
    std::istringstream words(said[key]);
    return said[key].empty() ? otherwise : reader.number(words);
  };
  if (said["columns"] != kColumns && said["columns"] != "hip_x_m hip_y_m hip_z_m")
    reader.wrong("columns are to be: " + std::string(kColumns) + ", or the first three alone");
  if (said["mesh"].empty() || said["body"].empty()) reader.wrong("body and mesh stand before the columns");
  file.body = said["body"];
  file.mesh = said["mesh"];
  file.way = said["way"].empty() ? "file" : said["way"];
  file.reference = said["reference"];
  file.seed = static_cast<std::uint64_t>(value("seed", 0));
  file.rate_hz = value("rate_hz", 1000);
  file.mu_static = value("mu_static", 0);
  file.mu_dynamic = value("mu_dynamic", 0);
  if (!(file.rate_hz > 0) || !(file.mu_dynamic >= 0) || !(file.mu_static >= file.mu_dynamic))
    reader.wrong("rate_hz is positive, 0 <= mu_dynamic <= mu_static");
  read_rows(reader, file, said["columns"] == kColumns);
}

}  // namespace

std::string name_of(const WayFile& file) {
  char text[80];
  std::snprintf(text, sizeof text, ".seed%llu.%gHz.mu%g", static_cast<unsigned long long>(file.seed), file.rate_hz,
                file.mu_static);
  return file.body + "." + file.way + text;
}

void write_way(const std::string& folder, const WayFile& file, const std::vector<TrueBody::Tick>& truth,
               const bake::PolygonSoup& soup) {
  std::filesystem::create_directories(folder);
  write_mesh(std::filesystem::path(folder) / (file.body + ".off"), soup);
  const std::filesystem::path path = std::filesystem::path(folder) / (name_of(file) + ".way");
  std::ofstream out(path);
  out << kFirstLine << "\nbody " << file.body << "\nmesh " << file.body << ".off\nway " << file.way << "\nseed " << file.seed
      << "\nrate_hz " << exact(file.rate_hz) << "\nmu_static " << exact(file.mu_static) << "\nmu_dynamic "
      << exact(file.mu_dynamic) << "\nstiffness_n_per_m " << exact(kStiffness_n_per_m) << "\nreference " << file.reference
      << "\ncolumns " << kColumns << '\n';
  for (std::size_t i = 0; i < file.hips.size(); ++i) {
    const Ground::Point& hip = file.hips[i];
    out << exact(hip[0]) << ' ' << exact(hip[1]) << ' ' << exact(hip[2]) << ' ' << state_name(truth[i].state);
    put(out, truth[i].feel.god_object);
    put(out, truth[i].feel.force);
    out << ' ' << truth[i].others.size();
    for (std::size_t k = 0; k < truth[i].others.size(); ++k) {
      const Feel& other = truth[i].others[k];
      out << (k + truth[i].as_right_in_doubles >= truth[i].others.size() ? " 1" : " 0") << (other.in_contact ? " 1" : " 0");
      put(out, other.god_object);
      put(out, other.force);
    }
    out << '\n';
  }
  close_or_throw(out, path);
}

void write_answers(const std::string& folder, const WayFile& file, const std::string& contender, const std::string& precision,
                   const std::vector<Feel>& felt) {
  const std::filesystem::path path = std::filesystem::path(folder) / (name_of(file) + "." + contender + ".answers");
  std::ofstream out(path);
  out << "fdcg-answers 1\nway " << name_of(file) << ".way\ncontender " << contender << "\nprecision " << precision
      << "\ncolumns contact carried god_object_x_m god_object_y_m god_object_z_m force_x_n force_y_n force_z_n\n";
  for (const Feel& feel : felt) {
    out << (feel.in_contact ? 1 : 0) << ' ' << (feel.is_carried ? 1 : 0);
    put(out, feel.god_object);
    put(out, feel.force);
    out << '\n';
  }
  close_or_throw(out, path);
}

WayFile read_way(const std::string& path, const PlainColumns& columns) {
  WayFile file;
  Reader reader(path);
  std::string first;
  if (!reader.next(first)) reader.wrong("the file is empty");
  if (first == kFirstLine) {
    read_head(reader, file);
    const std::filesystem::path mesh(file.mesh);
    if (mesh.is_relative()) file.mesh = (std::filesystem::path(path).parent_path() / mesh).string();
    return file;
  }
  Reader again(path);
  file.way = std::filesystem::path(path).stem().string();
  file.rate_hz = columns.rate_hz;
  read_plain(again, file, columns);
  return file;
}

}  // namespace fdcg::test
