// SPDX-License-Identifier: Apache-2.0
// How many instructions a piece of work is: the same number on every run, whatever else the machine does.
#pragma once

#include <cstdint>

#if defined(__x86_64__) && defined(__linux__)
#define FDCG_COUNTS_INSTRUCTIONS 1
#include <csignal>

#include <ucontext.h>
#else
#define FDCG_COUNTS_INSTRUCTIONS 0
#endif

namespace fdcg::test {

#if FDCG_COUNTS_INSTRUCTIONS

namespace detail {
constexpr long long kTrapFlag = 0x100;
inline volatile std::uint64_t traps, most_traps;
inline void count_trap(int, siginfo_t*, void* context) {
  traps = traps + 1;
  if (traps > most_traps) static_cast<ucontext_t*>(context)->uc_mcontext.gregs[REG_EFL] &= ~kTrapFlag;
}
// Sets or clears the trap flag: with it the processor stops after every instruction. The stack below the pointer may be in use.
[[gnu::noinline]] inline void set_trap_flag() {
  asm volatile("lea -128(%%rsp), %%rsp\n\tpushfq\n\torq $0x100, (%%rsp)\n\tpopfq\n\tlea 128(%%rsp), %%rsp" ::: "cc", "memory");
}
[[gnu::noinline]] inline void clear_trap_flag() {
  asm volatile("lea -128(%%rsp), %%rsp\n\tpushfq\n\tandq $-257, (%%rsp)\n\tpopfq\n\tlea 128(%%rsp), %%rsp" ::: "cc", "memory");
}
template <class Work>
std::uint64_t traps_of(Work work) {
  traps = 0;
  set_trap_flag();
  work();
  clear_trap_flag();
  return traps;
}
}  // namespace detail

// Instructions of `work`, single-stepped: some microseconds each, so no more than `most` (and a few) are counted.
template <class Work>
std::uint64_t instructions_of(Work work, std::uint64_t most) {
  struct sigaction ours = {}, before = {};
  ours.sa_sigaction = detail::count_trap;
  ours.sa_flags = SA_SIGINFO;
  detail::most_traps = most;
  sigaction(SIGTRAP, &ours, &before);
  const std::uint64_t nothing = detail::traps_of([] {});
  const std::uint64_t all = detail::traps_of(work);
  sigaction(SIGTRAP, &before, nullptr);
  return all - nothing;
}

#else

template <class Work>
std::uint64_t instructions_of(Work, std::uint64_t) {
  return 0;
}

#endif

}  // namespace fdcg::test
