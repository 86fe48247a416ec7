// SPDX-License-Identifier: Apache-2.0
#include "trajectory_csv.hpp"

#include <cmath>

#include "catch.hpp"

using fdcg::servo::parse_trajectory;
using fdcg::servo::TrajectoryPoint;

namespace {

std::vector<TrajectoryPoint> parsed(std::string_view text) {
  std::vector<TrajectoryPoint> points;
  std::string error;
  INFO(error);
  REQUIRE(parse_trajectory(text, "hip.csv", points, error));
  return points;
}

std::string refused(std::string_view text) {
  std::vector<TrajectoryPoint> points;
  std::string error;
  REQUIRE_FALSE(parse_trajectory(text, "hip.csv", points, error));
  REQUIRE(error.find('\n') == std::string::npos);
  return error;
}

}  // namespace

TEST_CASE("columns are found by name, in any order, among others") {
  const auto points = parsed("note,z,t,x,y\nfirst,3,0.5,1,2\n,6,1.5,4,5\n");
  REQUIRE(points.size() == 2);
  CHECK(points[0].t_s == 0.5);
  CHECK(points[1].hip_object_m == std::array<double, 3>{4, 5, 6});
}

TEST_CASE("numbers read back to the last bit") {
  const auto points = parsed("t,x,y,z\n0,0.10000000000000001,-2.2250738585072014e-308,1.7976931348623157e308\n");
  CHECK(points[0].hip_object_m == std::array<double, 3>{0.1, -0x1p-1022, 0x1.fffffffffffffp1023});
}

TEST_CASE("line ends, blanks, quotes, a byte-order mark and a missing last line end are taken as they come") {
  const auto points = parsed("\xEF\xBB\xBFt , \"x\",y,z\r\n\r\n 0,\" 1\",\t2,+3 \r\n1,1,2,3");
  REQUIRE(points.size() == 2);
  CHECK(points[0].hip_object_m == points[1].hip_object_m);
}

TEST_CASE("a comma inside quotes does not part a field") {
  CHECK(parsed("t,note,x,y,z\n0,\"a, b\",1,2,3\n")[0].hip_object_m[0] == 1);
}

TEST_CASE("positions that are not finite pass, times do not") {
  const auto points = parsed("t,x,y,z\n0,nan,inf,-inf\n");
  CHECK(std::isnan(points[0].hip_object_m[0]));
  CHECK(std::isinf(points[0].hip_object_m[2]));
  CHECK(refused("t,x,y,z\ninf,0,0,0\n") == "hip.csv, line 2: the time is not finite");
}

TEST_CASE("what is wrong is told with line, column and value") {
  CHECK(refused("t,x,y,z\n0,0,0,0\n0,0,1e,0\n") ==
        "hip.csv, line 3: column 'y' holds '1e', which is not a number that a double can hold");
  CHECK(refused("t,x,y,z\n0,0\n") == "hip.csv, line 2: 2 columns, but 'y' is number 3");
  CHECK(refused("t,x,y\n0,0,0\n").find("no column 'z'") != std::string::npos);
  CHECK(refused("t,x,y,z,t\n").find("'t' twice") != std::string::npos);
  CHECK(refused("t,x,y,z\n").find("no row") != std::string::npos);
  CHECK(refused("").find("empty") != std::string::npos);
}

TEST_CASE("control characters of a bad value do not reach the terminal") {
  CHECK(refused("t,x,y,z\n0,\x1b[31m,0,0\n").find('\x1b') == std::string::npos);
}
