// SPDX-License-Identifier: Apache-2.0
// fdcg_stress: runs the step on every case of stress_case.hpp, judges every tick, and says how to repeat what fails.
// Over 400 lines: the table's columns and the bars are lists.
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "minimise.hpp"
#include "program_options.hpp"
#include "reproducer.hpp"
#include "stress_mesh.hpp"
#include "stress_run.hpp"
#include "table.hpp"

using namespace fdcg::test;
using fdcg::bake::Precision;

namespace {

using Clock = std::chrono::steady_clock;

constexpr double kQuickSteps = 9e5, kFullSteps = 1.2e7;
constexpr int kMostReproducers = 3;  // of each case, precision and fault

struct Options {
  bool is_quick = false;
  std::string output = "stress";
  std::uint64_t seed = 1;
  double steps = 0;
  unsigned threads = 1;
  std::string only, mesh;
  std::string precision;
  std::int64_t block = -1;
  Variation variation;
  std::string minimise, replay;
  bool lists = false, stops = false;
};

// A row of the table: one case in one precision.
struct Row {
  const StressCase* stress_case;
  Precision precision;
  std::uint64_t first_block = 0, end_block = 0;
};

const char* name_of(Precision precision) {
  return precision == Precision::f64 ? "f64" : "f32";
}
unsigned long long n(std::uint64_t count) {
  return count;
}
double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

// Writes what is found, at most a few of each kind, and says how to repeat it.
class Findings {
 public:
  Findings(const Options& options, std::string program)
      : folder_(options.output), mesh_(options.mesh), program_(std::move(program)), stops_(options.stops) {
    const Variation& v = options.variation;
    if (v.is_frictionless) variation_ += " --frictionless";
    if (v.stretch != 1) variation_ += " --stretch " + std::to_string(v.stretch) + " --axis " + std::to_string(v.axis);
  }

  void add(const Finding& f) {
    const std::lock_guard lock(mutex_);
    const std::string kind = std::string(f.name.stress_case->name) + "-" + name_of(f.name.precision) + "-" +
                             std::string(fdcg::test::name_of(f.fault));
    int& count = written_[kind];
    if (count == kMostReproducers) return;
    ++count;
    const std::string file = folder_ + "/" + kind + "-" + std::to_string(count) + ".obj";
    const std::string what = mesh_.empty() ? " --case " + std::string(f.name.stress_case->name) : " --mesh " + mesh_;
    const std::string command = program_ + " --seed " + std::to_string(f.name.seed) + what + " --precision " +
                                name_of(f.name.precision) + " --block " + std::to_string(f.name.block) + variation_;
    std::printf("FOUND %s at tick %llu of %s, extent %g\n      repeat: %s\n      file: %s\n", kind.c_str(), n(f.tick),
                f.specimen->body.description.c_str(), f.specimen->header().extent, command.c_str(), file.c_str());
    std::fflush(stdout);
    write_reproducer(file, {f.specimen->body, f.params, *f.path_m, f.fault, command});
    if (stops_) std::_Exit(1);
  }

 private:
  std::mutex mutex_;
  std::string folder_, mesh_, program_, variation_;
  std::map<std::string, int> written_;
  bool stops_;
};

// All rows' blocks, in turns of blocks_per_body, each turn for one worker; a row's sum is taken in its blocks' order, whoever
// ran them.
class Workers {
 public:
  Workers(const std::vector<Row>& rows, const Options& options, Findings& findings)
      : rows_(rows), options_(options), findings_(findings), results_(rows.size()), left_(rows.size()), seconds_(rows.size()) {
    for (std::size_t r = 0; r < rows.size(); ++r) {
      const std::uint64_t turn = rows[r].stress_case->blocks_per_body;
      results_[r].resize(rows[r].end_block - rows[r].first_block);
      for (std::uint64_t begin = rows[r].first_block; begin < rows[r].end_block;) {
        const std::uint64_t end = std::min((begin / turn + 1) * turn, rows[r].end_block);
        turns_.push_back({r, begin, end});
        ++left_[r];
        begin = end;
      }
    }
    for (unsigned w = 0; w < options.threads; ++w)
      threads_.emplace_back([this] { work(); });
  }
  ~Workers() {
    for (std::thread& thread : threads_)
      thread.join();
  }
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  // Waits for a row. `seconds`: of all workers together. Throws what a worker has thrown.
  BlockResult row(std::size_t r, double* seconds) {
    std::unique_lock lock(mutex_);
    is_done_.wait(lock, [&] { return left_[r] == 0 || failure_ != nullptr; });
    if (failure_ != nullptr) std::rethrow_exception(failure_);
    BlockResult sum;
    for (const BlockResult& result : results_[r])
      sum.add(result);
    *seconds = seconds_[r];
    return sum;
  }

 private:
  struct Turn {
    std::size_t row;
    std::uint64_t begin, end;
  };

  void work() {
    try {
      while (true) {
        const std::size_t t = next_.fetch_add(1);
        if (t >= turns_.size()) return;
        run(turns_[t]);
      }
    } catch (...) {
      next_ = turns_.size();
      const std::lock_guard lock(mutex_);
      failure_ = std::current_exception();
      is_done_.notify_all();
    }
  }

  void run(const Turn& turn) {
    const auto begin = Clock::now();
    const Row& row = rows_[turn.row];
    SpecimenShelf shelf;
    for (std::uint64_t block = turn.begin; block < turn.end; ++block) {
      const BlockName name = {row.stress_case, row.precision, block, options_.seed, options_.variation};
      const auto specimen = shelf.get(name);
      if (specimen == nullptr) continue;
      results_[turn.row][block - row.first_block] = run_block(name, *specimen, [&](const Finding& f) { findings_.add(f); });
    }
    const std::lock_guard lock(mutex_);
    seconds_[turn.row] += seconds_since(begin);
    if (--left_[turn.row] == 0) is_done_.notify_all();
  }

  const std::vector<Row>& rows_;
  const Options& options_;
  Findings& findings_;
  std::vector<Turn> turns_;
  std::vector<std::vector<BlockResult>> results_;
  std::vector<std::size_t> left_;  // turns of each row
  std::vector<double> seconds_;
  std::atomic<std::size_t> next_ = 0;
  std::mutex mutex_;
  std::condition_variable is_done_;
  std::exception_ptr failure_;
  std::vector<std::thread> threads_;
};

void say_what_is_not_judged(const std::string& mesh, const std::vector<Row>& rows) {
  std::map<std::string, std::string> numbers;  // by reason
  for (const Row& row : rows) {
    const std::string& why = fdcg::test::why_no_inside(row.precision);
    if (!why.empty()) numbers[why] += (numbers[why].empty() ? "" : ", ") + std::string(name_of(row.precision));
  }
  for (const auto& [why, in] : numbers)
    std::printf("%s: %s (%s): what is inside is not judged\n", mesh.c_str(), why.c_str(), in.c_str());
}

std::vector<Row> rows_of(const Options& options) {
  std::vector<Row> rows;
  const auto add = [&](const StressCase& c) {
    for (const Precision precision : {Precision::f64, Precision::f32}) {
      if (options.precision.empty() || options.precision == name_of(precision)) rows.push_back({&c, precision});
    }
  };
  if (!options.mesh.empty()) {
    add(mesh_case(options.mesh));
    say_what_is_not_judged(options.mesh, rows);
  } else {
    for (const StressCase& c : stress_cases()) {
      if (options.only.empty() || options.only == c.name) add(c);
    }
  }
  const double steps = options.steps > 0 ? options.steps : options.is_quick ? kQuickSteps : kFullSteps;
  double shares = 0;
  for (const Row& row : rows)
    shares += row.stress_case->share;
  for (Row& row : rows) {
    const double share = steps * row.stress_case->share / shares / kBlockTicks;
    row.end_block = std::max<std::uint64_t>(1, static_cast<std::uint64_t>(share + 0.5));
    if (options.block >= 0) {
      row.first_block = static_cast<std::uint64_t>(options.block);
      row.end_block = row.first_block + 1;
    }
  }
  return rows;
}

std::string hexadecimal(std::uint64_t x) {
  char text[20];
  std::snprintf(text, sizeof text, "%016llx", n(x));
  return text;
}

std::uint64_t count_of(const BlockResult& r, Fault fault) {
  return r.verdicts.count[static_cast<std::size_t>(fault)];
}

// Whether stress/open/list.txt has the fault: known, and not mended.
bool stands_open(const Row& row, Fault fault) {
  std::ifstream list(FDCG_STRESS_OPEN "/list.txt");
  const std::string wanted =
      std::string(row.stress_case->name) + " " + name_of(row.precision) + " " + std::string(fdcg::test::name_of(fault)) + " ";
  for (std::string line; std::getline(list, line);) {
    if (line.rfind(wanted, 0) == 0) return true;
  }
  return false;
}

// What stands open is printed and taken out of what is judged.
void pass_over_open(const Row& row, BlockResult* r) {
  for (std::size_t f = 0; f < kFaults; ++f) {
    const auto fault = static_cast<Fault>(f);
    if (r->verdicts.count[f] == 0 || !stands_open(row, fault)) continue;
    std::printf("passed over, since stress/open/list.txt has it: %llu %s\n", n(r->verdicts.count[f]),
                std::string(fdcg::test::name_of(fault)).c_str());
    r->verdicts.count[f] = 0;
    if (fault == Fault::growth) r->verdicts.worst_growth_eps = std::min(r->verdicts.worst_growth_eps, kMostGrowth_eps);
    if (fault == Fault::off_surface) {
      r->verdicts.worst_off_surface_eps = std::min(r->verdicts.worst_off_surface_eps, kMostOffSurface_eps);
    }
  }
}

void write_row(Table& table, const Row& row, const BlockResult& r, double seconds) {
  const Verdicts& v = r.verdicts;
  table.row(row.stress_case->name, row.stress_case->target, name_of(row.precision), r.ticks, r.contact_ticks, r.transitions,
            count_of(r, Fault::rule_bound) + count_of(r, Fault::sweep_bound), r.bounds_allowed, v.most_carried,
            v.worst_growth_eps, count_of(r, Fault::growth), count_of(r, Fault::push_through), count_of(r, Fault::unseen),
            count_of(r, Fault::no_force), count_of(r, Fault::thin_air), v.shallow, count_of(r, Fault::not_a_number),
            v.worst_off_surface_eps, count_of(r, Fault::off_surface), count_of(r, Fault::pull), v.worst_pull_eps,
            count_of(r, Fault::restless), v.worst_restless_eps, v.worst_inside_eps, count_of(r, Fault::descent),
            v.worst_descent_eps, count_of(r, Fault::free_air), count_of(r, Fault::report), count_of(r, Fault::force),
            count_of(r, Fault::friction), count_of(r, Fault::wrong_face), count_of(r, Fault::uncertified), v.certified,
            count_of(r, Fault::stalled), v.carried, v.slit, v.between, v.other, hexadecimal(r.hash), seconds);
}

// The case with the largest share of contact ticks whose place nothing judges.
struct Unjudged {
  double share = 0;
  std::string where = "nothing";

  void look_at(const Row& row, const BlockResult& r) {
    const auto unjudged = static_cast<double>(r.verdicts.slit + r.verdicts.between + r.verdicts.other);
    const double part = unjudged / static_cast<double>(std::max<std::uint64_t>(1, r.contact_ticks));
    if (part > share) share = part, where = std::string(row.stress_case->name) + ", " + name_of(row.precision);
  }
};

int judge_whole(const BlockResult& r, const Unjudged& unjudged, const std::string& folder) {
  Bars bars(folder, "fdcg_stress");
  const auto none = [&](const std::string& bar, std::uint64_t measured, const std::string& note = "") {
    bars.at_most(bar, static_cast<double>(measured), 0, "ticks", note);
  };
  none("bound hits outside the stated cases",
       count_of(r, Fault::rule_bound) + count_of(r, Fault::sweep_bound) - r.bounds_allowed);
  bars.at_most("growth of |GO - HIP| within a step", r.verdicts.worst_growth_eps, kMostGrowth_eps, "eps of the scale");
  none("push-through: free while inside", count_of(r, Fault::push_through),
       std::to_string(r.verdicts.shallow) + " more by less than " + std::to_string(static_cast<int>(kShallow_eps)) + " eps");
  none("ways through the surface unseen", count_of(r, Fault::unseen));
  none("inside without force at a hand's speed", count_of(r, Fault::no_force));
  none("contacts from thin air", count_of(r, Fault::thin_air));
  none("results that are not the contact's", count_of(r, Fault::report));
  none("forces that are not the spring's", count_of(r, Fault::force));
  none("ticks against Coulomb's law", count_of(r, Fault::friction));
  none("edges left for the farther face", count_of(r, Fault::wrong_face));
  none("rests without friction that are no minimum, by exact rationals", count_of(r, Fault::uncertified),
       "of " + std::to_string(r.verdicts.certified) + " asked");
  none("work carried over that gets nowhere", count_of(r, Fault::stalled));
  none("NaN or infinite results", count_of(r, Fault::not_a_number));
  bars.at_most("god-object off its feature", r.verdicts.worst_off_surface_eps, kMostOffSurface_eps, "eps of the scale");
  none("forces that pull", count_of(r, Fault::pull));
  none("held HIPs that move the god-object", count_of(r, Fault::restless));
  none("rests without friction from which a face or an edge leads nearer", count_of(r, Fault::descent),
       std::to_string(count_of(r, Fault::free_air)) + " of them with the HIP outside");
  constexpr double kMostUnjudged = 0.01;
  bars.at_most("unjudged share of a case's contact ticks", unjudged.share, kMostUnjudged, "",
               unjudged.where + "; of all, " + std::to_string(r.verdicts.slit) + " in slits, " +
                   std::to_string(r.verdicts.between) + " between sheets that meet, " + std::to_string(r.verdicts.other) +
                   " elsewhere, and " + std::to_string(r.verdicts.carried) + " carried, judged in part");
  return bars.failures();
}

void show_progress(std::size_t done, std::size_t rows, const BlockResult& whole, double seconds) {
  if (isatty(STDERR_FILENO) == 0) return;
  std::fprintf(stderr, "\r%zu of %zu rows, %.1f million ticks, %.0f s ", done, rows, static_cast<double>(whole.ticks) * 1e-6,
               seconds);
  if (done == rows) std::fputc('\n', stderr);
}

int run(const Options& options, const std::string& program) {
  std::filesystem::create_directories(options.output);
  Findings findings(options, program);
  Table table(options.output, "stress_cases",
              {"case",
               "target",
               "precision",
               "steps",
               "contact_steps",
               "transitions",
               "bound_hits",
               "bound_hits_allowed",
               "most_carried",
               "growth_worst_eps",
               "growths",
               "push_through",
               "unseen",
               "no_force",
               "thin_air",
               "shallow",
               "nan",
               "off_surface_worst_eps",
               "off_surface",
               "pulls",
               "pull_worst_eps",
               "restless",
               "restless_worst_eps",
               "inside_worst_eps",
               "descents",
               "descent_worst_eps",
               "free_air",
               "report",
               "force",
               "friction",
               "wrong_face",
               "uncertified",
               "certified",
               "stalled",
               "unjudged_carried",
               "unjudged_slit",
               "unjudged_between",
               "unjudged_other",
               "hash",
               "seconds"});
  const std::vector<Row> rows = rows_of(options);
  if (rows.empty()) {
    std::fprintf(stderr, "%s: no case is called %s; --list shows them\n", program.c_str(), options.only.c_str());
    return 2;
  }
  const auto begin = Clock::now();
  BlockResult whole;
  Unjudged unjudged;
  std::printf("seed %llu\n%-18s %-4s %11s %5s %7s %8s %9s %7s  %s\n", n(options.seed), "case", "", "ticks", "cont.", "trans.",
              "growth", "off surf.", "ns/tick", "faults");
  Workers workers(rows, options, findings);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    double seconds = 0;
    BlockResult r = workers.row(i, &seconds);
    write_row(table, rows[i], r, seconds);
    std::uint64_t faults = 0;
    for (const std::uint64_t c : r.verdicts.count)
      faults += c;
    const auto ticks = static_cast<double>(r.ticks);
    std::printf("%-18s %-4s %11llu %5.2f %7.3f %8.2f %9.2f %7.0f  %llu%s\n", std::string(rows[i].stress_case->name).c_str(),
                name_of(rows[i].precision), n(r.ticks), static_cast<double>(r.contact_ticks) / ticks,
                static_cast<double>(r.transitions) / ticks, r.verdicts.worst_growth_eps, r.verdicts.worst_off_surface_eps,
                seconds / ticks * 1e9, n(faults - r.bounds_allowed),
                r.bounds_allowed > 0 ? (", " + std::to_string(r.bounds_allowed) + " ticks carried over").c_str() : "");
    std::fflush(stdout);
    if (options.is_quick) pass_over_open(rows[i], &r);
    unjudged.look_at(rows[i], r);
    whole.add(r);
    show_progress(i + 1, rows.size(), whole, seconds_since(begin));
  }
  std::printf("%llu ticks, hash %s\n", n(whole.ticks), hexadecimal(whole.hash).c_str());
  return judge_whole(whole, unjudged, options.output) == 0 ? 0 : 1;
}

int replay(const std::string& path) {
  const Reproducer r = read_reproducer(path);
  const Specimen specimen(r.body);
  std::vector<std::string> log;
  const std::int64_t tick = first_fault(specimen, r, &log);
  constexpr std::size_t kShown = 12;  // ticks up to the fault
  for (std::size_t i = log.size() > kShown ? log.size() - kShown : 0; tick >= 0 && i < log.size(); ++i)
    std::printf("tick %zu: %s\n", i, log[i].c_str());
  if (tick < 0) {
    std::printf("%s: no %s in %zu ticks\n", path.c_str(), std::string(fdcg::test::name_of(r.fault)).c_str(), r.path_m.size());
    return 0;
  }
  std::printf("%s: %s at tick %lld\n", path.c_str(), std::string(fdcg::test::name_of(r.fault)).c_str(),
              static_cast<long long>(tick));
  return 1;
}

void list_cases() {
  for (const StressCase& c : stress_cases())
    std::printf("%-18s %s\n", std::string(c.name).c_str(), std::string(c.target).c_str());
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  ProgramOptions program(
      "Runs the step on every stress case, judges every tick, writes stress_cases.csv and fdcg_stress.bars.csv.\n"
      "Exit code 1: a bar fails; 2: wrong usage.\n"
      "Example: fdcg_stress --steps 1e9 --threads 2 --output stress\n"
      "         fdcg_stress --case tremor --precision f32 --block 7\n"
      "         fdcg_stress --minimise stress/tremor-f32-push-through-1.obj");
  program.flag("--quick", options.is_quick, "a few seconds");
  program.option("--output", options.output, "folder for the tables and reproducers");
  program.option("--seed", options.seed, "of everything; results but for times depend on it alone");
  program.option("--steps", options.steps, "how many ticks in all, shared among the cases");
  program.option("--threads", options.threads, "results do not depend on it", 1, 64);
  program.option("--case", options.only, "this one alone");
  program.option(
      "--mesh", options.mesh,
      "this mesh file, compiled as by default, in place of the cases; what is inside is not judged where it is open, its faces "
      "cross or touch, or some look inwards");
  program.choice("--precision", options.precision, "f64 or f32 alone", {"f64", "f32"});
  program.option("--block", options.block, "this block of each case alone");
  program.option("--stretch", options.variation.stretch,
                 "every body along an axis; those that the compiler then refuses are left out");
  program.option("--axis", options.variation.axis, "of --stretch: 0, 1 or 2", 0, 2);
  program.flag("--frictionless", options.variation.is_frictionless, "every contact");
  program.option("--minimise", options.minimise, "cut this reproducer down; writes FILE.small.obj and FILE.test.cpp");
  program.option("--replay", options.replay, "step this reproducer; exit code 1 if it still fails");
  program.flag("--first", options.stops, "stop at the first fault, with exit code 1");
  program.flag("--list", options.lists, "the cases");
  if (const std::optional<int> code = program.parse(argc, argv)) return *code;
  try {
    if (options.lists) return list_cases(), 0;
    if (!options.replay.empty()) return replay(options.replay);
    if (!options.minimise.empty()) return minimise_file(options.minimise);
    return run(options, argv[0]);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s: %s\n", argv[0], e.what());
    return 2;
  }
}
