// SPDX-License-Identifier: Apache-2.0
#include "expand_paths.hpp"

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "catch.hpp"

using namespace fdcg::tools;
namespace fs = std::filesystem;

namespace {

// A folder with some files, made the current one while it lives.
class Folder {
 public:
  Folder() : before_(fs::current_path()), path_(fs::temp_directory_path() / ("fdcg-expand-" + std::to_string(getpid()))) {
    fs::create_directories(path_);
    fs::current_path(path_);
    for (const char* file : {"b.stl", "a.stl", "A.STL", "note.txt", ".hidden.stl", "sub/c.obj", "sub/deep/d.stl",
                             "sub/.git/e.stl", "[x].off", "sub/deep/{y}.ply", "z*.off"}) {
      fs::create_directories(fs::path(file).parent_path().empty() ? "." : fs::path(file).parent_path());
      std::ofstream(file) << "x";
    }
    fs::create_directories("empty");
    fs::create_directory_symlink("..", "sub/up");  // a loop
  }
  ~Folder() {
    fs::current_path(before_);
    fs::remove_all(path_);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

 private:
  fs::path before_, path_;
};

std::vector<std::string> expanded(const std::vector<std::string>& arguments) {
  std::vector<std::string> paths;
  for (const NamedFile& file : expand_paths(arguments, {".stl", ".obj", ".ply", ".off"}))
    paths.push_back(file.path + (file.problem.empty() ? "" : "!"));
  return paths;
}

using Paths = std::vector<std::string>;

}  // namespace

TEST_CASE("patterns of one component match as in a shell") {
  for (const char* pattern :
       {"abc", "a*", "*c", "*b*", "a?c", "[a-c]bc", "a[!x]c", "***", "a*b*c", "[]a]bc", "*abc*", "ABC", "[A-C]?C"})
    CHECK(matches_pattern("abc", pattern));
  for (const char* pattern : {"ab", "abcd", "b*", "*b", "a?", "[b-c]bc", "a[!b]c", "", "a*d", "?abc", "a[!B]c"})
    CHECK_FALSE(matches_pattern("abc", pattern));
  CHECK(matches_pattern("", "*"));
  CHECK(matches_pattern("a[b", "a[b"));  // never closed
  CHECK(matches_pattern("a-b", "a[x-]b"));
  CHECK(matches_pattern(std::string(3000, 'a'), "*a*a*a*a*a*a*a*a*a*"));
  CHECK_FALSE(matches_pattern(std::string(3000, 'a'), "*a*a*a*a*a*a*a*a*b"));
}

TEST_CASE("arguments become files in a stable order, each once") {
  const Folder folder;
  CHECK(expanded({"*.stl"}) == Paths{"A.STL", "a.stl", "b.stl"});
  CHECK(expanded({"b.stl", "*.stl", "missing.stl", "-"}) == Paths{"b.stl", "A.STL", "a.stl", "missing.stl", "-"});
  CHECK(expanded({"**/*.{stl,obj}"}) == Paths{"A.STL", "a.stl", "b.stl", "sub/c.obj", "sub/deep/d.stl"});
  CHECK(expanded({"sub/**/d.stl"}) == Paths{"sub/deep/d.stl"});
  CHECK(expanded({"./s?b/*/*.stl"}) == Paths{"./sub/deep/d.stl", "./sub/up/A.STL", "./sub/up/a.stl", "./sub/up/b.stl"});
  CHECK(expanded({".h*.stl"}) == Paths{".hidden.stl"});
  CHECK(expanded({fs::current_path().string() + "/[ab].stl"}) == Paths{fs::current_path().string() + "/A.STL",
                                                                       fs::current_path().string() + "/a.stl",
                                                                       fs::current_path().string() + "/b.stl"});
  CHECK(expanded({"sub/deep/**"}) == Paths{"sub/deep/d.stl", "sub/deep/{y}.ply"});
}

TEST_CASE("patterns match names in any case, as the search of a folder does") {
  const Folder folder;
  CHECK(expanded({"{A,B}.stl"}) == Paths{"A.STL", "a.stl", "b.stl"});
  CHECK(expanded({"SUB/**/*.OBJ"}) == Paths{"sub/c.obj"});
  CHECK(expanded({"**/D.stl"}) == Paths{"sub/deep/d.stl"});
}

TEST_CASE("a name that exists is no pattern") {
  const Folder folder;
  CHECK(expanded({"[x].off"}) == Paths{"[x].off"});
  CHECK(expanded({"sub/deep/{y}.ply"}) == Paths{"sub/deep/{y}.ply"});
  CHECK(expanded({"z*.off"}) == Paths{"z*.off"});
}

TEST_CASE("folders are searched for meshes, whatever the case of their endings") {
  const Folder folder;
  CHECK(expanded({"sub"}) == Paths{"sub/c.obj", "sub/deep/d.stl", "sub/deep/{y}.ply"});
  CHECK(expanded({"."}).size() == 8);
  CHECK(expanded({"./"})[0] == "./A.STL");
}

TEST_CASE("what gives no file says so") {
  const Folder folder;
  CHECK(expanded({"empty", "*.drc", "no/**/x.stl"}) == Paths{"empty!", "*.drc!", "no/**/x.stl!"});
}
