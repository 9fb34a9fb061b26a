extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lcmtypes/error.h"
#include "render/figure_writer.h"
#include "render/layout.h"
#include "render/scene/film.h"
#include "tests/render/example_campaign.h"
#include "tests/render/picture.h"

namespace waverig::render {
namespace {

TEST(RigMotion, FollowsTheTruthBetweenItsSamples) {
  const evaluation::RunRecord run = test::example_run();
  const RigMotion motion(run, "");
  EXPECT_EQ(motion.method(), "harmonic") << "the nearest to the truth";
  EXPECT_NEAR(motion.radius_m(), 0.5, 1e-12);
  for (const double t : {50.0, 50.01, 63.217}) {
    const RigInstant at = motion.at(t);
    EXPECT_NEAR(at.sensor_m.x(), 0.5 * std::cos(at.arm_angle_rad), 1e-3);
    EXPECT_NEAR(at.sensor_m.z(), 0.5 * std::sin(at.arm_angle_rad), 1e-3);
    ASSERT_TRUE(at.estimated);
    EXPECT_NEAR(at.estimated_heave_m, at.sensor_m.z(), 0.01);
  }
}

TEST(RigMotion, FindsTheCrestNearATime) {
  const evaluation::RunRecord run = test::example_run();
  const RigMotion motion(run, "");
  const double crest_s = motion.crest_near_s(70);
  EXPECT_LE(std::abs(crest_s - 70), 0.5 * run.period_s);
  EXPECT_NEAR(motion.at(crest_s).sensor_m.z(), 0.5, 1e-3);
}

TEST(RigMotion, TurnsTheNavigationFrameIntoTheScene) {
  evaluation::RunRecord run = test::example_run();
  for (evaluation::TruthSample& s : run.truth) std::swap(s.north_m, s.east_m);  // the arm points east
  const RigInstant at = RigMotion(run, "").at(60);
  EXPECT_NEAR(at.sensor_m.y(), 0, 1e-9);
  EXPECT_NEAR(at.sensor_m.x(), 0.5 * std::cos(at.arm_angle_rad), 1e-3);
}

TEST(RigMotion, SaysWhichMethodsTheRunHolds) {
  const evaluation::RunRecord run = test::example_run();
  try {
    RigMotion(run, "magic");
    FAIL();
  } catch (const UserError& error) {
    EXPECT_NE(std::string(error.what()).find("harmonic, lee2014"), std::string::npos);
  }
  evaluation::RunRecord blind = run;
  blind.truth.clear();
  EXPECT_THROW(RigMotion(blind, ""), UserError);
}

TEST(RigScene, ShowsArmAndWaterAndMovesWithTheRun) {
  const evaluation::RunRecord run = test::example_run();
  const RigMotion motion(run, "");
  Canvas canvas;
  FilmFrames frames(canvas, motion, {.width_px = 640, .height_px = 360, .theme = Theme::kPrint});
  const Image first = frames.at(60), second = frames.at(63), again = frames.at(60);
  EXPECT_EQ(first.rgba, again.rgba);
  EXPECT_NE(first.rgba, second.rgba);
  std::size_t orange = 0, water = 0;
  for (int y = 0; y < first.height_px; ++y) {
    for (int x = 0; x < first.width_px * 58 / 100; ++x) {
      const Color p = test::pixel(first, x, y);
      orange += p.r > 0.45F && p.r > 1.4F * p.g && p.g > 1.4F * p.b;
      water += p.b > 0.4F && p.b > 1.25F * p.r;
    }
  }
  EXPECT_GT(orange, 200U);
  EXPECT_GT(water, 5000U);
}

TEST(RigScene, ShowsABuoyInTheWaterWhereThereIsNoArm) {
  const evaluation::RunRecord arm = test::example_run(), sea = test::example_sea_run();
  EXPECT_FALSE(RigMotion(arm, "").on_sea());
  const RigMotion motion(sea, "");
  EXPECT_TRUE(motion.on_sea());
  Canvas canvas;
  FilmFrames frames(canvas, motion, {.width_px = 640, .height_px = 360, .theme = Theme::kPrint});
  // The middle of the buoy's colour stands as high as the heave.
  const auto row_of = [&](double time_s) {
    const Image& image = frames.at(time_s);
    double rows = 0, yellow = 0;
    for (int y = 0; y < image.height_px; ++y) {
      for (int x = 0; x < image.width_px * 58 / 100; ++x) {
        const Color p = test::pixel(image, x, y);
        if (!(p.r > 0.35F && p.r > 1.1F * p.g && p.g > 1.5F * p.b)) continue;
        rows += y;
        ++yellow;
      }
    }
    EXPECT_GT(yellow, 100) << time_s;
    return rows / yellow;
  };
  double highest_s = motion.begin_s(), lowest_s = highest_s;
  for (double t = motion.begin_s(); t < motion.begin_s() + sea.period_s; t += 0.1) {
    if (motion.at(t).sensor_m.z() > motion.at(highest_s).sensor_m.z()) highest_s = t;
    if (motion.at(t).sensor_m.z() < motion.at(lowest_s).sensor_m.z()) lowest_s = t;
  }
  EXPECT_LT(row_of(highest_s) + 20, row_of(lowest_s));
}

// Single waves are higher than Hm0: the highest still has the buoy, its mast and its scale in the picture.
TEST(RigScene, KeepsTheBuoyInThePictureOnTheHighestWave) {
  evaluation::RunRecord sea = test::example_sea_run();
  sea.height_m = 4;
  const double grown = 2.6 / 0.5;
  for (auto& sample : sea.truth) sample.heave_m *= grown, sample.north_m *= grown;
  for (auto& [method, samples] : sea.heave)
    for (auto& sample : samples) sample.heave_m *= grown;
  const RigMotion motion(sea, "");
  const double crest_s = motion.crest_near_s(70);
  ASSERT_NEAR(motion.at(crest_s).sensor_m.z(), 2.6, 0.01);
  Canvas canvas;
  FilmFrames frames(canvas, motion, {.width_px = 640, .height_px = 360, .theme = Theme::kPrint});
  const Image& image = frames.at(crest_s);
  // The hull between the legend's and the scale's pieces of its colour, and free sky above it.
  int first = image.height_px, last = 0;
  for (int y = 0; y < image.height_px; ++y)
    for (int x = image.width_px * 15 / 100; x < image.width_px * 42 / 100; ++x) {
      const Color p = test::pixel(image, x, y);
      if (!(p.r > 0.35F && p.r > 1.1F * p.g && p.g > 1.5F * p.b)) continue;
      first = std::min(first, y);
      last = std::max(last, y);
    }
  ASSERT_LT(first, last) << "no buoy";
  EXPECT_GT(first, 2 * (last - first)) << "the mast is 1.6 times as high as the hull";
}

TEST(RigScene, IsBitIdenticalOnAnotherCanvas) {
  const evaluation::RunRecord run = test::example_run();
  const RigMotion motion(run, "");
  Canvas a, b;
  FilmFrames on_a(a, motion, {.width_px = 320, .height_px = 180}),
      on_b(b, motion, {.width_px = 320, .height_px = 180});
  on_b.at(55);
  EXPECT_EQ(on_a.at(60).rgba, on_b.at(60).rgba);
}

TEST(Film, LacksNoDataInItsFirstFrame) {
  evaluation::RunRecord run = test::example_run();
  for (auto& sample : run.imu) sample.utime += 1000;  // as a sensor's samples come: after the record's start
  for (auto& [method, heave] : run.heave)
    for (auto& sample : heave) sample.utime += 1000;
  const RigMotion motion(run, "");
  Canvas canvas;
  const FilmFrames frames(canvas, motion, {.width_px = 320, .height_px = 180});
  Figure figure = frames.traces(0);
  prepare_fonts(figure, canvas.fonts());
  canvas.fonts().bake();
  for (const PanelPlan& panel : planned(figure, canvas.fonts()).panels)
    EXPECT_TRUE(panel.has_data) << panel.panel.title;
}

TEST(Film, HoldsItsFramesInH264) {
  const test::TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "film.mp4";
  const evaluation::RunRecord run = test::example_run();
  const RigMotion motion(run, "");
  std::size_t told = 0;
  write_film(motion,
             {.width_px = 320, .height_px = 180, .frames_per_s = 10, .begin_s = 50, .duration_s = 1.2}, path,
             [&](std::size_t done, std::size_t all) {
               EXPECT_EQ(all, 12U);
               told = done;
             });
  EXPECT_EQ(told, 12U);
  AVFormatContext* format = nullptr;
  ASSERT_EQ(avformat_open_input(&format, path.c_str(), nullptr, nullptr), 0);
  ASSERT_GE(avformat_find_stream_info(format, nullptr), 0);
  ASSERT_EQ(format->nb_streams, 1U);
  EXPECT_EQ(format->streams[0]->codecpar->codec_id, AV_CODEC_ID_H264);
  EXPECT_EQ(format->streams[0]->codecpar->width, 320);
  AVPacket* packet = av_packet_alloc();
  int packets = 0;
  while (av_read_frame(format, packet) == 0) {
    ++packets;
    av_packet_unref(packet);
  }
  av_packet_free(&packet);
  avformat_close_input(&format);
  EXPECT_EQ(packets, 12);
}

TEST(Film, HasAFrameOfAMomentAndNoMoreThanAFileCanHold) {
  const evaluation::RunRecord run = test::example_run();
  const RigMotion motion(run, "");
  EXPECT_EQ(frame_times_s(motion, {.begin_s = 50, .duration_s = 1e-9}), std::vector<double>{50});
  EXPECT_THROW(frame_times_s(motion, {.begin_s = 50, .speed = 1e-300}), UserError);
}

TEST(Film, LeavesNoFileBehindWhereItFails) {
  const test::TemporaryFolder folder;
  const evaluation::RunRecord run = test::example_run();
  const RigMotion motion(run, "");
  EXPECT_THROW(write_film(motion, {.width_px = 321, .height_px = 180}, folder.path() / "odd.mp4", {}),
               UserError);
  EXPECT_THROW(write_film(motion, {.begin_s = 1e6}, folder.path() / "late.mp4", {}), UserError);
  EXPECT_THROW(write_film(motion, {}, folder.path() / "no" / "folder.mp4", {}), UserError);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace waverig::render
