// SPDX-License-Identifier: Apache-2.0
// Output that appears whole or not at all: written beside its target and renamed onto it.
#pragma once

#include <atomic>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <thread>

namespace fdcg::tools {

// An output named by the user. "-" is standard output, and so is any name of the same file; a device or a pipe is written
// straight; a symbolic link stays a link and its target is replaced. Until commit() nothing is seen under the name, and what
// was there before stays as it was: the file beside it is removed by the destructor, by a failure, and when a signal that can
// be caught ends the program. Errors stick: after the first one write() does nothing and commit() returns false. Without a name
// there is no output: what is written is dropped, and commit() succeeds.
class AtomicFile {
 public:
  // Opens now, so that an unwritable target is known before the work is done. `unfinished`: the name, on the same file system,
  // that a new file has until commit(); default: the target's, with .part- and the process behind it.
  explicit AtomicFile(std::string path, std::string unfinished = {});
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  [[nodiscard]] bool is_wanted() const { return !path_.empty(); }
  [[nodiscard]] bool ok() const { return error_.empty(); }
  [[nodiscard]] const std::string& error() const { return error_; }  // one line: the path, what went wrong
  void write(std::string_view bytes);
  // Begins, beside the caller's work, to make room for about so many bytes that map() will ask for: the system then has the
  // pages ready. A wrong guess costs time only.
  void expect(std::size_t bytes);
  // The whole content as memory to be filled, zeroed, instead of write(); the space is there. Empty where the output is no
  // file of its own (standard output, a device), where the file system cannot, and after a failure.
  [[nodiscard]] std::span<std::byte> map(std::size_t bytes);
  bool commit();  // true: every byte has reached the file system under its name

 private:
  int open_target();  // 0, or an errno
  int open_beside();
  void fail(int error_number);
  void discard();
  void unmap();

  std::string path_;  // as the user gave it
  std::string unfinished_;
  std::string target_;  // what is renamed onto; empty where the output is written straight
  std::string beside_;
  std::string error_;
  void make_room(std::size_t bytes);

  std::span<std::byte> mapping_;   // of the file, perhaps longer than its content
  std::size_t content_bytes_ = 0;  // of a mapped file
  std::thread room_maker_;
  std::atomic<bool> is_room_wanted_{false};
  int descriptor_ = -1;
  int cleanup_slot_ = -1;
};

// In a process that was forked: a signal that ends it leaves the other's unfinished files alone.
void forget_unfinished_files();

// What is written under this name comes out where another program reads it as it comes: "-", standard output under another
// name, a pipe, a device. Nothing else may be printed there.
bool is_stream(const std::string& path);

// Both name one existing file, however they are spelt.
bool is_same_file(const std::string& a, const std::string& b);

}  // namespace fdcg::tools
