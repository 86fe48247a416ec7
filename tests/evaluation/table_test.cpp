// SPDX-License-Identifier: Apache-2.0
#include "table.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "catch.hpp"
#include "scratch_folder.hpp"

using namespace fdcg::test;

namespace {

std::string text_of(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

const std::string kFolder = scratch_folder().string();

}  // namespace

TEST_CASE("a table has its header, its rows, and quotes what would break a row") {
  {
    Table table(kFolder, "t", {"name", "p50_ns", "count"});
    table.row("plain", 0.1, 3);
    table.row("comma, \"quote\"", 1.0 / 3, std::uint64_t{1} << 60);
    table.row("none", std::numeric_limits<double>::quiet_NaN(), -1);
    CHECK_THROWS_AS(table.row("too few"), std::logic_error);
  }
  CHECK(text_of(std::filesystem::path(kFolder) / "t.csv") ==
        "name,p50_ns,count\nplain,0.1,3\n\"comma, \"\"quote\"\"\",0.333333333,1152921504606846976\nnone,nan,-1\n");
}

TEST_CASE("a bar holds at its limit; beyond it, and for what was not measured, it fails") {
  {
    Bars bars(kFolder, "p");
    CHECK(bars.at_most("error", 8, 8, "ulp"));
    CHECK_FALSE(bars.at_most("error", 8.5, 8, "ulp"));
    CHECK(bars.at_least("rate", 8, 8, "kHz"));
    CHECK_FALSE(bars.at_least("rate", std::numeric_limits<double>::quiet_NaN(), 8, "kHz"));
    CHECK(bars.failures() == 2);
  }
  const std::string text = text_of(std::filesystem::path(kFolder) / "p.bars.csv");
  CHECK(text.find("error,8.5,at most,8,ulp,FAIL,\n") != std::string::npos);
}

TEST_CASE("a folder that cannot be made is an error that names the file") {
  CHECK_THROWS(Table("/proc/no such folder", "t", {"a"}));
}

TEST_CASE("bars that stop at the first one that fails end the program there, with exit code 1") {
  const pid_t child = fork();
  if (child == 0) {
    constexpr int kWentOn = 5;
    Bars bars(kFolder, "first", true);
    bars.at_most("holds", 1, 2, "");
    bars.at_most("fails", 3, 2, "");
    _exit(kWentOn);
  }
  int status = 0;
  REQUIRE(waitpid(child, &status, 0) == child);
  CHECK(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 1);
  CHECK(text_of(std::filesystem::path(kFolder) / "first.bars.csv").find("fails,3,at most,2,,FAIL,") != std::string::npos);
}
