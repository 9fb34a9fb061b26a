// `realtime` where the sea or the sensor changes: calms, rests, growing seas, gaps, faults.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <numbers>

#include "lcmtypes/flags.h"
#include "tests/estimator/run_realtime.h"

namespace waverig::testing {
namespace {

using estimator::HeaveSample;

// As on the rig: what begins after a rest is told from its first wave on, the swift shaking of a board as well as a swell.
TEST(Realtime, FollowsMotionThatBeginsAfterARest) {
  struct Motion {
    double tp_s, hm0_m, rms;
  };
  for (const Motion& motion : {Motion{0.65, 0.4, 0.06}, {6, 1, 0.045}, {12, 1, 0.055}}) {
    double squares_m2 = 0, n = 0;
    for (std::uint64_t seed = 1; seed <= 16; ++seed) {
      const SeaRecord record =
          changing_record({.hm0_m = 1e-3}, {.tp_s = motion.tp_s, .hm0_m = motion.hm0_m, .duration_s = 60}, 20, 3, seed);
      const Collector out = run_realtime(record.samples);
      for (std::size_t i = 2000; i < out.heaves.size(); ++i, ++n)
        squares_m2 += square(out.heaves[i].heave_m - record.heave_m[i]);
    }
    EXPECT_LT(std::sqrt(squares_m2 / n), motion.rms * motion.hm0_m) << motion.tp_s << " s";
  }
}

// Of a body at rest speed and bias are known exactly, and the sea that goes on after it is the same one.
TEST(Realtime, GoesOnAfterARestInTheMiddleOfASea) {
  struct Runs {
    double tp_s, hm0_m, run_s, rest_s, rms;
  };
  for (const Runs& runs : {Runs{2, 0.3, 25, 6, 0.032}, {4, 1, 30, 8, 0.033}, {6, 1, 40, 10, 0.042}}) {
    double squares_m2 = 0, n = 0;
    const SeaCase sea{.tp_s = runs.tp_s, .hm0_m = runs.hm0_m, .duration_s = runs.run_s};
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
      const auto [record, begins_s] = runs_and_rests(sea, sea, runs.rest_s, 8, seed);
      const Collector out = run_realtime(record.samples);
      for (std::size_t i = 0; i < out.heaves.size(); ++i) {
        const double t_s = static_cast<double>(out.heaves[i].utime) * kMicrosecond;
        const auto run = std::upper_bound(begins_s.begin() + 1, begins_s.end(), t_s) - 1;  // the first one is new
        if (run == begins_s.begin() || t_s > *run + runs.run_s) continue;
        squares_m2 += square(out.heaves[i].heave_m - record.heave_m[i]);
        ++n;
      }
    }
    EXPECT_LT(std::sqrt(squares_m2 / n), runs.rms * runs.hm0_m) << runs.tp_s << " s";
  }
}

// As where a board is laid down on a table, or a rig is parked at its lowest point.
TEST(Realtime, RemembersAtWhichLevelOfItsSeaItRested) {
  struct Runs {
    double tp_s, hm0_m, run_s, rest_s, level, rms;  // level: standard deviations
  };
  for (const Runs& runs : {Runs{4, 1, 30, 40, 1, 0.08}, {6, 1, 40, 60, 2, 0.2}, {9, 2, 60, 60, 1, 0.11}})
    for (const double side : {-1, 1}) {
      double squares_m2 = 0, n = 0;
      const SeaCase sea{.tp_s = runs.tp_s, .hm0_m = runs.hm0_m, .duration_s = runs.run_s};
      for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        const auto [record, begins_s] =
            runs_and_rests(sea, sea, runs.rest_s, 4, seed, side * runs.level * runs.hm0_m / 4);
        const Collector out = run_realtime(record.samples);
        for (std::size_t run = 1; run < begins_s.size(); ++run) {
          const auto begin = static_cast<std::size_t>(100 * begins_s[run]);
          const auto length = static_cast<std::size_t>(100 * runs.run_s);
          double sum_m = 0, sum_m2 = 0;  // about their mean: which level is called zero is not the question
          for (std::size_t i = begin; i < begin + length; ++i) {
            const double error_m = out.heaves[i].heave_m - record.heave_m[i];
            sum_m += error_m;
            sum_m2 += error_m * error_m;
          }
          squares_m2 += sum_m2 - sum_m * sum_m / static_cast<double>(length);
          n += static_cast<double>(length);
        }
      }
      EXPECT_LT(std::sqrt(squares_m2 / n), runs.rms * runs.hm0_m) << runs.tp_s << " s, side " << side;
    }
}

// The jolt that ends a run is no sea, and the rest after it tells of none: how fast the body moves is known in the runs
// after it as in any sea, and nothing moves in the rests.
TEST(Realtime, TakesNoJoltBeforeARestForASea) {
  const SeaCase sea{.tp_s = 6, .hm0_m = 1, .duration_s = 60};
  constexpr double kRest_s = 60;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const auto [record, begins_s] = runs_and_rests(sea, sea, kRest_s, 4, seed, 0.5);
    const Collector out = run_realtime(record.samples);
    for (std::size_t run = 1; run < begins_s.size(); ++run) {
      const auto begin = static_cast<std::size_t>(100 * (begins_s[run] - 1));
      double error = 0, truth = 0, rest = 0;
      for (std::size_t i = begin - 3000; i < begin; ++i) rest += square(out.heaves[i].heave_rate_mps);
      for (std::size_t i = begin; i < begin + 6000; ++i) {
        error += square(out.heaves[i].heave_rate_mps - record.heave_rate_mps[i]);
        truth += square(record.heave_rate_mps[i]);
      }
      EXPECT_LT(std::sqrt(error / truth) / 4, 0.03) << "seed " << seed << ", run " << run;
      EXPECT_LT(std::sqrt(rest / 3000), 0.01) << "seed " << seed << ", before run " << run;
    }
  }
}

// Before it is moved a board is touched.
TEST(Realtime, IsNotMisledByWhatStirsBeforeTheMotion) {
  struct Stir {
    double lasts_s, pause_s;
  };
  for (const Stir& stir : {Stir{8, 1}, {20, 1}, {20, 5}}) {
    double squares_m2 = 0, n = 0;
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
      const auto [record, begins_s] =
          runs_and_rests({.tp_s = 4, .hm0_m = 0.03, .duration_s = stir.lasts_s},
                         {.tp_s = 2, .hm0_m = 1, .duration_s = 60}, stir.pause_s, 2, seed);
      const Collector out = run_realtime(record.samples);
      for (auto i = static_cast<std::size_t>(100 * begins_s[1]); i < out.heaves.size(); ++i, ++n)
        squares_m2 += square(out.heaves[i].heave_m - record.heave_m[i]);
    }
    EXPECT_LT(std::sqrt(squares_m2 / n), 0.028) << stir.lasts_s << " s, " << stir.pause_s << " s before";
  }
}

// As a rig's runs begin. Its first seconds hide in the sensor's noise, and are no drift.
TEST(Realtime, FollowsRegularWavesThatComeUpSoftlyAfterARest) {
  constexpr double kRisesOver = 2;  // periods
  struct Case {
    double period_s, amplitude_m, rms;  // of four standard deviations, in the first forty seconds
  };
  for (const Case& c : {Case{4, 0.03, 0.20}, {6, 0.065, 0.13}, {8, 0.45, 0.05}, {10, 0.18, 0.06}, {12, 0.26, 0.06}}) {
    const double omega = 2 * kPi / c.period_s;
    double squares_m2 = 0, n = 0;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      const double rest_s = std::array{15, 25, 62}[seed % 3];
      const SeaCase lasts{.duration_s = rest_s + 40};
      const SeaRecord record = recorded(lasts, seed, [&](std::int64_t utime) {
        const double t_s = static_cast<double>(utime) * kMicrosecond;
        const double phase = omega * t_s + 2 * static_cast<double>(seed);
        const Vector3d at(c.amplitude_m * std::cos(phase), 0, c.amplitude_m * std::sin(phase));
        const Vector3d velocity = omega * Vector3d(-at.z(), 0, at.x());
        const Ramp r = ramp(t_s, rest_s, kRisesOver * c.period_s);
        BodyMotion m;
        m.acceleration_N = -r.w * omega * omega * at + 2 * r.dw * velocity + r.ddw * at;
        m.velocity_N = r.w * velocity + r.dw * at;
        m.position_N = r.w * at;
        return m;
      });
      const Collector out = run_realtime(record.samples);
      const auto onset = static_cast<std::size_t>(100 * rest_s);
      for (auto i = onset; i < out.heaves.size(); ++i, ++n)
        squares_m2 += square(out.heaves[i].heave_m - record.heave_m[i]);
      if (rest_s < 60) continue;  // the record's own start still settles
      EXPECT_FALSE(out.heaves[onset].flags & flag::kSettling);
      EXPECT_TRUE(out.heaves[onset + 2000].flags & flag::kSettling) << "gone through again";
      EXPECT_FALSE(out.heaves.back().flags & flag::kSettling);
    }
    EXPECT_LT(std::sqrt(squares_m2 / n), c.rms * 4 * c.amplitude_m / std::numbers::sqrt2) << c.period_s << " s";
  }
}

// Of waves of a few centimetres in a tank.
TEST(Realtime, ReadsRipplesBetweenRests) {
  for (const auto& [tp_s, rms] : {std::pair{1.0, 0.06}, {1.6, 0.07}, {2.6, 0.12}}) {
    const SeaCase ripples{.tp_s = tp_s, .hm0_m = 0.04, .duration_s = 45};
    double squares_m2 = 0, n = 0;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      const auto [record, begins_s] = runs_and_rests(ripples, ripples, 10, 4, seed);
      const Collector out = run_realtime(record.samples);
      for (auto i = static_cast<std::size_t>(100 * begins_s[1]); i < out.heaves.size(); ++i, ++n)
        squares_m2 += square(out.heaves[i].heave_m - record.heave_m[i]);
    }
    EXPECT_LT(std::sqrt(squares_m2 / n), rms * ripples.hm0_m) << tp_s << " s";
  }
}

// Beside the sea that was, what is left of it moves the body no more than a rest does.
TEST(Realtime, TakesNoLowSeaForARestOfTheOneBefore) {
  struct Seas {
    double tp_s, hm0_m, then_tp_s, then_hm0_m, soon, later;
  };
  for (const Seas& seas : {Seas{8, 4, 8, 0.2, 0.2, 0.14}, {3, 0.5, 16, 0.5, 0.21, 0.1}, {4, 2, 12, 0.2, 0.22, 0.15}}) {
    double soon_m2 = 0, later_m2 = 0, n = 0, m = 0;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      const auto [record, begins_s] =
          runs_and_rests({.tp_s = seas.tp_s, .hm0_m = seas.hm0_m, .duration_s = 120},
                         {.tp_s = seas.then_tp_s, .hm0_m = seas.then_hm0_m, .duration_s = 160}, 10, 2, seed);
      const Collector out = run_realtime(record.samples);
      for (std::size_t i = 0; i < out.heaves.size(); ++i) {
        const double since_s = static_cast<double>(out.heaves[i].utime) * kMicrosecond - begins_s[1];
        const double error_m2 = square(out.heaves[i].heave_m - record.heave_m[i]);
        if (since_s > 0 && since_s < 60) soon_m2 += error_m2, ++n;
        if (since_s > 60 && since_s < 160) later_m2 += error_m2, ++m;
      }
    }
    EXPECT_LT(std::sqrt(soon_m2 / n), seas.soon * seas.then_hm0_m) << seas.tp_s << " s";
    EXPECT_LT(std::sqrt(later_m2 / m), seas.later * seas.then_hm0_m) << seas.tp_s << " s";
  }
}

// Not in the lowest group of waves, and not where only heave can tell of it.
TEST(Realtime, TakesNoMomentOfASeaForARest) {
  constexpr Eigen::Index kBins = 321;
  constexpr double kDt = estimator::kFineInterval_s, kDf_hz = 0.5 / kDt / (kBins - 1);
  for (const SeaCase& sea : {SeaCase{.tp_s = 3, .hm0_m = 0.5}, {.tp_s = 6, .hm0_m = 1}, {.tp_s = 12, .hm0_m = 4}, {.tp_s = 16, .hm0_m = 6}})
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      const auto density = estimator::pierson_moskowitz_m2s(sea.hm0_m * sea.hm0_m / 16, sea.tp_s, kBins, kDf_hz);
      auto model = estimator::model_of_density(density, kDf_hz, kDt, 96, 1e-6);
      model.set_noise(6e-6);
      estimator::HeaveFilter filter(model, 0.02, 0.01);
      estimator::Integrator<Eigen::Array3d> integrator(kDt);
      const SeaRecord record = sea_record(
          {.tp_s = sea.tp_s, .hm0_m = sea.hm0_m, .duration_s = 1200, .slope_following = 0, .perfect_sensor = true}, seed);
      double longest_s = 0;
      for (const auto& sample : record.samples) {
        const Eigen::Array3d up_mps2(-sample.f_B.z() - kStandardGravity, 0, 0);
        if (&sample == &record.samples.front()) {
          integrator.start(sample.utime, up_mps2);
        } else {
          integrator.add(sample.utime, up_mps2, [&](std::int64_t, const estimator::LevelIncrement& increment) {
            filter.step({.increment = increment});
            longest_s = std::max(longest_s, filter.rest_s());
          });
        }
      }
      EXPECT_EQ(longest_s, 0) << sea.tp_s << " s, seed " << seed;
    }
}

TEST(Realtime, FollowsASeaThatComesUp) {
  const auto rms = [](const SeaCase& first, const SeaCase& then, double rises_s, double from_s, double to_s) {
    double squares = 0;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      const SeaRecord record = changing_record(first, then, 300, rises_s, seed);
      double sum = 0;
      const auto begin = static_cast<std::size_t>(100 * from_s), end = static_cast<std::size_t>(100 * to_s);
      const Collector out = run_realtime(record.samples);
      for (std::size_t i = begin; i < end; ++i) sum += square(out.heaves[i].heave_m - record.heave_m[i]);
      squares += sum / static_cast<double>(end - begin) / 4;
    }
    return std::sqrt(squares) / then.hm0_m;
  };
  const SeaCase calm{.tp_s = 9, .hm0_m = 0.001}, chop{.tp_s = 5, .hm0_m = 0.5};
  const SeaCase gale{.tp_s = 9, .hm0_m = 3, .duration_s = 600}, waves{.tp_s = 6, .hm0_m = 1, .duration_s = 600};
  EXPECT_LT(rms(chop, gale, 5, 300, 340), 0.10);
  EXPECT_LT(rms(chop, gale, 60, 300, 400), 0.04);
  EXPECT_LT(rms(calm, waves, 5, 300, 340), 0.06);
  EXPECT_LT(rms(calm, waves, 60, 300, 400), 0.06);
  EXPECT_LT(rms(calm, waves, 5, 420, 600), 0.025);
}

TEST(Realtime, FollowsASeaThatGrowsAndLengthens) {
  const SeaRecord first = sea_record({.tp_s = 5, .hm0_m = 0.5, .duration_s = 600}, 5);
  SeaRecord both = first;
  const SeaRecord second = sea_record({.tp_s = 9, .hm0_m = 3, .duration_s = 900}, 5);   // the same sensor
  for (std::size_t i = 0; i < second.samples.size(); ++i) {
    auto sample = second.samples[i];
    sample.seq += std::ssize(first.samples);
    sample.utime += 600'000'000;
    both.samples.push_back(sample);
    both.heave_m.push_back(second.heave_m[i]);
  }
  const Collector out = run_realtime(both.samples);
  EXPECT_LT(rms_over_hm0(out.heaves, both, 60000 + 30000, out.heaves.size()), 0.03);
}

TEST(Realtime, BridgesShortGapsAndRecoversFromLongOnes) {
  const SeaRecord record = sea_record({.tp_s = 8, .hm0_m = 1.5}, 6);
  std::vector<estimator::ImuSample> samples;
  for (std::size_t i = 0; i < record.samples.size(); ++i) {
    const bool lost = (i % 3000) < 8 || (i > 60000 && i < 61000);   // 80 ms every half minute, and once ten seconds
    if (!lost) samples.push_back(record.samples[i]);
  }
  const Collector out = run_realtime(samples);
  ASSERT_EQ(out.heaves.size(), samples.size());
  std::size_t after = 0;
  while (out.heaves[after].seq < 61000) ++after;
  EXPECT_TRUE(out.heaves[after].flags & flag::kGap);
  EXPECT_LT(rms_over_hm0(out.heaves, record, kSettled, after), 0.03);
  EXPECT_LT(rms_over_hm0(out.heaves, record, after + 12000, out.heaves.size()), 0.03);
  // What settles says so, at the start and after the long gap, for a minute; no wave reaches over that gap.
  for (const std::size_t from : {std::size_t{0}, after}) {
    for (std::size_t i = from; i < from + 5900; ++i) ASSERT_TRUE(out.heaves[i].flags & flag::kSettling) << i;
    EXPECT_FALSE(out.heaves[from + 12000].flags & flag::kSettling);
  }
  const std::int64_t gap_begin = out.heaves[after - 1].utime, gap_end = out.heaves[after].utime;
  EXPECT_GT(out.waves.size(), 100u);
  for (const auto& wave : out.waves)
    EXPECT_FALSE(wave.start_utime < gap_begin && wave.start_utime + std::llround(1e6 * wave.period_s) > gap_end)
        << wave.period_s;
}

// While nothing is seen a leaning body turns on.
TEST(Realtime, IsNotLostByAGapOnALeaningBody) {
  for (const double gap_s : {0.2, 0.35, 0.5, 0.7, 0.95, 1.5})
    for (const std::uint64_t seed : {1, 2, 3, 4}) {
      const SeaRecord record = sea_record({.tp_s = 3, .hm0_m = 0.5, .duration_s = 480}, seed);
      std::vector<estimator::ImuSample> samples;
      for (std::size_t i = 0; i < record.samples.size(); ++i)
        if (i < kSettled || i >= kSettled + static_cast<std::size_t>(100 * gap_s)) samples.push_back(record.samples[i]);
      const Collector out = run_realtime(samples);
      EXPECT_LT(rms_over_hm0(out.heaves, record, kSettled, kSettled + 2000), 0.2) << gap_s << " s, seed " << seed;
      EXPECT_LT(rms_over_hm0(out.heaves, record, kSettled + 6000, out.heaves.size()), 0.1)
          << gap_s << " s, seed " << seed;
    }
}

// What no sea does is not to be taken for sea until heave is a kilometre off.
TEST(Realtime, FindsItsSeaAgainAfterAnOffsetThatChangesOrAKnock) {
  struct Fault {
    double offset_mps2, turn_radps, lasts_s;
  };
  for (const Fault& fault : {Fault{0.05, 0, 1e9}, {0.2, 0, 1e9}, {20, 0, 0.1}, {0, 0.5 * kDegree, 1e9}})
    for (const SeaCase& sea : {SeaCase{.tp_s = 3, .hm0_m = 0.5}, {.tp_s = 8, .hm0_m = 1.5}})
      for (const std::uint64_t seed : {1, 2}) {
        SeaRecord record = sea_record({.tp_s = sea.tp_s, .hm0_m = sea.hm0_m, .duration_s = 800}, seed);
        for (std::size_t i = kSettled; i < record.samples.size(); ++i) {
          if (static_cast<double>(i - kSettled) > 100 * fault.lasts_s) break;
          record.samples[i].f_B.z() -= fault.offset_mps2;
          record.samples[i].w_NB_B.x() += fault.turn_radps;
        }
        const Collector out = run_realtime(record.samples);
        const std::string what = fmt::format("{} m/s^2, {} rad/s for {} s in {} s, seed {}", fault.offset_mps2,
                                             fault.turn_radps, fault.lasts_s, sea.tp_s, seed);
        double worst_m = 0;
        for (const HeaveSample& h : out.heaves)
          worst_m = std::max(worst_m, std::abs(h.heave_m - record.heave_m[static_cast<std::size_t>(h.seq)]));
        EXPECT_LT(worst_m, 80) << what;
        EXPECT_LT(rms_over_hm0(out.heaves, record, kSettled + 30000, out.heaves.size()), 0.04) << what;
      }
}

// A day later nothing of the sea is left: it is told no worse than in a record that begins there.
TEST(Realtime, BeginsAnewAfterAGapOfHours) {
  constexpr std::int64_t kDay_us = 86'400'000'000;
  for (const std::uint64_t seed : {1, 2, 3}) {
    SeaRecord both = sea_record({.tp_s = 10, .hm0_m = 3, .duration_s = 600}, seed);
    const std::size_t before = both.samples.size();
    const SeaRecord next_day = sea_record({.tp_s = 5, .hm0_m = 0.7, .duration_s = 120}, seed);
    for (std::size_t i = 0; i < next_day.samples.size(); ++i) {
      estimator::ImuSample sample = next_day.samples[i];
      sample.seq += static_cast<std::int64_t>(before);
      sample.utime += kDay_us;
      both.samples.push_back(sample);
      both.heave_m.push_back(next_day.heave_m[i]);
    }
    const Collector out = run_realtime(both.samples), alone = run_realtime(next_day.samples);
    const auto error_m2 = [&](const Collector& told, std::size_t begin) {
      double sum_m2 = 0;
      for (std::size_t i = begin; i < told.heaves.size(); ++i) {
        const HeaveSample& h = told.heaves[i];
        sum_m2 += square(h.heave_m - both.heave_m[static_cast<std::size_t>(h.seq) + (&told == &alone ? before : 0)]);
      }
      return sum_m2 / static_cast<double>(told.heaves.size() - begin);
    };
    EXPECT_LT(std::sqrt(error_m2(out, before)), 1.2 * std::sqrt(error_m2(alone, 0))) << "seed " << seed;
  }
}

TEST(Realtime, RecoversFromAGapInItsFirstSeconds) {
  const SeaRecord record = sea_record({.tp_s = 8, .hm0_m = 1.5, .duration_s = 300}, 11);
  std::vector<estimator::ImuSample> samples;
  for (std::size_t i = 0; i < record.samples.size(); ++i)
    if (i < 1500 || i > 2500) samples.push_back(record.samples[i]);
  const Collector out = run_realtime(samples);
  EXPECT_LT(rms_over_hm0(out.heaves, record, 9000, out.heaves.size()), 0.035);
}

TEST(Realtime, DropsRepeatedAndOutOfOrderSamples) {
  const SeaRecord record = sea_record({.tp_s = 6, .hm0_m = 1, .duration_s = 400}, 7);
  std::vector<estimator::ImuSample> samples;
  for (std::size_t i = 0; i < record.samples.size(); ++i) {
    samples.push_back(record.samples[i]);
    if (i % 7 == 0) samples.push_back(record.samples[i]);
    if (i % 11 == 10) samples.push_back(record.samples[i - 5]);
  }
  const Collector clean = run_realtime(record.samples), dirty = run_realtime(samples);
  ASSERT_EQ(dirty.heaves.size(), clean.heaves.size());
  for (std::size_t i = 0; i < clean.heaves.size(); i += 100) EXPECT_DOUBLE_EQ(dirty.heaves[i].heave_m, clean.heaves[i].heave_m);
}

TEST(Realtime, SurvivesNonsense) {
  const SeaRecord record = sea_record({.tp_s = 6, .hm0_m = 1, .duration_s = 400}, 9);
  std::vector<estimator::ImuSample> samples = record.samples;
  samples[100].f_B.x() = std::nan("");
  samples[5000].f_B.setConstant(1e300);
  samples[5001].w_NB_B.setConstant(-1e300);
  samples[6000].utime = -1;
  const Collector out = run_realtime(samples);
  for (const HeaveSample& h : out.heaves) ASSERT_TRUE(std::isfinite(h.heave_m) && std::isfinite(h.heave_sigma_m));
  EXPECT_LT(rms_over_hm0(out.heaves, record, kSettled, out.heaves.size()), 0.03);
}


// Nothing is told as known in the first seconds, when a slow sea still looks like a small one.
TEST(Realtime, StatesFromTheFirstSecondsOnThatTheSeaIsNotKnownYet) {
  for (const auto& [tp_s, hm0_m] : {std::pair{6.0, 1.0}, {8.0, 2.0}, {12.0, 4.0}}) {
    double ratios = 0, n = 0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      const SeaRecord record = sea_record({.tp_s = tp_s, .hm0_m = hm0_m, .duration_s = 10}, seed);
      const Collector out = run_realtime(record.samples);
      for (std::size_t i = 0; i < out.heaves.size(); ++i, ++n)
        ratios += square((out.heaves[i].heave_m - record.heave_m[i]) / out.heaves[i].heave_sigma_m);
    }
    EXPECT_LT(std::sqrt(ratios / n), 1.2) << tp_s << " s";
  }
}

// Heave that has run away is no wave, and says that it is not known.
TEST(Realtime, TellsNoWaveAndNoConfidenceWhereAnOffsetJumped) {
  for (const double jump_mps2 : {0.02, 0.05, 0.1}) {
    SeaRecord record = sea_record({.tp_s = 8, .hm0_m = 2, .duration_s = 500}, 51);
    for (std::size_t i = 30000; i < record.samples.size(); ++i) record.samples[i].f_B.z() += jump_mps2;
    const Collector out = run_realtime(record.samples);
    for (const estimator::Wave& wave : out.waves) EXPECT_LT(wave.height_m, 4.5) << jump_mps2;
    double squares = 0, count = 0;
    for (std::size_t i = 30000; i < out.heaves.size(); ++i) {
      const double error_m = std::abs(out.heaves[i].heave_m - record.heave_m[i]);
      const double z = error_m / out.heaves[i].heave_sigma_m;
      const bool flagged = out.heaves[i].flags & flag::kSettling;
      ASSERT_TRUE(error_m < 12 || flagged) << jump_mps2 << " at " << i;
      if (!flagged) continue;
      ASSERT_LT(z, error_m > 6 ? 3 : 4) << jump_mps2 << " at " << i;
      squares += z * z;
      ++count;
    }
    EXPECT_LT(squares, 2.56 * count + 1e-9) << jump_mps2;
  }
}

}  // namespace
}  // namespace waverig::testing
