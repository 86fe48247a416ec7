// SPDX-License-Identifier: Apache-2.0
#include "import/height_image.hpp"

#include <utility>

#include "base/file_bytes.hpp"
#include "import/beside.hpp"
#include "import/png_image.hpp"
#include "import/soup_reader.hpp"

namespace fdcg::bake {

std::optional<Failure> read_height_image(std::string_view png, HeightImage& image) {
  constexpr double kWhite = 65535;
  const Result<PngImage> read = read_png(png, image.name);
  if (!read) return read.error();
  image.width = read->width;
  image.height = read->height;
  image.values.resize(std::size_t{image.width} * image.height);
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    double sum = 0;
    for (std::uint32_t c = 0; c < read->channels; ++c)
      sum += read->values[i * read->channels + c];
    image.values[i] = static_cast<float>(sum / (kWhite * read->channels));
  }
  return std::nullopt;
}

std::optional<Failure> read_height_image_beside(const std::filesystem::path& mesh, HeightImage& image,
                                                std::vector<std::string>& files) {
  const std::filesystem::path path = mesh.parent_path() / image.name;
  std::error_code error;
  if (!stays_beneath(image.name, image.name) ||
      (std::filesystem::exists(path, error) && !lies_beneath(path, mesh.parent_path())))
    return refuse(mesh.string(), "names the image of heights '" + readable_name(image.name) +
                                     "', which is not beneath its folder; put the image there, or name it with --heights");
  const Result<FileBytes> file = FileBytes::open(path, "an image");
  if (!file) return file.error();
  files.push_back(path.string());
  return read_height_image(file->bytes(), image);
}

std::optional<Failure> add_heights_for_all(const std::string& path, PolygonSoup& soup) {
  const Result<FileBytes> file = FileBytes::open(path, "an image");
  if (!file) return file.error();
  HeightImage image;
  image.name = path;
  if (auto failure = read_height_image(file->bytes(), image)) return failure;
  soup.appearance.all_heights = static_cast<std::uint16_t>(soup.appearance.images.size());
  soup.appearance.images.push_back(std::move(image));
  soup.other_files.push_back(path);
  return std::nullopt;
}

}  // namespace fdcg::bake
