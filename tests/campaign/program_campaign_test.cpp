// The program's commands about campaigns: sweep, plan, evaluate, report.
#include <gtest/gtest.h>

#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

#include "tests/campaign/program.h"

namespace waverig {
namespace {

TEST(Program, SweepWritesEverythingAResultsDirectoryHolds) {
  const TemporaryDirectory temporary;
  temporary.write("tiny.toml", kTiny);
  const Outcome outcome = run(temporary, "sweep tiny.toml --out out --jobs 2");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "") << "no progress where stderr is no terminal";
  EXPECT_NE(outcome.out.find("harmonic"), std::string::npos);
  for (const char* file : {"results.csv", "results.json", "report.html", "campaign.toml", "calibration.json",
                           "runs/T04.00s_H050.0cm_r1.lcm"})
    EXPECT_TRUE(std::filesystem::exists(temporary / "out" / file)) << file;
  EXPECT_FALSE(std::filesystem::is_empty(temporary / "out/figures"));
  const std::string csv = bytes_of(temporary / "out/results.csv");
  EXPECT_TRUE(
      csv.starts_with("period_s,height_cm,method,waves,mean_height_cm,error_rate_percent,std_cm,"
                      "expanded_uncertainty_cm,rmse_cm"))
      << csv;
  const Outcome again = run(temporary, "sweep tiny.toml --out out");
  EXPECT_EQ(again.status, 2);
  EXPECT_EQ(bytes_of(temporary / "out/results.csv"), csv);
}

TEST(Program, ReportsCampaignsOfWavesAndOfSeasAndHoldsThemSideBySide) {
  const TemporaryDirectory temporary;
  temporary.write("tiny.toml", kTiny);
  temporary.write(
      "sea.toml",
      "name = \"sea\"\nmethods = [\"smoothed\"]\n[sweep]\nmotion = \"jonswap\"\nperiods_s = [6.0]\n"
      "heights_cm = [100.0]\nduration_s = 120.0\nrepeats = 1\n");
  ASSERT_EQ(run(temporary, "sweep tiny.toml --out waves").status, 0);
  const Outcome sea = run(temporary, "sweep sea.toml --out sea");
  ASSERT_EQ(sea.status, 0) << sea.err;
  EXPECT_TRUE(std::filesystem::exists(temporary / "sea/figures/sea-states.png"));
  EXPECT_NE(bytes_of(temporary / "sea/report.html").find("% of Hm0"), std::string::npos);
  EXPECT_EQ(bytes_of(temporary / "waves/report.html").find("% of Hm0"), std::string::npos);
  const std::string judged = bytes_of(temporary / "sea/results.csv");
  EXPECT_NE(judged.find("heave_bound_percent"), std::string::npos) << judged;
  ASSERT_EQ(run(temporary, "evaluate sea --out anew").status,
            0);  // which has the bound from the results that stand
  EXPECT_EQ(bytes_of(temporary / "anew/results.csv"), judged);
  const std::string anew = bytes_of(temporary / "anew/results.json");
  EXPECT_NE(anew.find("\"command\": \"waverig sweep sea.toml"), std::string::npos);
  EXPECT_NE(anew.find("\"judged_command\": \"waverig evaluate sea --out anew\""), std::string::npos);
  EXPECT_NE(anew.find("\"judged_version\": \""), std::string::npos);
  EXPECT_EQ(bytes_of(temporary / "sea/results.json").find("judged_"), std::string::npos);
  for (const std::string campaign : {"waves", "sea"}) {
    const Outcome compared =
        run(temporary, "report " + campaign + " --compare " + campaign + " --out pair.html");
    ASSERT_EQ(compared.status, 0) << compared.err;
    EXPECT_EQ(compared.out, "pair.html\n");
    EXPECT_NE(bytes_of(temporary / "pair.html").find("not significant"), std::string::npos) << campaign;
  }
  const Outcome strangers = run(temporary, "report waves --compare sea --out none.html");
  EXPECT_EQ(strangers.status, 2);
  EXPECT_NE(strangers.err.find("in common"), std::string::npos) << strangers.err;
  EXPECT_FALSE(std::filesystem::exists(temporary / "none.html"));
}

TEST(Program, JudgesIntoADirectoryThatIsWholeByItself) {
  const TemporaryDirectory temporary;
  temporary.write("tiny.toml", kTiny);
  ASSERT_EQ(run(temporary, "sweep tiny.toml --out done").status, 0);
  ASSERT_EQ(run(temporary, "sweep tiny.toml --out other --seed 7").status, 0);
  ASSERT_EQ(run(temporary, "evaluate done --out anew").status, 0);
  ASSERT_EQ(run(temporary, "evaluate done --out anew").status, 0) << "again";
  std::filesystem::remove_all(temporary / "done");
  // A figure of an earlier call that these results have nothing for goes; what is somebody's own stays.
  std::filesystem::create_directory(temporary / "anew/figures");
  temporary.write("anew/figures/sea-states.png", "stale");
  ASSERT_TRUE(std::filesystem::exists(temporary / "anew/figures/sea-states.png"));
  temporary.write("anew/figures/mine.png", "own");
  const Outcome figures = run(temporary, "figures anew");
  EXPECT_EQ(figures.status, 0) << figures.err;
  EXPECT_FALSE(std::filesystem::exists(temporary / "anew/figures/sea-states.png"));
  EXPECT_TRUE(std::filesystem::exists(temporary / "anew/figures/mine.png"));
  EXPECT_NE(figures.out.find("anew/figures/spectra.png"), std::string::npos) << figures.out;  // of a log
  EXPECT_EQ(run(temporary, "report anew").status, 0);
  EXPECT_NE(bytes_of(temporary / "anew/report.html").find("<code>waverig evaluate done --out anew</code>"),
            std::string::npos);
  EXPECT_EQ(run(temporary, "sweep anew/campaign.toml --out again").status, 0);
  EXPECT_EQ(bytes_of(temporary / "anew/runs/T04.00s_H050.0cm_r1.lcm"),
            bytes_of(temporary / "again/runs/T04.00s_H050.0cm_r1.lcm"));
  // Results of another campaign stay.
  const std::string before = bytes_of(temporary / "other/results.json");
  const Outcome taken = run(temporary, "evaluate anew --out other");
  EXPECT_EQ(taken.status, 2);
  EXPECT_NE(taken.err.find("--out other: other/campaign.toml is of another campaign"), std::string::npos)
      << taken.err;
  EXPECT_EQ(bytes_of(temporary / "other/results.json"), before);
}

TEST(Program, JudgesNothingAnewWhereTheLogOfARunHasGone) {
  const TemporaryDirectory temporary;
  temporary.write("tiny.toml", kTiny);
  ASSERT_EQ(run(temporary, "sweep tiny.toml --out done").status, 0);
  const std::string results = bytes_of(temporary / "done/results.json");
  const std::string log = "done/runs/T04.00s_H050.0cm_r1.lcm";
  temporary.write(log, "");
  const Outcome empty = run(temporary, "evaluate done");
  EXPECT_EQ(empty.status, 2);
  EXPECT_NE(empty.err.find(log + ": holds no event; expected the log of a run"), std::string::npos)
      << empty.err;
  std::filesystem::rename(temporary / log, temporary / "done/runs/T05.00s_H050.0cm_r1.lcm");
  const Outcome gone = run(temporary, "evaluate done");
  EXPECT_EQ(gone.status, 2);
  EXPECT_NE(gone.err.find(log + ": is not there"), std::string::npos) << gone.err;
  EXPECT_EQ(bytes_of(temporary / "done/results.json"), results);
}

// Heave of someone else's program, of the right motion but on another clock, short, or upside down.
TEST(Program, WritesNoReportInThePlaceOfResults) {
  const TemporaryDirectory temporary;
  temporary.write("c.toml", kTiny);
  ASSERT_EQ(run(temporary, "sweep c.toml --out done").status, 0);
  for (const std::string file : {"results.json", "results.csv", "campaign.toml", "calibration.json",
                                 "runs/T04.00s_H050.0cm_r1.lcm"}) {
    const std::string before = bytes_of(temporary / "done" / file);
    for (const std::string command : {"report done --out done/", "compare done done --csv ./done/"}) {
      const Outcome refused = run(temporary, command + file);
      EXPECT_EQ(refused.status, 2) << command << file;
      EXPECT_NE(refused.err.find("is what the results in done are made of"), std::string::npos) << refused.err;
    }
    EXPECT_EQ(bytes_of(temporary / "done" / file), before) << file;
  }
  EXPECT_EQ(run(temporary, "compare done done --csv done/comparison.csv").status, 0);
  EXPECT_EQ(run(temporary, "report done --out done/report.html").status, 0);
}

TEST(Program, RemarksOnHeaveThatDoesNotFitTheRun) {
  const TemporaryDirectory temporary;
  temporary.write("tiny.toml", kTiny);
  ASSERT_EQ(run(temporary, "sweep tiny.toml --out done").status, 0);
  const std::string name = "T04.00s_H050.0cm_r1";
  ASSERT_EQ(run(temporary, "estimate done/runs/" + name + ".lcm --out ours").status, 0);
  const auto give = [&](const std::string& folder, std::int64_t later_us, double gain, double part) {
    std::istringstream rows(bytes_of(temporary / "ours/heave.csv"));
    std::vector<std::string> lines;
    for (std::string line; std::getline(rows, line);) lines.push_back(line);
    std::string text = "utime,heave_m\n";
    for (std::size_t i = 1; i < static_cast<std::size_t>(part * static_cast<double>(lines.size())); ++i) {
      const std::size_t comma = lines[i].find(',');
      text += std::to_string(std::stoll(lines[i]) + later_us) + "," +
              std::to_string(gain * std::stod(lines[i].substr(comma + 1))) + "\n";
    }
    std::filesystem::create_directories(temporary / folder);
    temporary.write(folder + "/" + name + ".csv", text);
    return run(temporary, "evaluate done --heave theirs=" + folder + " --out judged_" + folder);
  };
  const Outcome good = give("good", 0, 1, 1);
  EXPECT_EQ(good.status, 0);
  EXPECT_EQ(good.err, "");
  const Outcome hour = give("hour", 3'600'000'000, 1, 1);
  EXPECT_EQ(hour.status, 2);
  EXPECT_NE(hour.err.find("hour/" + name + ".csv: heave from "), std::string::npos) << hour.err;
  EXPECT_NE(hour.err.find("none in the steady part of the run from "), std::string::npos) << hour.err;
  EXPECT_FALSE(std::filesystem::exists(temporary / "judged_hour"));
  const Outcome part = give("part", 0, 1, 0.5);
  EXPECT_EQ(part.status, 0);
  EXPECT_NE(part.err.find("% of the run's steady part"), std::string::npos) << part.err;
  EXPECT_NE(part.out.find(",gap "), std::string::npos) << part.out;
  const Outcome down = give("down", 0, -1, 1);
  EXPECT_EQ(down.status, 0);
  EXPECT_NE(down.err.find("upside down"), std::string::npos) << down.err;
  const Outcome named = run(temporary, "evaluate done --heave smoothed=good --out named");
  const std::size_t row = named.out.find(",smoothed,");
  ASSERT_NE(row, std::string::npos) << named.out;
  EXPECT_GE(std::stoi(named.out.substr(row + 10)), 5) << "counted in heave alone, whatever its name\n" << named.out;
  const Outcome taken = run(temporary, "evaluate done --heave harmonic=good --out taken");
  EXPECT_EQ(taken.status, 2);
  EXPECT_NE(taken.err.find("expected another name"), std::string::npos) << taken.err;
}

TEST(Program, ResultsDirectoryAloneReproducesItself) {
  const TemporaryDirectory temporary;
  temporary.write("tiny.toml", kTiny);
  ASSERT_EQ(run(temporary, "sweep tiny.toml --out first --seed 5").status, 0);
  ASSERT_EQ(run(temporary, "sweep first/campaign.toml --out second").status, 0);
  EXPECT_EQ(bytes_of(temporary / "first/results.csv"), bytes_of(temporary / "second/results.csv"));
}

TEST(Program, PlanSaysNoWithExitOneAndTheReason) {
  const TemporaryDirectory temporary;
  temporary.write("c.toml", "name = \"t\"\n[sweep]\nperiods_s = [1.0, 6.0]\nheights_cm = [200.0]\n");
  const Outcome outcome = run(temporary, "plan c.toml");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.out.find("REFUSED"), std::string::npos);
}

}  // namespace
}  // namespace waverig
