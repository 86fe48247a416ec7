// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <fstream>

#ifdef __linux__
#include <sys/sysmacros.h>
#endif

#include "shared/text.hpp"
#include "transport/device_claim.hpp"

namespace fdcg::dev {
namespace {

// The process that has the lock on that file, as the system tells it; 0: it does not.
long owner_of(int descriptor) {
#ifdef __linux__
  struct stat file {};
  if (fstat(descriptor, &file) != 0) return 0;
  std::ifstream locks("/proc/locks");
  for (std::string line; std::getline(locks, line);) {
    char kind[16];
    long process = 0;
    unsigned on_major = 0, on_minor = 0;
    unsigned long inode = 0;
    const int read = std::sscanf(line.c_str(), "%*s %15s %*s %*s %ld %x:%x:%lu", kind, &process, &on_major, &on_minor, &inode);
    if (read != 5 || std::string(kind) != "FLOCK" || process <= 0) continue;
    if (inode == file.st_ino && on_major == major(file.st_dev) && on_minor == minor(file.st_dev)) return process;
  }
#else
  static_cast<void>(descriptor);
#endif
  return 0;
}

std::string owner_text(long process) {
  if (process == 0) return "another program drives this device; end that program first";
  if (process == getpid())
    return "another device of this scene is the same one; give each a \"serial\" or a \"path\" of its own";
  std::string name;
  std::ifstream("/proc/" + std::to_string(process) + "/comm") >> name;
  return "process " + std::to_string(process) + (name.empty() ? "" : " (" + one_line(name) + ")") +
         " drives this device; end it first";
}

}  // namespace

std::string DeviceClaim::take(const std::string& node) {
  release();
  if (node.empty()) return {};
  const int descriptor = open(node.c_str(), O_WRONLY | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return {};
  if (flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    std::string problem = node + ": " + owner_text(owner_of(descriptor));
    close(descriptor);
    return problem;
  }
  descriptor_ = descriptor;
  return {};
}

void DeviceClaim::release() {
  if (descriptor_ >= 0) close(descriptor_);
  descriptor_ = -1;
}

}  // namespace fdcg::dev
