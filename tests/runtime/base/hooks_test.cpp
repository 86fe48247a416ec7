// SPDX-License-Identifier: Apache-2.0
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <string>
#include <utility>
#include <vector>

#include "base/hooks.hpp"
#include "catch.hpp"
#include "fdcg/bake.hpp"
#include "fdcg/fdcg.h"
#include "meshes.hpp"
#include "sealed_bytes.hpp"

using namespace fdcg::test;
namespace bake = fdcg::bake;

namespace {

using Lines = std::vector<std::pair<fdcg_log_level, std::string>>;

void keep_line(void* context, fdcg_log_level level, const char* text) {
  static_cast<Lines*>(context)->emplace_back(level, text);
}

// Resets the handlers after each test.
struct Handlers {
  ~Handlers() {
    fdcg_set_log_handler(nullptr, nullptr);
    fdcg_set_assert_handler(nullptr, nullptr);
  }
};

AlignedBytes compiled_cube() {
  const auto compiled = bake::compile(cube(), {});
  REQUIRE(compiled);
  return AlignedBytes(compiled->bytes);
}

}  // namespace

TEST_CASE("the log handler is called for each graph opened or refused, with the error's message") {
  const Handlers restore;
  AlignedBytes file = compiled_cube();
  fdcg_graph graph;
  fdcg_error error = {};
  Lines lines;
  fdcg_set_log_handler(keep_line, &lines);
  REQUIRE(fdcg_open_memory(file.data(), file.size(), FDCG_VERIFY_FULL, &graph, &error) == FDCG_OK);
  REQUIRE(lines.size() == 1);
  CHECK(lines[0] == std::make_pair(FDCG_LOG_INFO, std::string("opened a graph of 6 nodes")));
  CHECK(fdcg_open_memory(file.data(), file.size() - 1, FDCG_VERIFY_FULL, &graph, &error) == FDCG_E_TRUNCATED);
  REQUIRE(lines.size() == 2);
  CHECK(lines[1] == std::make_pair(FDCG_LOG_ERROR, std::string(error.message)));
  // a caller without an error struct gets the message in the log
  CHECK(fdcg_open_memory(file.data(), 3, FDCG_VERIFY_FULL, &graph, nullptr) == FDCG_E_TRUNCATED);
  CHECK(fdcg_open_file("/no/such/file.fdcg", FDCG_VERIFY_FULL, &graph, nullptr) == FDCG_E_IO);
  REQUIRE(lines.size() == 4);
  CHECK(lines[3].second.find("/no/such/file.fdcg") != std::string::npos);
}

TEST_CASE("without a log handler nothing is logged, and the step never logs") {
  const Handlers restore;
  AlignedBytes file = compiled_cube();
  Lines lines;
  fdcg_set_log_handler(keep_line, &lines);
  fdcg_set_log_handler(nullptr, nullptr);
  fdcg_graph graph;
  REQUIRE(fdcg_open_memory(file.data(), file.size(), FDCG_VERIFY_FULL, &graph, nullptr) == FDCG_OK);
  fdcg_set_log_handler(keep_line, &lines);
  touch_everywhere(graph, 200);
  CHECK(lines.empty());
}

TEST_CASE("a valid step triggers no assertion") {
  const Handlers restore;
  std::string faults;
  fdcg_set_assert_handler([](void* context, const char* condition, const char*,
                             std::uint32_t) { *static_cast<std::string*>(context) += condition; },
                          &faults);
  AlignedBytes file = compiled_cube();
  fdcg_graph graph;
  REQUIRE(fdcg_open_memory(file.data(), file.size(), FDCG_VERIFY_FULL, &graph, nullptr) == FDCG_OK);
  touch_everywhere(graph, 2000);
  CHECK(faults == "");
}

TEST_CASE("a failed assertion calls the handler with its place, and traps without one") {
  const Handlers restore;
  struct Seen {
    std::string condition, file;
    std::uint32_t line = 0;
  } seen;
  fdcg_set_assert_handler(
      [](void* context, const char* condition, const char* file, std::uint32_t line) {
        *static_cast<Seen*>(context) = {condition, file, line};
      },
      &seen);
  fdcg::assert_failed("a < b", "here.cpp", 12);
  CHECK(seen.condition == "a < b");
  CHECK(seen.file == "here.cpp");
  CHECK(seen.line == 12);

  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    for (const int signal : {SIGILL, SIGTRAP, SIGSEGV, SIGABRT})
      std::signal(signal, SIG_DFL);  // Catch reports them otherwise
    fdcg_set_assert_handler(nullptr, nullptr);
    fdcg::assert_failed("a < b", "here.cpp", 12);
    _exit(0);
  }
  int status = 0;
  REQUIRE(waitpid(child, &status, 0) == child);
  CHECK(WIFSIGNALED(status));
}
