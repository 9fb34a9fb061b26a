// Files with bytes turned at random: they are read or refused with a UserError, nothing else.
#include <gtest/gtest.h>

#include <string>

#include "estimator/evaluation/heave_csv.h"
#include "estimator/evaluation/results_io.h"
#include "estimator/evaluation/run_record.h"
#include "estimator/evaluation/sample_csv.h"
#include "estimator/messages.h"
#include "lcmtypes/channels.h"
#include "lcmtypes/error.h"
#include "lcmtypes/event_log.h"
#include "motion/kinematics/random.h"
#include "tests/evaluation/scratch.h"

namespace waverig::evaluation {
namespace {

// Reads `rounds` damaged copies of `good`; returns how many were refused.
template <class Read>
int refused(const Scratch& scratch, const std::string& good, const std::string& name, int rounds, Read read) {
  int count = 0;
  for (int round = 0; round < rounds; ++round) {
    RandomStream random(static_cast<std::uint64_t>(round), name);
    std::string bad = good;
    for (int k = 0; k < 1 + round % 4; ++k) {
      const auto at = static_cast<std::size_t>(random.uniform() * static_cast<double>(bad.size()));
      switch (random.bits() % 3) {
        case 0:
          bad[at] = static_cast<char>(random.bits());
          break;
        case 1:
          bad.erase(at, random.bits() % 20);
          break;
        default:
          bad.insert(at, bad.substr(bad.size() / 2, random.bits() % 20));
          break;
      }
    }
    const auto file = scratch.write(name, bad);
    try {
      read(file);
    } catch (const UserError& error) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
      ++count;
    }
  }
  return count;
}

TEST(HostileFiles, SampleCsv) {
  const Scratch scratch;
  std::string good = "utime,ax,ay,az,gx,gy,gz,mx,my,mz\n";
  for (int i = 1; i < 40; ++i) good += std::to_string(i * 1000) + ",0.1,-0.2,-9.81,0.01,1e-3,0,20.5,1,-40\n";
  EXPECT_GT(refused(scratch, good, "samples.csv", 150,
                    [](const auto& file) {
                      SampleCsvReader reader(file);
                      estimator::ImuSample sample;
                      while (reader.next(sample))
                        EXPECT_TRUE(sample.f_B.allFinite() && sample.w_NB_B.allFinite());
                    }),
            60);
}

TEST(HostileFiles, ResultsJson) {
  const Scratch scratch;
  CampaignResults results;
  results.complete = true;
  RunResult run;
  run.method = "m";
  run.waves.resize(3);
  run.seas.resize(2);
  run.statistics.budget.push_back({"noise", 0.1, 'B'});
  results.runs = {run, run};
  results.cells = cells_of(results.runs);
  write_results(scratch.path(), results);
  const std::string good = Scratch::read(scratch.path() / "results.json");
  EXPECT_GT(refused(scratch, good, "results.json", 150, [&](const auto&) { read_results(scratch.path()); }),
            60);
}

TEST(HostileFiles, EventLog) {
  const Scratch scratch;
  const auto path = scratch.path() / "good.lcm";
  {
    EventLogWriter log(path);
    estimator::HeaveSample heave;
    for (int i = 0; i < 30; ++i) {
      heave.utime = i;
      const heave_t message = estimator::message_of(heave);
      std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
      message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
      log.write(i, channel::of_method(channel::kHeavePrefix, "m"), bytes.data(), bytes.size());
    }
    log.close();
  }
  EXPECT_GT(refused(scratch, Scratch::read(path), "run.lcm", 150, [](const auto& file) { load_run(file); }),
            60);
}

}  // namespace
}  // namespace waverig::evaluation
