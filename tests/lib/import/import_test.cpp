// SPDX-License-Identifier: Apache-2.0
// What holds for every format: detection, files, quanta, hash. The readers have tests of their own.
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <thread>

#include "../../support/import_support.hpp"

using namespace fdcg::bake;
using namespace fdcg::bake::test;

namespace {

const std::string kOff = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
const std::string kObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

// A folder that goes away with the test.
struct TemporaryFolder {
  std::filesystem::path path;
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "fdcg-import-XXXXXX").string();
    REQUIRE(::mkdtemp(name.data()) != nullptr);
    path = name;
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() { std::filesystem::remove_all(path); }
  [[nodiscard]] std::filesystem::path write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path / name, std::ios::binary) << bytes;
    return path / name;
  }
};

PolygonSoup obj_with(const std::string& coordinates) {
  return import_text("v " + coordinates + "\nf 1 1 1\n");
}

}  // namespace

TEST_CASE("the content determines the format, not the extension") {
  const TemporaryFolder folder;
  for (const std::string ending : {".off", ".obj", ".ply", ".stl", ".txt", ""}) {
    INFO(ending);
    CHECK(import_mesh(folder.write("a" + ending, kOff))->format == Format::off);
    CHECK(import_mesh(folder.write("b" + ending, "# made by hand\n\n" + kObj))->format == Format::obj);
  }
}

TEST_CASE("the extension determines the format where the content does not") {
  const TemporaryFolder folder;
  CHECK(import_mesh(folder.write("a.OFF", kOff.substr(4)))->format == Format::off);
  CHECK(import_mesh(folder.write("a.Obj", "end\n" + kObj))->format == Format::obj);
  const Result<PolygonSoup> unknown = import_mesh(folder.write("a.dat", "end\n" + kObj));
  REQUIRE_FALSE(unknown);
  CHECK(
      unknown.error().message.ends_with("a.dat: is of no known mesh format; OFF, OBJ, PLY, STL, glTF, GLB, Draco, COLLADA, "
                                        "3MF, VTK and X3D are read: export it as one of them"));
}

TEST_CASE("a format given by the caller is not questioned") {
  CHECK(import_text("end\n" + kObj, Format::obj).face_count() == 1);
  CHECK(refusal(kObj, Format::off).find("in place of the keyword OFF") != std::string::npos);
}

TEST_CASE("a missing file, a directory, an empty file and an unreadable one are refused in one line") {
  const TemporaryFolder folder;
  const auto message = [](const std::filesystem::path& path) {
    const Result<PolygonSoup> soup = import_mesh(path);
    REQUIRE_FALSE(soup);
    CHECK(soup.error().exit_code == 3);
    CHECK(soup.error().message.starts_with(path.string() + ": "));
    return soup.error().message.substr(path.string().size() + 2) + " [" + soup.error().rule + "]";
  };
  CHECK(message(folder.path / "missing.off") ==
        "cannot be opened: No such file or directory; check the path and its permissions [unreadable]");
  CHECK(message(folder.path) == "is a directory; name a mesh file in it [unreadable]");
  CHECK(message(folder.write("empty.ply", "")) == "is empty; export the mesh again [empty-mesh]");
  if (::geteuid() != 0) {
    const std::filesystem::path secret = folder.write("secret.off", kOff);
    ::chmod(secret.c_str(), 0);
    CHECK(message(secret).starts_with("cannot be opened: Permission denied"));
  }
}

TEST_CASE("a pipe is read to its end") {
  const TemporaryFolder folder;
  const std::filesystem::path pipe = folder.path / "pipe.off";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  std::string text = "OFF 3 200000 0\n0 0 0\n1 0 0\n0 1 0\n";
  for (int i = 0; i < 200'000; ++i)
    text += "3 0 1 2\n";
  std::thread writer([&] { std::ofstream(pipe, std::ios::binary) << text; });
  const Result<PolygonSoup> soup = import_mesh(pipe);
  writer.join();
  REQUIRE(soup);
  CHECK(soup->face_count() == 200'000);
}

TEST_CASE("the name is the path as given, control characters in it stay out of the message") {
  CHECK(import_memory(kOff, "some/where.off")->name == "some/where.off");
  const Result<PolygonSoup> soup = import_memory("", "two\nlines");
  REQUIRE_FALSE(soup);
  CHECK(soup.error().message == "two?lines: is empty; export the mesh again");
}

TEST_CASE("UTF-16 text is refused by name") {
  CHECK(refusal(std::string("\xFF\xFEv\0 \0", 6)).find("UTF-16") != std::string::npos);
  CHECK(refusal(std::string("\xFE\xFF\0v\0 ", 6)).find("UTF-16") != std::string::npos);
}

TEST_CASE("compressed, packed and unsupported formats are refused by name, with a remedy") {
  const auto says = [](const std::string& bytes, const std::string& what) {
    INFO(what);
    CHECK(refusal(bytes).find(what) != std::string::npos);
    CHECK(refusal(bytes, Format::ply).find(what) != std::string::npos);
  };
  says("\x1F\x8B\x08 rest", "compressed with gzip; decompress it first (gunzip)");
  says("BZh91AY rest", "compressed with bzip2");
  says(std::string("\xFD") + "7zXZ rest", "compressed with xz");
  says("\x28\xB5\x2F\xFD rest", "compressed with zstd");
  says("PK\x03\x04 rest", "is a ZIP archive");
  says("7z\xBC\xAF\x27\x1C", "is a 7z archive");
  says("Kaydara FBX Binary  ", "is FBX, which is not read");
  says("<?xml version=\"1.0\"?><svg/>", "is XML (or HTML)");
  says("<!DOCTYPE html>", "is XML (or HTML)");
  says("ISO-10303-21;\nHEADER;", "is a STEP file");
  // a binary STL may start with anything
  std::string stl = "PK\x03\x04";
  stl.resize(80, ' ');
  put<std::uint32_t>(stl, 1);
  stl.resize(stl.size() + 50, '\1');
  CHECK(import_text(stl).format == Format::stl);
}

TEST_CASE("the hash is SHA-256 of the bytes, of large files too") {
  CHECK(import_text(kOff).sha256 == "fb24d942999fec35fed007b5f84ca44064f763225bc01c58ef70e281a1eff083");
  std::string large = kOff;
  large.resize((9U << 20) + 5, '\n');
  CHECK(import_text(large).sha256 == "40c0a0f4051f39050547ad531613758f1b5426f32b626d0c7f53a477b1816bc5");
}

TEST_CASE("the relative quantum is that of floats where every finite coordinate is one") {
  CHECK(obj_with("0.5 1.25 16777216").relative_quantum == 0x1p-24);
  CHECK(obj_with("0.5 nan inf").relative_quantum == 0x1p-24);
  CHECK(obj_with("0.5 0.1 0").relative_quantum == 0x1p-53);
  CHECK(obj_with("16777217 0 0").relative_quantum == 0x1p-53);
  CHECK(obj_with("1e300 0 0").relative_quantum == 0x1p-53);
}

TEST_CASE("the absolute quantum is half a unit of the last digit printed, 0 for whole numbers") {
  CHECK(obj_with("0.50000 1.25 16").absolute_quantum == 5e-6);
  CHECK(obj_with("0.100000 0 0").absolute_quantum == 5e-7);
  CHECK(obj_with("1.50000e-3 10 0").absolute_quantum == 5e-9);
  CHECK(obj_with("0.5 1.25 16").absolute_quantum == 1e-5 * 16);  // few digits were meant, not rounded to
  CHECK(obj_with("1.5e+3 0 0").absolute_quantum == 0);
  CHECK(obj_with("1 2 3").absolute_quantum == 0);
  CHECK(obj_with("nan inf 1").absolute_quantum == 0);
  CHECK(obj_with("1e-400 0 0").absolute_quantum == 0);
  CHECK(import_text("OFF\n1 1 0\n0 0.125000 0 0.123456789\n1 0 0.55\n").absolute_quantum ==
        5e-7);  // of coordinates, not of colours
}

TEST_CASE("progress rises to 1") {
  std::string text = "OFF 3 300000 0\n0 0 0\n1 0 0\n0 1 0\n";
  for (int i = 0; i < 300'000; ++i)
    text += "3 0 1 2\n";
  std::vector<double> seen;
  ImportOptions options;
  options.progress = [&seen](std::string_view stage, double fraction) {
    CHECK(stage == "import");
    seen.push_back(fraction);
  };
  REQUIRE(import_memory(text, "mesh", options));
  REQUIRE(seen.size() >= 3);
  CHECK(seen.size() <= 103);
  CHECK(std::is_sorted(seen.begin(), seen.end()));
  CHECK(seen.back() == 1.0);
}
