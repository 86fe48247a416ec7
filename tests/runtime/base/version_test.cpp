// SPDX-License-Identifier: Apache-2.0
#include <set>
#include <string>

#include "catch.hpp"
#include "fdcg/fdcg.h"

TEST_CASE("the linked library returns the version of its headers") {
  CHECK(fdcg_version() == FDCG_VERSION);
  CHECK(FDCG_VERSION_STRING == std::to_string(FDCG_VERSION / 10000) + "." + std::to_string(FDCG_VERSION / 100 % 100) + "." +
                                   std::to_string(FDCG_VERSION % 100));
}

TEST_CASE("every status has a distinct text, and an invalid number has one too") {
  std::set<std::string> texts;
  for (int status = FDCG_OK; status <= FDCG_E_MEMORY; ++status)
    texts.insert(fdcg_status_text(static_cast<fdcg_status>(status)));
  CHECK(texts.size() == FDCG_E_MEMORY + 1);
  CHECK(texts.count(fdcg_status_text(static_cast<fdcg_status>(15))) == 0);
  for (const std::string& text : texts)
    CHECK(text.find('\n') == std::string::npos);
}
