// SPDX-License-Identifier: Apache-2.0
// The JSON files that fdcg validate reads: any bytes are understood, or refused in one short line.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "fdcg/bake.hpp"

namespace fdcg::tools {

// The bytes under a path, without a disk: nothing else of the process has it open.
class MemoryFile {
 public:
  MemoryFile(const unsigned char* data, std::size_t size) : descriptor_(memfd_create("fuzz", 0)) {
    if (descriptor_ < 0 || write(descriptor_, data, size) != static_cast<ssize_t>(size)) std::abort();
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  ~MemoryFile() { close(descriptor_); }
  [[nodiscard]] std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

inline void require_one_short_line(const bake::Failure& failure) {
  constexpr std::size_t kLongest = 2000;
  const bool is_line = failure.message.find_first_of("\r\n") == std::string::npos;
  if (is_line && failure.message.size() < kLongest && (failure.exit_code == 2 || failure.exit_code == 3)) return;
  std::fprintf(stderr, "exit code %d, %zu bytes: %.300s\n", failure.exit_code, failure.message.size(), failure.message.c_str());
  std::abort();
}

}  // namespace fdcg::tools
