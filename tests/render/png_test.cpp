#include "render/png.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "lcmtypes/error.h"
#include "motion/kinematics/random.h"
#include "render/figure_writer.h"
#include "tests/render/picture.h"

namespace waverig::render {
namespace {

Image noise_image(int width, int height) {
  RandomStream random(9, "png");
  Image image{width, height, {}};
  for (int i = 0; i < 4 * width * height; ++i)
    image.rgba.push_back(i % 4 == 3 ? 255 : static_cast<std::uint8_t>(random.bits()));
  return image;
}

TEST(Png, IsReadBackByLibpngWithoutLoss) {
  PngEncoder encoder;
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(37, 5), std::pair(640, 480)}) {
    const Image image = noise_image(width, height);
    const test::DecodedPng decoded = test::decode_png(encoder.encode(image, {}));
    EXPECT_EQ(decoded.image.width_px, width);
    EXPECT_EQ(decoded.image.rgba, image.rgba);
  }
}

TEST(Png, CarriesResolutionAndText) {
  PngEncoder encoder;
  const test::DecodedPng decoded = test::decode_png(encoder.encode(
      noise_image(4, 4), {.dots_per_inch = 300, .text = {{"Seed", "2014"}, {"Title", "파고 \u03B1"}}}));
  EXPECT_NEAR(decoded.dots_per_inch, 300, 0.02);
  EXPECT_EQ(decoded.text.at("Seed"), "2014");
  EXPECT_EQ(decoded.text.at("Title"), "파고 \u03B1");
}

TEST(Png, TellsWhereAFigureComesFrom) {
  Canvas canvas;
  const test::DecodedPng decoded = test::decode_png(png_bytes(
      {.title = "Heave", .width_mm = 40, .height_mm = 30}, canvas, {"1.2.3", "waverig sweep x.toml", "77"}));
  EXPECT_EQ(decoded.text.at("Title"), "Heave");
  EXPECT_EQ(decoded.text.at("Software"), "waverig 1.2.3");
  EXPECT_EQ(decoded.text.at("Command"), "waverig sweep x.toml");
  EXPECT_EQ(decoded.text.at("Seed"), "77");
  EXPECT_NEAR(decoded.dots_per_inch, 200, 0.02);
}

TEST(Png, SaysWhichFileCannotBeWritten) {
  try {
    write_file("/nowhere/at/all.png", "x", 1);
    FAIL();
  } catch (const UserError& error) {
    EXPECT_NE(std::string(error.what()).find("/nowhere/at/all.png"), std::string::npos);
  }
}

TEST(Png, KeepsTheFileOfBeforeWhereTheNextDoesNotFit) {
  const test::TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "a.png";
  write_file(path, "before", 6);
  struct rlimit before {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const struct rlimit small { 1000, before.rlim_max };
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string large(100000, 'x');
  EXPECT_THROW(write_file(path, large.data(), large.size()), std::runtime_error);
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(std::filesystem::file_size(path), 6U);
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& file : std::filesystem::directory_iterator(folder.path())) ++files;
  EXPECT_EQ(files, 1U);
}

}  // namespace
}  // namespace waverig::render
