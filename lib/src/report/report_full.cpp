// SPDX-License-Identifier: Apache-2.0
// The JSON report with every element. Findings are buffered per rule, since rules run concurrently and the counts, which
// precede the elements, are known only at the end.
#include <cstdio>
#include <utility>

#include "report/report_json.hpp"
#include "report/report_parts.hpp"

namespace fdcg::bake {
namespace {

constexpr std::size_t kPileBytes = std::size_t{1} << 20;   // buffered in memory per rule; beyond it in a file
constexpr std::size_t kPieceBytes = std::size_t{1} << 18;  // written at a time

}  // namespace

// The elements of one rule, with their separators.
struct ElementSpool::Pile {
  struct CloseFile {
    void operator()(std::FILE* opened) const { std::fclose(opened); }
  };

  std::string text;  // the part not yet in the file
  std::unique_ptr<std::FILE, CloseFile> file;
  bool is_lost = false;  // the disk is full, or temporary files are impossible
  bool is_empty = true;

  void spill() {
    if (!file) file.reset(std::tmpfile());
    is_lost = is_lost || !file || std::fwrite(text.data(), 1, text.size(), file.get()) != text.size();
    text.clear();
  }
};

ElementSpool::ElementSpool() : piles_(rules().size()) {}
ElementSpool::ElementSpool(ElementSpool&&) noexcept = default;
ElementSpool& ElementSpool::operator=(ElementSpool&&) noexcept = default;
ElementSpool::~ElementSpool() = default;

void ElementSpool::add(std::string_view rule, const Element& element) {
  constexpr std::string_view kBetween = ",\n      ";  // as JsonWriter sets the items of an issue's list
  Pile& pile = piles_[static_cast<std::size_t>(find_rule(rule) - rules().data())];
  if (!pile.is_empty) pile.text += kBetween;
  pile.is_empty = false;
  JsonWriter json(pile.text);
  write_json_element(json, element);
  if (pile.text.size() > kPileBytes) pile.spill();
}

struct FullReportWriter::Document {
  explicit Document(Write to) : write(std::move(to)) { begin_json_document(json); }

  void flush() {
    write(buffer);
    buffer.clear();
  }
  // False where reading the file back fails.
  bool append(ElementSpool::Pile& pile) {
    if (pile.is_lost) return false;
    bool is_first = true;
    if (pile.file) {
      pile.spill();
      if (pile.is_lost || std::fflush(pile.file.get()) != 0 || std::fseek(pile.file.get(), 0, SEEK_SET) != 0) return false;
      std::string piece(kPieceBytes, '\0');
      while (const std::size_t got = std::fread(piece.data(), 1, piece.size(), pile.file.get())) {
        append_piece(std::string_view(piece).substr(0, got), std::exchange(is_first, false));
      }
      return std::ferror(pile.file.get()) == 0;
    }
    append_piece(pile.text, true);
    return true;
  }
  void append_piece(std::string_view piece, bool is_first) {
    if (is_first) {
      json.splice(piece);
    } else {
      buffer += piece;
    }
    flush();
  }

  Write write;
  std::string buffer;
  JsonWriter json{buffer};
};

FullReportWriter::FullReportWriter(Write write) : document_(std::make_unique<Document>(std::move(write))) {}
FullReportWriter::~FullReportWriter() = default;

bool FullReportWriter::add(const Report& report, ElementSpool& spool) {
  bool is_whole = true;
  write_json_file(document_->json, report, [&](const Issue& issue) {
    const Rule* const rule = find_rule(issue.rule);
    if (rule != nullptr)
      is_whole = document_->append(spool.piles_[static_cast<std::size_t>(rule - rules().data())]) && is_whole;
  });
  document_->flush();
  return is_whole;
}

void FullReportWriter::finish() {
  end_json_document(document_->json, document_->buffer);
  document_->flush();
}

}  // namespace fdcg::bake
