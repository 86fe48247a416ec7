// SPDX-License-Identifier: Apache-2.0
#include "raw_data.hpp"

#include <zlib.h>

#include <bit>
#include <filesystem>
#include <stdexcept>

namespace fdcg::test {
namespace {

static_assert(std::endian::native == std::endian::little, "the file's floats are little-endian");

class Gzip {
 public:
  explicit Gzip(std::string path) : path_(std::move(path)), file_(gzopen(path_.c_str(), "wb4")) { check(file_ != nullptr); }
  ~Gzip() {
    if (file_ != nullptr) gzclose(file_);
  }
  Gzip(const Gzip&) = delete;
  Gzip& operator=(const Gzip&) = delete;

  void text(const std::string& line) { check(gzwrite(file_, line.data(), static_cast<unsigned>(line.size())) > 0); }
  void floats(const std::vector<float>& values) {
    const auto bytes = static_cast<unsigned>(values.size() * sizeof(float));
    if (bytes > 0) check(gzwrite(file_, values.data(), bytes) == static_cast<int>(bytes));
  }
  void close() {
    gzFile file = file_;
    file_ = nullptr;
    check(gzclose(file) == Z_OK);
  }

 private:
  void check(bool is_good) const {
    if (!is_good) throw std::runtime_error(path_ + ": cannot be written; is the disk full, the folder there and yours?");
  }
  std::string path_;
  gzFile file_;
};

std::string quoted(const std::string& word) {  // of letters, digits, _
  return "\"" + word + "\"";
}

std::string head(const RawWay& way, std::size_t ticks, int rounds, const std::vector<std::uint32_t>& cold_ticks,
                 const std::vector<RawContender>& contenders) {
  std::string text = R"({"format": "fdcg-raw 1", "body": )" + quoted(way.body) + R"(, "faces": )" + std::to_string(way.faces) +
                     R"(, "way": )" + quoted(way.way) + R"(, "seed": )" + std::to_string(way.seed) + R"(, "ticks": )" +
                     std::to_string(ticks) + R"(, "rounds": )" + std::to_string(rounds) + R"(, "swept_bytes": )" +
                     std::to_string(swept_bytes()) + R"(, "cold_ticks": [)";
  for (std::size_t i = 0; i < cold_ticks.size(); ++i)
    text += (i > 0 ? ", " : "") + std::to_string(cold_ticks[i]);
  text += R"(], "contenders": [)";
  for (std::size_t e = 0; e < contenders.size(); ++e) {
    text += (e > 0 ? R"(, {"name": )" : R"({"name": )") + quoted(contenders[e].name) + R"(, "family": )" +
            quoted(contenders[e].family) + R"(, "control": )" + (contenders[e].is_control ? "true}" : "false}");
  }
  return text + "]}\n";
}

}  // namespace

void write_raw(const std::string& folder, const RawWay& way, const std::vector<TrueBody::Tick>& truth,
               const std::vector<std::uint32_t>& cold_ticks, const std::vector<RawContender>& contenders,
               const std::vector<Timing>& timings) {
  const std::filesystem::path raw = std::filesystem::path(folder) / "raw";
  std::filesystem::create_directories(raw);
  Gzip file((raw / (way.body + "." + way.way + "." + std::to_string(way.seed) + ".raw.gz")).string());
  file.text(head(way, truth.size(), timings[0].rounds, cold_ticks, contenders));
  std::vector<float> contact, tied;
  for (const TrueBody::Tick& tick : truth) {
    contact.push_back(tick.feel.in_contact);
    tied.push_back(tick.others.empty() ? 0 : 1);
  }
  file.floats(contact);
  file.floats(tied);
  for (std::size_t e = 0; e < contenders.size(); ++e) {
    file.floats(timings[e].tick_ns);
    file.floats(contenders[e].is_control ? std::vector<float>(truth.size(), 0) : contenders[e].error_m);
    file.floats(timings[e].cold_ns);
  }
  file.close();
}

}  // namespace fdcg::test
