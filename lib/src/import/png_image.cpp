// SPDX-License-Identifier: Apache-2.0
#include "import/png_image.hpp"

#include <png.h>

#include <csetjmp>
#include <cstring>

#include "import/soup_reader.hpp"

namespace fdcg::bake {
namespace {

constexpr std::uint32_t kMostSide = 16384;
constexpr png_alloc_size_t kMostChunkBytes = 1 << 20;

struct Source {
  std::string_view rest;
  char message[128] = {};
};

[[noreturn]] void give_up(png_structp png, png_const_charp message) {
  auto* const source = static_cast<Source*>(png_get_error_ptr(png));
  std::strncpy(source->message, message, sizeof source->message - 1);
  std::longjmp(png_jmpbuf(png), 1);
}

void ignore_warning(png_structp, png_const_charp) {}

void take(png_structp png, png_bytep to, std::size_t count) {
  auto* const source = static_cast<Source*>(png_get_io_ptr(png));
  if (count > source->rest.size()) png_error(png, "it ends early");
  std::memcpy(to, source->rest.data(), count);
  source->rest.remove_prefix(count);
}

// One libpng reader. Its functions leave by longjmp, past nothing that has a destructor.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : source_{bytes, {}} {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, &source_, give_up, ignore_warning);
    if (png_ != nullptr) info_ = png_create_info_struct(png_);
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
  ~Reader() { png_destroy_read_struct(&png_, &info_, nullptr); }

  [[nodiscard]] bool is_ready() const { return info_ != nullptr; }
  [[nodiscard]] const char* message() const { return source_.message; }

  bool read_header(PngImage& image) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_set_read_fn(png_, &source_, take);
    png_set_user_limits(png_, kMostSide, kMostSide);
    png_set_chunk_malloc_max(png_, kMostChunkBytes);
    png_read_info(png_, info_);
    image.width = png_get_image_width(png_, info_);
    image.height = png_get_image_height(png_, info_);
    image.bits = png_get_bit_depth(png_, info_) == 16 ? 16 : 8;
    png_set_expand(png_);  // palettes, few bits, transparency of one colour
    png_set_strip_alpha(png_);
    png_set_expand_16(png_);
    png_set_swap(png_);  // the file's numbers have the highest byte first
    passes_ = png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    image.channels = png_get_channels(png_, info_);
    return true;
  }
  bool read_rows(PngImage& image) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    const std::size_t each = std::size_t{image.width} * image.channels;
    for (int pass = 0; pass < passes_; ++pass)
      for (std::size_t row = 0; row < image.height; ++row)
        png_read_row(png_, reinterpret_cast<png_bytep>(image.values.data() + row * each), nullptr);
    png_read_end(png_, nullptr);
    return true;
  }

 private:
  Source source_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  int passes_ = 1;
};

}  // namespace

Result<PngImage> read_png(std::string_view bytes, const std::string& name, std::uint64_t most_texels) {
  Reader reader(bytes);
  if (!reader.is_ready()) return Failure{3, name + ": no memory to read the image", {}};
  PngImage image;
  const auto damaged = [&] {
    return refuse(name, std::string("is no PNG image that can be read (") + reader.message() + "); save it as PNG again");
  };
  if (!reader.read_header(image)) return damaged();
  if (std::uint64_t{image.width} * image.height > most_texels)
    return refuse(name, "has " + std::to_string(image.width) + " x " + std::to_string(image.height) + " texels, more than " +
                            std::to_string(most_texels) + "; make it smaller");
  if (image.channels != 1 && image.channels != 3) return refuse(name, "is neither grey nor in colour; save it as PNG again");
  image.values.resize(std::size_t{image.width} * image.height * image.channels);
  if (!reader.read_rows(image)) return damaged();
  return image;
}

}  // namespace fdcg::bake
