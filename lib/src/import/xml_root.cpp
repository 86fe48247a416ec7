// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <string_view>

#include "import/soup_reader.hpp"

namespace fdcg::bake {
namespace {

constexpr std::size_t kLooked = 65'536;  // bytes, before the first element

// Of UTF-16 the bytes that are not zero: what stands before the root is ASCII but for comments, which do not matter.
std::string plain_start(std::string_view bytes) {
  std::string text(bytes.substr(0, kLooked));
  if (!text.starts_with("\xFF\xFE") && !text.starts_with("\xFE\xFF"))
    return text.starts_with("\xEF\xBB\xBF") ? text.substr(3) : text;
  text.erase(0, 2);
  std::erase(text, '\0');
  return text;
}

}  // namespace

std::string xml_root_name(std::string_view bytes) {
  constexpr std::string_view kBlanks = " \t\r\n";
  const bool is_marked = bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF") || bytes.starts_with("\xEF\xBB\xBF");
  const std::size_t begin = bytes.find_first_not_of(kBlanks);
  if (!is_marked && (begin == std::string_view::npos || bytes[begin] != '<')) return {};
  const std::string text = plain_start(bytes);
  std::size_t at = 0;
  for (;;) {
    at = text.find_first_not_of(kBlanks, at);
    if (at == std::string::npos || text[at] != '<') return {};
    const std::string_view rest = std::string_view(text).substr(at);
    const char* const end = rest.starts_with("<!--") ? "-->"
                            : rest.starts_with("<?") ? "?>"
                            : rest.starts_with("<!") ? ">"
                                                     : nullptr;
    if (end == nullptr) break;
    const std::size_t subset = rest.starts_with("<!DOCTYPE") ? text.find_first_of("[>", at) : std::string::npos;
    if (subset != std::string::npos && text[subset] == '[') at = text.find(']', subset);  // declarations of its own
    if (at != std::string::npos) at = text.find(end, at);
    if (at == std::string::npos) return {};
    at = text.find('>', at) + 1;
  }
  const std::size_t last = std::min(text.find_first_of(" \t\r\n/>", at), text.size());
  const std::string name = text.substr(at + 1, last - at - 1);
  const std::size_t colon = name.find(':');
  return colon == std::string::npos ? name : name.substr(colon + 1);
}

}  // namespace fdcg::bake
