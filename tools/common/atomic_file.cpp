// SPDX-License-Identifier: Apache-2.0
// The POSIX side of AtomicFile; another platform needs another file of this name.
#include "atomic_file.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>

namespace fdcg::tools {
namespace {

constexpr int kStandardOutput = 1;
constexpr std::size_t kMaxPath = 4096;
constexpr int kMaxLeftovers = 100;

// Files to remove when a signal ends the program. The handler may only read memory and call unlink.
struct CleanupSlot {
  std::atomic<bool> taken{false};
  std::atomic<bool> armed{false};
  std::array<char, kMaxPath> path{};
};
std::array<CleanupSlot, 8> cleanup_slots;

extern "C" void remove_unfinished_files(int signal_number) {
  for (CleanupSlot& slot : cleanup_slots) {
    if (slot.armed) unlink(slot.path.data());
  }
  std::signal(signal_number, SIG_DFL);
  raise(signal_number);
}

void install_handlers_once() {
  static const bool installed = [] {
    for (const int signal_number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL}) {
      struct sigaction old {};
      sigaction(signal_number, nullptr, &old);
      if (old.sa_handler != SIG_DFL) continue;  // nohup and the like stay in force
      struct sigaction action {};
      action.sa_handler = remove_unfinished_files;
      sigfillset(&action.sa_mask);
      sigaction(signal_number, &action, nullptr);
    }
    return true;
  }();
  static_cast<void>(installed);
}

int arm_cleanup(const std::string& path) {
  if (path.size() >= kMaxPath) return -1;
  install_handlers_once();
  for (std::size_t i = 0; i < cleanup_slots.size(); ++i) {
    CleanupSlot& slot = cleanup_slots[i];
    if (slot.taken.exchange(true)) continue;
    std::memcpy(slot.path.data(), path.c_str(), path.size() + 1);
    slot.armed = true;
    return static_cast<int>(i);
  }
  return -1;
}

void disarm_cleanup(int slot) {
  if (slot < 0) return;
  cleanup_slots[static_cast<std::size_t>(slot)].armed = false;
  cleanup_slots[static_cast<std::size_t>(slot)].taken = false;
}

bool is_standard_output(const struct stat& status) {
  struct stat standard {};
  return fstat(kStandardOutput, &standard) == 0 && standard.st_dev == status.st_dev && standard.st_ino == status.st_ino;
}

}  // namespace

AtomicFile::AtomicFile(std::string path, std::string unfinished) : path_(std::move(path)), unfinished_(std::move(unfinished)) {
  if (const int error_number = open_target(); error_number != 0) fail(error_number);
}

int AtomicFile::open_target() {
  if (!is_wanted()) return 0;
  if (path_ == "-") {
    descriptor_ = kStandardOutput;
    return 0;
  }
  struct stat status {};
  target_ = path_;
  if (stat(path_.c_str(), &status) != 0) {
    if (errno != ENOENT) return errno;
    return open_beside();
  }
  if (S_ISDIR(status.st_mode)) return EISDIR;
  if (is_standard_output(status)) {  // replacing the file would part it from the stream
    descriptor_ = kStandardOutput;
    return 0;
  }
  if (access(path_.c_str(), W_OK) != 0) return errno;
  if (!S_ISREG(status.st_mode)) {
    target_.clear();
    descriptor_ = open(path_.c_str(), O_WRONLY | O_CLOEXEC);
    return descriptor_ < 0 ? errno : 0;
  }
  std::error_code unknown;
  const std::filesystem::path real = std::filesystem::canonical(path_, unknown);
  if (!unknown) target_ = real.string();
  const int error_number = open_beside();
  if (error_number == 0) static_cast<void>(fchmod(descriptor_, status.st_mode & 07777));  // a refusal costs the old mode only
  return error_number;
}

int AtomicFile::open_beside() {
  const std::string stem = unfinished_.empty() ? target_ + ".part-" + std::to_string(getpid()) : unfinished_;
  for (int attempt = 0;; ++attempt) {  // a leftover of a killed program with our number may be in the way
    beside_ = stem + (attempt == 0 ? "" : "-" + std::to_string(attempt));
    cleanup_slot_ = arm_cleanup(beside_);
    descriptor_ = open(beside_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ >= 0) return 0;
    const int error_number = errno;
    disarm_cleanup(cleanup_slot_);
    cleanup_slot_ = -1;
    beside_.clear();
    if (error_number != EEXIST || attempt == kMaxLeftovers) return error_number;
  }
}

AtomicFile::~AtomicFile() {
  discard();
}

void AtomicFile::write(std::string_view bytes) {
  while (ok() && is_wanted() && !bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return fail(written < 0 ? errno : EIO);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void AtomicFile::expect(std::size_t bytes) {
  if (!ok() || beside_.empty() || bytes == 0 || room_maker_.joinable()) return;
  is_room_wanted_ = true;
  room_maker_ = std::thread([this, bytes] { make_room(bytes); });
}

// On a thread of its own. Whatever fails here is tried again, and reported, by map().
void AtomicFile::make_room(std::size_t bytes) {
  if (posix_fallocate(descriptor_, 0, static_cast<off_t>(bytes)) != 0) return;
  void* const memory = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor_, 0);
  if (memory == MAP_FAILED) return;
  mapping_ = {static_cast<std::byte*>(memory), bytes};
#ifdef MADV_POPULATE_WRITE
  constexpr std::size_t kChunk = std::size_t{4} << 20;
  for (std::size_t at = 0; at < bytes && is_room_wanted_; at += kChunk) {
    if (madvise(mapping_.data() + at, std::min(kChunk, bytes - at), MADV_POPULATE_WRITE) != 0) return;
  }
#endif
}

std::span<std::byte> AtomicFile::map(std::size_t bytes) {
  is_room_wanted_ = false;
  if (room_maker_.joinable()) room_maker_.join();
  if (!ok() || beside_.empty() || bytes == 0) return {};
  content_bytes_ = bytes;
  if (mapping_.size() >= bytes) return mapping_.first(bytes);
  unmap();
  // Reserved first: a page that finds no room when it is written to would be a signal, not an error.
  const int error_number = posix_fallocate(descriptor_, 0, static_cast<off_t>(bytes));
  if (error_number == ENOSPC || error_number == EFBIG) fail(error_number);
  if (error_number == 0) {
    void* const memory = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor_, 0);
    if (memory != MAP_FAILED) mapping_ = {static_cast<std::byte*>(memory), bytes};
  }
  if (mapping_.empty() && ok()) {  // write() will do instead
    content_bytes_ = 0;
    if (ftruncate(descriptor_, 0) != 0) fail(errno);
  }
  return mapping_;
}

void AtomicFile::unmap() {
  is_room_wanted_ = false;
  if (room_maker_.joinable()) room_maker_.join();
  if (!mapping_.empty()) munmap(mapping_.data(), mapping_.size());
  mapping_ = {};
}

bool AtomicFile::commit() {
  if (!ok()) return false;
  const bool is_too_long = mapping_.size() > content_bytes_;
  unmap();
  if (is_too_long && ftruncate(descriptor_, static_cast<off_t>(content_bytes_)) != 0) {
    fail(errno);
    return false;
  }
  if (descriptor_ == kStandardOutput || !is_wanted()) return true;
  const int descriptor = descriptor_;
  descriptor_ = -1;
  if (close(descriptor) != 0) {
    fail(errno);
    return false;
  }
  if (target_.empty()) return true;
  if (std::rename(beside_.c_str(), target_.c_str()) != 0) {
    fail(errno);
    return false;
  }
  disarm_cleanup(cleanup_slot_);
  cleanup_slot_ = -1;
  beside_.clear();
  return true;
}

void AtomicFile::fail(int error_number) {
  const std::string name = path_ == "-" ? "standard output" : "'" + path_ + "'";
  error_ = "cannot write " + name + ": " + std::strerror(error_number);
  std::error_code ignored;
  const std::filesystem::path folder = std::filesystem::path(path_).parent_path();
  if (error_number == ENOENT && !folder.empty() && !std::filesystem::exists(folder, ignored))
    error_ += " (its directory does not exist; make it first)";
  if (error_number == EISDIR) error_ += " (name a file inside it)";
  discard();
}

void AtomicFile::discard() {
  unmap();
  if (descriptor_ > kStandardOutput) close(descriptor_);
  descriptor_ = -1;
  if (!beside_.empty()) unlink(beside_.c_str());
  beside_.clear();
  disarm_cleanup(cleanup_slot_);
  cleanup_slot_ = -1;
}

void forget_unfinished_files() {
  for (CleanupSlot& slot : cleanup_slots)
    slot.armed = slot.taken = false;
}

bool is_stream(const std::string& path) {
  if (path == "-") return true;
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) return false;
  return !S_ISREG(status.st_mode) || is_standard_output(status);
}

bool is_same_file(const std::string& a, const std::string& b) {
  std::error_code ignored;
  return std::filesystem::equivalent(a, b, ignored) && !ignored;
}

}  // namespace fdcg::tools
