// SPDX-License-Identifier: Apache-2.0
// A package as it is, or XML, which becomes the model of one, and what follows a zero byte in it a second part: so that the
// mutations need not keep the archive right. COLLADA becomes the scene of a .zae.
#include <algorithm>
#include <string>

#include "fuzz_import.hpp"
#include "zip_writer.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  // What unpacks to more than it is may take as much as the limit on it allows.
  constexpr std::size_t kUnpacked = std::size_t{1} << 18, kEachByte = 100;
  // libzip keeps 32 bytes for each of the 2^16 entries that an archive may claim, before it looks for them.
  constexpr std::size_t kLibrary = (std::size_t{1} << 18) + (std::size_t{1} << 21);
  constexpr std::size_t kMultiple = fdcg::bake::kSceneMultiple;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (text.starts_with("PK")) {
    return fdcg::bake::fuzz_import(fdcg::bake::Format::threemf, data, size, kEachByte * kMultiple,
                                   kLibrary + kUnpacked * kMultiple);
  }
  if (text.find("<COLLADA") != std::string_view::npos) {
    const std::string archive = fdcg::test::stored_zip({{"scene.dae", std::string(text)}});
    return fdcg::bake::fuzz_import(fdcg::bake::Format::threemf, reinterpret_cast<const unsigned char*>(archive.data()),
                                   archive.size(), kMultiple, kLibrary);
  }
  const std::size_t cut = std::min(text.find('\0'), text.size());
  const std::string package =
      fdcg::test::stored_zip({{"3D/3dmodel.model", std::string(text.substr(0, cut))},
                              {"3D/a.model", cut < text.size() ? std::string(text.substr(cut + 1)) : std::string()}});
  return fdcg::bake::fuzz_import(fdcg::bake::Format::threemf, reinterpret_cast<const unsigned char*>(package.data()),
                                 package.size(), kMultiple, kLibrary);
}
