// SPDX-License-Identifier: Apache-2.0
// Folders for files that a test writes. No other test has the same, though several run at once; all are gone when the program
// ends.
#pragma once

#include <stdlib.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

namespace fdcg::test {

// A new and empty folder.
inline std::filesystem::path scratch_folder() {
  struct Folders {
    std::vector<std::filesystem::path> made;
    const pid_t maker = getpid();
    Folders() = default;
    Folders(const Folders&) = delete;
    Folders& operator=(const Folders&) = delete;
    ~Folders() {
      if (getpid() != maker) return;  // a child that a test has forked
      std::error_code ignored;
      for (const std::filesystem::path& folder : made)
        std::filesystem::remove_all(folder, ignored);
    }
  };
  static Folders folders;
  std::string name = (std::filesystem::temp_directory_path() / "fdcg-test-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error(name + ": cannot be made");
  return folders.made.emplace_back(name);
}

}  // namespace fdcg::test
