// SPDX-License-Identifier: Apache-2.0
#include "profile/profile.hpp"

namespace fdcg::dev {

int bytes_of(NumberType type) {
  switch (type) {
    case NumberType::kU8:
    case NumberType::kI8:
      return 1;
    case NumberType::kU16:
    case NumberType::kI16:
      return 2;
    case NumberType::kU32:
    case NumberType::kI32:
    case NumberType::kF32:
      return 4;
  }
  return 0;
}

}  // namespace fdcg::dev
