// SPDX-License-Identifier: Apache-2.0
#include "base/sha256.hpp"

#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <memory>
#include <system_error>

#include "base/file_bytes.hpp"
#include "fdcg/results.hpp"

namespace fdcg::bake {

std::string sha256_of(std::string_view bytes) {
  return Sha256Task(bytes).finish();
}

Result<std::string> sha256_of_file(const std::filesystem::path& path) {
  const Result<FileBytes> file = FileBytes::open(path);
  if (!file) return file.error();
  return sha256_of(file->bytes());
}

Sha256Task::Sha256Task(std::string_view bytes) : bytes_(bytes) {
  constexpr std::size_t kWorthAThread = std::size_t{1} << 18;  // some 0.2 ms; a thread costs a tenth of that
  if (bytes.size() >= kWorthAThread) {
    try {
      thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
      return;
    } catch (const std::system_error&) {  // no thread available: compute in this one
    }
  }
  run({});
}

std::string Sha256Task::finish() {
  if (thread_.joinable()) thread_.join();
  return hex_;
}

void Sha256Task::run(const std::stop_token& stop) {
  constexpr std::size_t kStep = std::size_t{1} << 22;  // bytes between two checks for cancellation
  const std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context(EVP_MD_CTX_new(), &EVP_MD_CTX_free);
  if (!context || EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr) != 1) return;
  for (std::string_view rest = bytes_; !rest.empty(); rest.remove_prefix(std::min(kStep, rest.size()))) {
    if (stop.stop_requested()) return;
    if (EVP_DigestUpdate(context.get(), rest.data(), std::min(kStep, rest.size())) != 1) return;
  }
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned length = 0;
  if (EVP_DigestFinal_ex(context.get(), digest.data(), &length) != 1) return;
  constexpr std::string_view kDigits = "0123456789abcdef";
  for (unsigned i = 0; i < length; ++i) {
    hex_ += kDigits[digest[i] >> 4];
    hex_ += kDigits[digest[i] & 15];
  }
}

}  // namespace fdcg::bake
