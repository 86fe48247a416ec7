// SPDX-License-Identifier: Apache-2.0
#include "base/message.hpp"

namespace fdcg {

#if FDCG_WITH_MESSAGES

Message::Message(fdcg_error* error, fdcg_status status, uint64_t offset) : error_(error), status_(status) {
  if (error_ == nullptr) return;
  error_->status = status;
  error_->offset = offset;
  error_->message[0] = '\0';
}

void Message::put(char c) {
  if (error_ == nullptr || used_ + 1 >= sizeof error_->message) return;
  error_->message[used_++] = c;
  error_->message[used_] = '\0';
}

Message& Message::text(const char* words) {
  while (*words != '\0')
    put(*words++);
  return *this;
}

Message& Message::quoted(const char* words, int limit) {
  put('\'');
  for (int i = 0; i < limit && words[i] != '\0'; ++i)
    put(words[i]);
  put('\'');
  return *this;
}

Message& Message::number(uint64_t value) {
  char digits[20];
  int count = 0;
  do {
    digits[count++] = static_cast<char>('0' + value % 10);
    value /= 10;
  } while (value != 0);
  while (count > 0)
    put(digits[--count]);
  return *this;
}

Message& Message::real(double value) {
  if (value != value) return text("NaN");
  if (value < 0) {
    put('-');
    value = -value;
  }
  if (value > 1e300) return text("infinite");
  int exponent = 0;
  const bool has_exponent = value != 0 && (value >= 1e6 || value < 1e-3);
  if (has_exponent) {
    for (; value >= 10; value /= 10)
      ++exponent;
    for (; value < 1; value *= 10)
      --exponent;
  }
  auto millionths = static_cast<uint64_t>(value * 1e6 + 0.5);
  if (has_exponent && millionths >= 10000000) {  // by rounding: 1e-12, not 10e-13
    millionths /= 10;
    ++exponent;
  }
  number(millionths / 1000000);
  uint64_t rest = millionths % 1000000;
  if (rest != 0) put('.');
  for (uint64_t unit = 100000; rest != 0; unit /= 10) {
    put(static_cast<char>('0' + rest / unit));
    rest %= unit;
  }
  if (exponent != 0) {
    text(exponent < 0 ? "e-" : "e");
    number(static_cast<uint64_t>(exponent < 0 ? -exponent : exponent));
  }
  return *this;
}

fdcg_status refuse(fdcg_error* error, fdcg_status status, const char* what) {
  return Message(error, status).text(what);
}

fdcg_status refuse(fdcg_error* error, const char* what) {
  return refuse(error, FDCG_E_ARGUMENT, what);
}

fdcg_status refuse(fdcg_error* error, const char* field, double value, double low, double high) {
  return Message(error, FDCG_E_ARGUMENT)
      .text(field)
      .text(" is ")
      .real(value)
      .text(", allowed ")
      .real(low)
      .text(" to ")
      .real(high);
}

#else

fdcg_status refuse_silently_at(uint64_t offset, fdcg_error* error, fdcg_status status) {
  if (error == nullptr) return status;
  error->status = status;
  error->offset = offset;
  const char* words = FDCG_WITH_STATUS_TEXTS ? fdcg_status_text(status) : "";
  uint32_t length = 0;
  for (; words[length] != '\0' && length + 1 < sizeof error->message; ++length)
    error->message[length] = words[length];
  error->message[length] = '\0';
  return status;
}

fdcg_status refuse_silently(fdcg_error* error, fdcg_status status) {
  return refuse_silently_at(0, error, status);
}

#endif

}  // namespace fdcg
